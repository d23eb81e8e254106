// SPDX-License-Identifier: Apache-2.0
// The point moments of weighted_resels.h.
#include <algorithm>

#include "degrade/moments/point_moments.h"
#include "studies/sight/weighted_resels.h"

namespace earthshine::studies {
namespace {

using degrade::Plane;

// Variances of S at a resel, in one frame and of the mean over the frames.
struct Scatter {
  float frame = 0.0F, in_time = 0.0F;
};

class ScatterAt {
 public:
  ScatterAt(const CctvSignal& line, int frames)
      : line_(line),
        light_(time_factors(line.lag_per_field, line.has_fields, frames).same),
        read_(1.0 / frames) {}

  [[nodiscard]] Scatter operator()(const SignalPlane& plane, std::size_t resel) const {
    const double taps = static_cast<double>(
        line_.amplifier_at_line[resel % static_cast<std::size_t>(line_.columns)]);
    const double grain = static_cast<double>(plane.grain_at_line[resel]);
    const double pattern =
        (plane.pattern.empty() ? 0.0 : static_cast<double>(plane.pattern_at_line[resel])) +
        taps * line_.amplifier_pattern;
    return {static_cast<float>(grain + taps * line_.amplifier + pattern),
            static_cast<float>(light_ * grain + read_ * taps * line_.amplifier + pattern)};
  }

 private:
  const CctvSignal& line_;
  double light_, read_;
};

}  // namespace

ShownMoments moments_at(const CctvSignal& line, const std::vector<std::uint32_t>& resels,
                        const std::vector<std::uint32_t>& screen, int frames) {
  const ScatterAt scatter(line, frames);
  const std::size_t count = line.resel_count();
  ShownMoments shown;
  for (std::vector<float>* plane :
       {&shown.mean, &shown.variance, &shown.variance_in_time, &shown.luminance, &shown.beyond}) {
    plane->assign(count, 0.0F);
  }
  for (std::size_t p = 0; p < line.planes.size(); ++p) {
    const SignalPlane& plane = line.planes[p];
    const auto share = static_cast<float>(line.luminance_share[p]);
    const auto gathered = [&](const std::vector<std::uint32_t>& at, auto law) {
      Plane mean, variance;
      mean.reserve(at.size());
      variance.reserve(at.size());
      for (const std::uint32_t resel : at) {
        mean.push_back(plane.signal[resel]);
        variance.push_back(scatter(plane, resel).frame);
      }
      return law(mean, variance);
    };
    const degrade::MomentPlanes v = gathered(resels, [&](const Plane& mean, const Plane& variance) {
      return degrade::through(line.line, mean, variance);
    });
    std::vector<float>& slope = shown.slope.emplace_back(count, 0.0F);
    for (std::size_t i = 0; i < resels.size(); ++i) {
      const std::uint32_t resel = resels[i];
      const Scatter s = scatter(plane, resel);
      const float linear = v.slope[i] * v.slope[i] * s.frame;
      const float beyond = std::max(0.0F, v.variance[i] - linear);
      shown.mean[resel] += share * v.mean[i];
      shown.variance[resel] += share * share * v.variance[i];
      shown.variance_in_time[resel] +=
          share * share *
          (v.slope[i] * v.slope[i] * s.in_time + beyond / static_cast<float>(frames));
      shown.beyond[resel] += share * share * beyond;
      slope[resel] = v.slope[i];
    }
    const Plane light = gathered(screen, [&](const Plane& mean, const Plane& variance) {
      return degrade::mean_through(line.screen, mean, variance);
    });
    for (std::size_t i = 0; i < screen.size(); ++i) {
      shown.luminance[screen[i]] += share * light[i];
    }
  }
  return shown;
}

}  // namespace earthshine::studies
