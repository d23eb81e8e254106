// SPDX-License-Identifier: Apache-2.0
#include "degrade/twin.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "base/error.h"
#include "base/units.h"
#include "degrade/carry.h"

namespace earthshine::degrade {
namespace {

// What the noise-free camera shows: at the start of its noise, when amplified, at the end.
struct StillRun {
  Result result;
  Picture exposed, amplified;
};

StillRun run_still(const base::Image& radiance, const CctvCamera& camera, const Monitor& monitor,
                   Options options, const Memory& before) {
  StillRun run;
  std::size_t negative = 0;
  run.exposed = sensor_input(radiance, camera.colour, negative);  // if no stage of the lens runs
  for (const Stage& stage : stages()) {
    if (stage.is(Kind::Noise)) options.off.emplace_back(stage.name);
  }
  options.watch = [&](const Stage& stage, const Picture& picture) {
    if (stage.part == Part::Lens) run.exposed = picture;
    if (stage.is(Kind::Meter)) run.amplified = picture;
  };
  run.result = degrade(radiance, camera, monitor, options, before);
  return run;
}

Picture picture_of(const base::Image& image) {
  Picture picture{image.width, image.height, {}};
  for (const base::Channel& channel : image.channels) picture.planes.push_back(channel.values);
  return picture;
}

Picture variances(const Moments& m) {
  Picture picture{m.mean.columns, m.mean.rows, {}};
  for (std::size_t p = 0; p < m.mean.planes.size(); ++p) picture.planes.push_back(variance(m, p));
  return picture;
}

// Luminance's share of each plane.
std::vector<double> weights(std::size_t planes) {
  if (planes == 1) return {1.0};
  return {base::luminance({1.0, 0.0, 0.0}), base::luminance({0.0, 1.0, 0.0}),
          base::luminance({0.0, 0.0, 1.0})};
}

// Planes have noise of their own, so their covariances add with the squares of the weights.
Covariance luminance_noise(const Moments& m) {
  const std::vector<double> weight = weights(m.mean.planes.size());
  std::optional<Covariance> sum;
  for (std::size_t p = 0; p < weight.size(); ++p) {
    Covariance one = times(plus(m.grain[p], m.pattern[p]), weight[p] * weight[p]);
    sum = sum ? plus(std::move(*sum), one) : std::move(one);
  }
  return *sum;
}

template <class F>
Plane mask(const Plane& values, F holds) {
  Plane out(values.size());
  std::transform(values.begin(), values.end(), out.begin(),
                 [&](float value) { return holds(static_cast<double>(value)) ? 1.0F : 0.0F; });
  return out;
}

}  // namespace

Twin twin(const base::Image& radiance, const CctvCamera& camera, const Monitor& monitor,
          const Options& options, const DetectionOptions& target, const Memory& before) {
  StillRun run = run_still(radiance, camera, monitor, options, before);
  Report report = run.result.report;
  const Setup setup{camera, monitor, options};
  const std::uint64_t fields = has_fields(setup, report) ? 2 : 1;
  Memory scratch;
  const StageContext at{setup, report, scratch, 0, fields};
  Moments moments = still(std::move(run.exposed));
  std::optional<Moments> line;
  for (const Stage& stage : stages()) {
    if (stage.part == Part::Lens) continue;
    if (stage.part == Part::Monitor && !line) line = settled(moments);
    if (!runs(stage, setup, &report)) continue;
    if (stage.carry != nullptr) {
      moments = stage.carry(std::move(moments), at);
    } else if (!moments.is_pending) {
      moments.mean = stage.apply(std::move(moments.mean), at);
    }
  }
  moments = settled(std::move(moments));

  Twin result;
  result.signal = picture_of(run.result.signal);
  result.viewed = picture_of(run.result.viewed);
  result.variance = variances(*line);
  result.viewed_variance = variances(moments);
  const Covariance noise = luminance_noise(*line);
  const Plane mean = luminance_plane(line->mean);
  result.snr = local_snr(mean, noise.variance());
  result.detection = detection(mean, noise, target);
  result.mean = std::move(line->mean);
  result.viewed_mean = std::move(moments.mean);
  const double black = report.exposure.gain * std::sqrt(report.noise.at_black());
  const Plane level = luminance_plane(run.amplified.planes.empty() ? result.signal : run.amplified);
  result.saturated = mask(level, [](double s) { return s >= white_signal; });
  result.crushed = mask(level, [&](double s) { return s <= black; });
  result.memory = std::move(run.result.memory);
  return result;
}

base::Image to_image(const Twin& twin, const Result& noisy) {
  base::Image image = noisy.viewed;
  const auto add = [&](const std::string& prefix, const Picture& picture) {
    const base::Image part = to_image(picture);
    for (const base::Channel& channel : part.channels) {
      image.channels.push_back({prefix + "." + channel.name, channel.values});
    }
  };
  add("twin", twin.viewed);
  add("mean", twin.viewed_mean);
  add("variance", twin.viewed_variance);
  // Whole pixels to a resel, or the same grid where nothing spreads.
  const std::size_t step = static_cast<std::size_t>(image.width / twin.signal.columns);
  const auto add_resels = [&](const std::string& name, const Plane& resels) {
    const std::size_t width = static_cast<std::size_t>(image.width);
    const std::size_t columns = static_cast<std::size_t>(twin.signal.columns);
    Plane pixels(image.pixel_count());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      pixels[i] = resels[i / width / step * columns + i % width / step];
    }
    image.channels.push_back({name, std::move(pixels)});
  };
  add_resels("snr.Y", twin.snr);
  add_resels("detection.snr.Y", twin.detection.snr);
  add_resels("detection.probability.Y", twin.detection.probability);
  add_resels("saturated.Y", twin.saturated);
  add_resels("crushed.Y", twin.crushed);
  return image;
}

}  // namespace earthshine::degrade
