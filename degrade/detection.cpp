// SPDX-License-Identifier: Apache-2.0
#include "degrade/detection.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"
#include "degrade/moments/point_moments.h"

namespace earthshine::degrade {
namespace {

// The sum over the resels within `radius`, as far as they are in the picture.
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

// A difference of two means of floats that is below this share of them is rounding: a flat picture
// without noise shows no target.
constexpr double rounding = 5e-7;

double ratio(double signal, double noise) {
  if (signal == 0.0) return 0.0;
  return noise > 0.0 ? std::clamp(signal / noise, -most_snr, most_snr)
                     : std::copysign(most_snr, signal);
}

}  // namespace

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
