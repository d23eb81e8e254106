// SPDX-License-Identifier: Apache-2.0
#include "raytrace/surfaces/shared_samples.h"

#include <algorithm>

#include "base/units.h"

namespace earthshine::raytrace {
namespace {

// Weight of the prior from all coarse patches, in patches of a coarse patch.
constexpr double like_others = 16.0;
// Squared standard errors beyond which a patch's own difference overrides the common estimate.
constexpr double standard_error = 4.0;

}  // namespace

SharedSamples::SharedSamples(const SurfaceLight& light, const radiosity::PatchAlbedos& reflectances,
                             const SurfaceSamples& samples, std::span<const std::uint32_t> which,
                             std::span<const SampleBudget> budget,
                             std::span<const std::uint32_t> coarse)
    : which_(which), coarse_(coarse), own_(light.count(), 0.0) {
  const std::size_t columns = light.columns();
  const std::vector<double>& area = light.solution.patches.area_m2;
  const std::size_t count =
      coarse.empty() ? 0 : *std::max_element(coarse.begin(), coarse.end()) + 1;
  const auto change = [&](std::uint32_t i) {
    Rgb now(0.0);
    for (std::size_t k = 0; k < columns; ++k) {
      now[static_cast<int>(k % 3)] += double(light.gathered[i * columns + k]);
    }
    const auto& found = samples.residual[i].gathered;
    return std::array<double, 2>{double(found[0]) - base::luminance(now),
                                 double(found[1]) - base::luminance(now)};
  };
  struct Sums {
    double signal = 0.0, noise = 0.0, area = 0.0, patches = 0.0;
  };
  std::vector<Sums> sums(count);
  std::vector<std::array<double, 2>> common(count, {0.0, 0.0});
  all_.assign(count, 0.0);
  for (std::size_t n = 0; n < which.size(); ++n) {
    const std::uint32_t i = which[n];
    if (base::max_component(reflectances.of(light.solution.patches, i)) <= 0.0) continue;
    own_[i] = 2.0 * samples.residual[i].taken * budget[n].rays;
    if (own_[i] <= 0.0) continue;
    all_[coarse[i]] += own_[i];
    const auto c = change(i);
    for (std::size_t h = 0; h < 2; ++h) common[coarse[i]][h] += own_[i] * c[h];
  }
  Sums every;
  for (const std::uint32_t i : which) {
    if (own_[i] <= 0.0) continue;
    const std::uint32_t j = coarse[i];
    const auto c = change(i);
    for (Sums* const of : {&sums[j], &every}) {
      of->signal += area[i] * (c[0] - common[j][0] / all_[j]) * (c[1] - common[j][1] / all_[j]);
      of->noise += area[i] * base::squared(0.5 * (c[0] - c[1]));
      of->area += area[i];
      of->patches += 1.0;
    }
  }
  const double signal = every.area > 0.0 ? std::max(0.0, every.signal / every.area) : 0.0;
  const double noise = every.area > 0.0 ? every.noise / every.area : 0.0;
  kept_.assign(own_.size(), 1.0);
  noise_.assign(own_.size(), 0.0);
  off_.assign(own_.size(), 0.0);
  for (const std::uint32_t i : which) {
    const std::uint32_t j = coarse[i];
    if (own_[i] <= 0.0) continue;
    const double prior = like_others * sums[j].area / sums[j].patches;
    const double all = sums[j].area + prior;
    const auto c = change(i);
    const double own_noise = base::squared(0.5 * (c[0] - c[1]));
    noise_[i] = std::max((sums[j].noise + prior * noise) / all, own_noise);
    off_[i] = c[0] * c[1];
    if (sums[j].patches < 2.0) continue;
    const double own_signal = (c[0] - common[j][0] / all_[j]) * (c[1] - common[j][1] / all_[j]);
    const double q = noise_[i];
    const double s =
        std::max({0.0, (sums[j].signal + prior * signal) / all, own_signal - standard_error * q});
    kept_[i] = s + q > 0.0 ? s / (s + q) : 0.0;
  }
}

double SharedSamples::rays(std::uint32_t patch) const {
  if (own_[patch] <= 0.0) return 0.0;
  const double kept = kept_[patch];
  return 1.0 /
         (base::squared(kept) / own_[patch] + (1.0 - base::squared(kept)) / all_[coarse_[patch]]);
}

double SharedSamples::still_counting(std::uint32_t patch, double before) const {
  if (before <= 0.0) return 0.0;
  const double own = own_[patch], expected = noise_[patch] * (1.0 + own / before);
  return off_[patch] > standard_error * expected
             ? std::min(before, own * noise_[patch] / off_[patch])
             : before;
}

std::vector<double> SharedSamples::share(
    std::size_t width, const std::function<double(std::uint32_t, std::size_t)>& change) const {
  std::vector<double> common(all_.size() * width, 0.0), shared(own_.size() * width, 0.0);
  for (const std::uint32_t i : which_) {
    if (own_[i] <= 0.0) continue;
    const double weight = own_[i] / all_[coarse_[i]];
    for (std::size_t k = 0; k < width; ++k) {
      shared[i * width + k] = change(i, k);
      common[coarse_[i] * width + k] += weight * shared[i * width + k];
    }
  }
  for (const std::uint32_t i : which_) {
    if (own_[i] <= 0.0) continue;
    const double kept = kept_[i];
    for (std::size_t k = 0; k < width; ++k) {
      double& value = shared[i * width + k];
      value = kept * value + (1.0 - kept) * common[coarse_[i] * width + k];
    }
  }
  return shared;
}

}  // namespace earthshine::raytrace
