// SPDX-License-Identifier: Apache-2.0
// How far a picture is from the truth, known from two pictures of the truth with noise of their
// own.
//
//   error^2 = mean of (L - R1)(L - R2), over the square of mean (R1 + R2) / 2
// With R1 = T + n1, R2 = T + n2, n1 and n2 independent of each other and of L: the mean of the
// product is that of (L - T)^2, whatever their noise. Its standard error s, where the variances v1,
// v2 of the references' pixels are known, and where they are not:
//   s^2 = sum of [ (L - T)^2 (v1 + v2) + v1 v2 ] / pixels^2
//   s^2 = sum of [ (m d)^2 ] / pixels^2,  m = L - (R1 + R2) / 2, d = R1 - R2
// Of normal noise with v1 = v2 both have one mean; the second is the larger one otherwise.
// Differences of pixels brighter than four times the mean count in proportion, as in the errors
// that pictures state of themselves (error_weight, raytrace/frame/frame.h).
#pragma once

#include <cstddef>
#include <vector>

#include "raytrace/frame/frame.h"

namespace earthshine::studies {

// Luminance, cd/m^2, and its variance, (cd/m^2)^2, per pixel.
struct NoisyPicture {
  std::vector<double> luminance, variance;  // variance: empty if it is not known
  std::vector<bool> counts = {};            // as StatedError::counts; empty if it is not known
};
struct ReferencePair {
  NoisyPicture first, second;
  [[nodiscard]] bool has_variances() const {
    return !first.variance.empty() && !second.variance.empty();
  }
};

struct PictureError {
  std::size_t pixels = 0;
  double error = 0.0;            // relative; 0 where the mean product is not positive
  double low = 0.0, high = 0.0;  // the same for the mean product less and plus 2 s
  // high - error for one s. Where the error is 0 against it, the least error that would be seen.
  double standard_error = 0.0;
  double bias = 0.0;  // mean of L - (R1 + R2) / 2, relative
};

// counted: which pixels. Relative figures are 0 where the mean of the references is.
[[nodiscard]] PictureError picture_error(const std::vector<float>& luminance,
                                         const ReferencePair& truth,
                                         const std::vector<bool>& counted);

// How far the truth of one pair is from that of another: the mean of (L1 - R1)(L2 - R2). No setting
// takes that away from a method whose limit `limit` is.
[[nodiscard]] PictureError limit_error(const ReferencePair& limit, const ReferencePair& truth,
                                       const std::vector<bool>& counted);

// Of the mean of the pair: the root of the mean of ((R1 - R2) / 2)^2, weighted and relative alike.
[[nodiscard]] double noise_of_mean(const ReferencePair& truth, const std::vector<bool>& counted);

// The least error that the pair tells from none: that whose square is 2 s of an exact picture.
// Relative; 0 where the mean is. Wants the variances.
[[nodiscard]] double resolution(const ReferencePair& truth, const std::vector<bool>& counted);

[[nodiscard]] double mean_luminance(const ReferencePair& truth, const std::vector<bool>& counted);

// What the picture states its error of: light straight from a source that the camera sees is left
// out, sample by sample. How exact an edge of a source is depends on no setting here, and its light
// would drown the rest, however small it is seen. Without variances, which not every frame knows.
[[nodiscard]] NoisyPicture reflected_light(const raytrace::Frame& frame);

// Where both say that they show a surface that reflects and no edge of a source.
[[nodiscard]] std::vector<bool> counted_pixels(const ReferencePair& truth);

}  // namespace earthshine::studies
