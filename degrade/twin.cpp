// SPDX-License-Identifier: Apache-2.0
#include "degrade/twin.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "base/error.h"
#include "base/units.h"
#include "degrade/carry.h"
#include "degrade/moments/point_moments.h"

namespace earthshine::degrade {
namespace {

// Run without noise: the final result, and the signals before the noise and after amplification.
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

// Weight of each plane in luminance.
std::vector<double> weights(std::size_t planes) {
  if (planes == 1) return {1.0};
  return {base::luminance({1.0, 0.0, 0.0}), base::luminance({0.0, 1.0, 0.0}),
          base::luminance({0.0, 0.0, 1.0})};
}

// The noise of different planes is independent, so that covariances add with squared weights.
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

// Sum over the resels within `radius` that are in the picture.
AxisMap box_sum(int size, int radius) {
  AxisMap map;
  map.in = size;
  for (int i = 0; i < size; ++i) {
    for (int j = std::max(0, i - radius); j <= std::min(size - 1, i + radius); ++j) {
      map.source.push_back(static_cast<std::size_t>(j));
      map.weight.push_back(1.0);
    }
    map.start.push_back(map.source.size());
  }
  return map;
}

PlaneMap box_sum(int columns, int rows, int radius) {
  return {box_sum(columns, radius), box_sum(rows, radius)};
}

double count(const PlaneMap& box, std::size_t x, std::size_t y) {
  return static_cast<double>((box.along.start[x + 1] - box.along.start[x]) *
                             (box.across.start[y + 1] - box.across.start[y]));
}

// A difference of two float means below this share of them is rounding: a flat picture without
// noise shows no target.
constexpr double rounding = 5e-7;

double ratio(double signal, double noise) {
  if (signal == 0.0) return 0.0;
  return noise > 0.0 ? std::clamp(signal / noise, -most_snr, most_snr)
                     : std::copysign(most_snr, signal);
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
    moments = carry(std::move(moments), stage, at);
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
  // An integer number of pixels per resel, or the same grid without spread.
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

Detection detection(const Plane& mean, const Covariance& noise, const DetectionOptions& options) {
  const int size = options.target_resels;
  if (size < 1 || size > 199 || size % 2 == 0) {
    throw base::Error(base::Blame::Input, "detection",
                      "a target of " + std::to_string(size) + " resels",
                      "A target has an odd number of resels from 1 to 199",
                      "Take " + std::to_string(std::clamp(size | 1, 1, 199)));
  }
  if (mean.size() != noise.variance().size()) {
    throw base::Error(base::Blame::Input, "detection",
                      std::to_string(mean.size()) + " means for " +
                          std::to_string(noise.variance().size()) + " variances",
                      "Mean and noise are of one picture", "Carry both to the same stage first");
  }
  const PlaneMap target = box_sum(noise.columns, noise.rows, size / 2);
  const PlaneMap both = box_sum(noise.columns, noise.rows, size);
  const Picture picture{noise.columns, noise.rows, {mean}};
  const Plane target_sum = apply(picture, target.along, target.across).planes.front();
  const Plane sum = apply(picture, both.along, both.across).planes.front();
  // The difference is a * (sum over the target) - b * (sum over target and surround).
  const Plane target_variance = variance_after(noise, target.along, target.across);
  const Plane variance = variance_after(noise, both.along, both.across);
  const Plane shared = covariance_between(noise, target, both);

  const std::size_t width = static_cast<std::size_t>(noise.columns);
  Detection found{Plane(mean.size()), Plane(mean.size()), Plane(mean.size()), Plane(mean.size())};
  for (std::size_t i = 0; i < mean.size(); ++i) {
    const double inside = count(target, i % width, i / width);
    const double around = count(both, i % width, i / width) - inside;
    double signal = 0.0, sigma = 0.0;
    if (around > 0.0) {
      const double b = 1.0 / around, a = 1.0 / inside + b;
      const double total = static_cast<double>(sum[i]), own = static_cast<double>(target_sum[i]);
      signal = std::abs(a * own - b * total);
      if (signal <= rounding * (a * std::abs(own) + b * std::abs(total))) signal = 0.0;
      const double v = a * a * static_cast<double>(target_variance[i]) -
                       2.0 * a * b * static_cast<double>(shared[i]) +
                       b * b * static_cast<double>(variance[i]);
      sigma = std::sqrt(std::max(0.0, v));
    }
    const double snr = ratio(signal, sigma);
    found.signal[i] = static_cast<float>(signal);
    found.noise[i] = static_cast<float>(sigma);
    found.snr[i] = static_cast<float>(snr);
    found.probability[i] = static_cast<float>(normal_probability(snr - options.even_chance_snr));
  }
  return found;
}

Plane local_snr(const Plane& mean, const Plane& variance) {
  Plane snr(mean.size());
  for (std::size_t i = 0; i < mean.size(); ++i) {
    const double sigma = std::sqrt(std::max(0.0, static_cast<double>(variance[i])));
    snr[i] = static_cast<float>(ratio(static_cast<double>(mean[i]), sigma));
  }
  return snr;
}

}  // namespace earthshine::degrade
