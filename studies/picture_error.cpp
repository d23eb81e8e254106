// SPDX-License-Identifier: Apache-2.0
#include "studies/picture_error.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace earthshine::studies {
namespace {

struct Variances {
  double first = 0.0, second = 0.0;
};

// Sums over the counted pixels of products and their variance.
struct Sums {
  std::size_t pixels = 0;
  double product = 0.0, variance = 0.0, difference = 0.0, right = 0.0;

  double whole_mean = 0.0;  // of the truth, for the weights

  // d1, d2: two measurements of a difference with independent noise; v1, v2: their variances, if
  // known.
  void add(double d1, double d2, double truth, std::optional<Variances> v) {
    ++pixels;
    const double weight = std::pow(raytrace::error_weight(truth, whole_mean), 2);
    product += weight * d1 * d2;
    difference += (d1 + d2) / 2.0;
    right += truth;
    if (v) {
      const double v1 = weight * v->first, v2 = weight * v->second;
      variance += weight * d1 * d2 * (v1 + v2) + v1 * v2;
      // The square of the difference is only known from the product, which may be negative.
      least_ += v1 * v2;
    } else {
      variance += std::pow(weight * (d1 + d2) / 2.0 * (d1 - d2), 2);
    }
  }

  [[nodiscard]] PictureError error() const {
    PictureError result;
    result.pixels = pixels;
    if (pixels == 0 || !(right > 0.0)) return result;
    const auto n = static_cast<double>(pixels);
    const double mean = right / n, square = product / n;
    const double spread = std::sqrt(std::max(variance, least_)) / n;
    const auto relative = [&](double of) { return std::sqrt(std::max(0.0, of)) / mean; };
    result.error = relative(square);
    result.low = relative(square - 2.0 * spread);
    result.high = relative(square + 2.0 * spread);
    result.standard_error = relative(std::max(0.0, square) + spread) - result.error;
    result.bias = difference / right;
    return result;
  }

 private:
  double least_ = 0.0;
};

double middle(const ReferencePair& pair, std::size_t p) {
  return (pair.first.luminance[p] + pair.second.luminance[p]) / 2.0;
}

}  // namespace

PictureError picture_error(const std::vector<float>& luminance, const ReferencePair& truth,
                           const std::vector<bool>& counted) {
  const NoisyPicture picture{
      {luminance.begin(), luminance.end()}, std::vector<double>(luminance.size(), 0.0), {}};
  return limit_error({picture, picture}, truth, counted);
}

PictureError limit_error(const ReferencePair& limit, const ReferencePair& truth,
                         const std::vector<bool>& counted) {
  Sums sums;
  sums.whole_mean = mean_luminance(truth, counted);
  const bool known = limit.has_variances() && truth.has_variances();
  for (std::size_t p = 0; p < counted.size(); ++p) {
    if (!counted[p]) continue;
    std::optional<Variances> noise;
    if (known) {
      noise = {limit.first.variance[p] + truth.first.variance[p],
               limit.second.variance[p] + truth.second.variance[p]};
    }
    sums.add(limit.first.luminance[p] - truth.first.luminance[p],
             limit.second.luminance[p] - truth.second.luminance[p], middle(truth, p), noise);
  }
  return sums.error();
}

double noise_of_mean(const ReferencePair& truth, const std::vector<bool>& counted) {
  const double mean = mean_luminance(truth, counted);
  double squares = 0.0, pixels = 0.0;
  for (std::size_t p = 0; p < counted.size(); ++p) {
    if (!counted[p]) continue;
    const double apart = truth.first.luminance[p] - truth.second.luminance[p];
    squares += std::pow(raytrace::error_weight(middle(truth, p), mean) * apart / 2.0, 2);
    pixels += 1.0;
  }
  return mean > 0.0 ? std::sqrt(squares / pixels) / mean : 0.0;
}

double mean_luminance(const ReferencePair& truth, const std::vector<bool>& counted) {
  double sum = 0.0, pixels = 0.0;
  for (std::size_t p = 0; p < counted.size(); ++p) {
    if (!counted[p]) continue;
    sum += middle(truth, p);
    pixels += 1.0;
  }
  return pixels > 0.0 ? sum / pixels : 0.0;
}

double resolution(const ReferencePair& truth, const std::vector<bool>& counted) {
  const double mean = mean_luminance(truth, counted);
  double squares = 0.0, pixels = 0.0;
  for (std::size_t p = 0; p < counted.size(); ++p) {
    if (!counted[p]) continue;
    const double weight = std::pow(raytrace::error_weight(middle(truth, p), mean), 4);
    squares += weight * truth.first.variance[p] * truth.second.variance[p];
    pixels += 1.0;
  }
  if (!(mean > 0.0)) return 0.0;
  return std::sqrt(2.0 * std::sqrt(squares) / pixels) / mean;
}

NoisyPicture reflected_light(const raytrace::Frame& frame) {
  const raytrace::StatedError& stated = frame.error;
  return {{stated.luminance.begin(), stated.luminance.end()}, {}, stated.counted()};
}

std::vector<bool> counted_pixels(const ReferencePair& truth) {
  std::vector<bool> counted = truth.first.counts;
  for (std::size_t p = 0; p < counted.size(); ++p) {
    counted[p] = counted[p] && truth.second.counts[p];
  }
  return counted;
}

}  // namespace earthshine::studies
