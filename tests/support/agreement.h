// SPDX-License-Identifier: Apache-2.0
// Tests whether two renderers give the same picture: a z-test per pixel and one of the whole.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/image.h"

namespace earthshine::tests {

// Luminance per pixel and its variance.
struct Measured {
  std::vector<double> mean, variance;
};

// A picture with its variance (channel `variance`).
inline Measured measured(const base::Image& image) {
  Measured m;
  for (const float y : base::luminance_of(image)) m.mean.push_back(double(y));
  for (const float v : image.find("variance")->values) m.variance.push_back(double(v));
  return m;
}

// Mean of pictures with different seeds, and the variance of this mean from their scatter. Valid
// for any estimator, also where samples within a picture are correlated.
inline Measured measured(const std::vector<base::Image>& replicates) {
  const auto k = static_cast<double>(replicates.size());
  Measured m{std::vector<double>(replicates[0].pixel_count()),
             std::vector<double>(replicates[0].pixel_count())};
  std::vector<std::vector<float>> y;
  for (const base::Image& image : replicates) y.push_back(base::luminance_of(image));
  for (std::size_t p = 0; p < m.mean.size(); ++p) {
    for (const auto& picture : y) m.mean[p] += double(picture[p]) / k;
    for (const auto& picture : y) {
      m.variance[p] += std::pow(double(picture[p]) - m.mean[p], 2) / (k - 1.0) / k;
    }
  }
  return m;
}

struct Agreement {
  std::size_t pixels = 0;  // with variance
  std::size_t broken = 0;  // without variance, but different
  double mean_z = 0.0, mean_z2 = 0.0;
  double sd_z = 0.0, sd_z2 = 0.0;  // over the pixels
  double expected_z2 = 0.0;
  double ratio = 0.0, ratio_std_error = 0.0;  // of the pictures' means, first over second
};

// z = (first - second) / sqrt(variance of first + variance of second). The second variance is from
// `spread`, an independent picture: light paths are skewed, so that a pixel's mean and variance are
// correlated, which would shift the mean of z. For Student's t the mean of z^2 is nu / (nu - 2),
// with nu by Welch and Satterthwaite:
//   (v1 + v2)^2 / nu = v1^2 / (replicates - 1) + v2^2 / (samples - 1).
inline Agreement compare(const Measured& first, std::size_t replicates, const Measured& second,
                         const Measured& spread, std::size_t samples) {
  Agreement a;
  double sum_first = 0.0, sum_second = 0.0, sum_variance = 0.0;
  std::vector<double> z;
  for (std::size_t p = 0; p < first.mean.size(); ++p) {
    const double v1 = first.variance[p], v2 = spread.variance[p];
    sum_first += first.mean[p];
    sum_second += second.mean[p];
    sum_variance += v1 + v2;
    const double difference = first.mean[p] - second.mean[p];
    // Constant within single precision: black sky, the inside of a lamp.
    if (v1 + v2 <= std::pow(1e-6 * second.mean[p], 2)) {
      a.broken += std::abs(difference) > 1e-5 * second.mean[p] ? 1 : 0;
      continue;
    }
    z.push_back(difference / std::sqrt(v1 + v2));
    const double nu =
        std::pow(v1 + v2, 2) / (v1 * v1 / double(replicates - 1) + v2 * v2 / double(samples - 1));
    a.expected_z2 += nu / (nu - 2.0);
  }
  a.pixels = z.size();
  const auto n = static_cast<double>(z.size());
  a.expected_z2 /= n;
  for (const double x : z) {
    a.mean_z += x / n;
    a.mean_z2 += x * x / n;
  }
  for (const double x : z) {
    a.sd_z += std::pow(x - a.mean_z, 2) / n;
    a.sd_z2 += std::pow(x * x - a.mean_z2, 2) / n;
  }
  a.sd_z = std::sqrt(a.sd_z);
  a.sd_z2 = std::sqrt(a.sd_z2);
  a.ratio = sum_first / sum_second;
  a.ratio_std_error = std::sqrt(sum_variance) / sum_second;
  return a;
}

}  // namespace earthshine::tests
