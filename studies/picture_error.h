// SPDX-License-Identifier: Apache-2.0
// The error of a picture, from two reference pictures with independent noise.
//
//   error^2 = mean of (L - R1)(L - R2), over the square of mean (R1 + R2) / 2.
// Let R1 = T + n1, R2 = T + n2, with the truth T and noise n1 and n2 independent of each other and
// of L. Then the mean of the product is the mean of (L - T)^2 for any noise. Let v1, v2 be the
// variances of the references' pixels. The standard error s of the product is
//   s^2 = sum of [ (L - T)^2 (v1 + v2) + v1 v2 ] / pixels^2    if v1, v2 are known,
//   s^2 = sum of [ (m d)^2 ] / pixels^2                        otherwise.
// Here m = L - (R1 + R2) / 2 and d = R1 - R2. For normal noise with v1 = v2 both have the same
// mean; otherwise the second is larger. Differences of pixels brighter than four times the mean
// have reduced weight, as in the errors that pictures state (error_weight, raytrace/frame/frame.h).
#pragma once

#include <cstddef>
#include <vector>

#include "raytrace/frame/frame.h"

namespace earthshine::studies {

// Luminance, cd/m^2, and its variance, (cd/m^2)^2, per pixel.
struct NoisyPicture {
  std::vector<double> luminance, variance;  // variance: empty if unknown
  std::vector<bool> counts = {};            // as StatedError::counts; empty if unknown
};
struct ReferencePair {
  NoisyPicture first, second;
  [[nodiscard]] bool has_variances() const {
    return !first.variance.empty() && !second.variance.empty();
  }
};

struct PictureError {
  std::size_t pixels = 0;
  double error = 0.0;            // relative; 0 if the mean product is not positive
  double low = 0.0, high = 0.0;  // the same for the mean product minus and plus 2 s
  // high - error for one s. If the error is 0, the least detectable error.
  double standard_error = 0.0;
  double bias = 0.0;  // mean of L - (R1 + R2) / 2, relative
};

// counted: pixels in the mean. Relative values are 0 if the mean of the references is 0.
[[nodiscard]] PictureError picture_error(const std::vector<float>& luminance,
                                         const ReferencePair& truth,
                                         const std::vector<bool>& counted);

// The difference between the truths of two pairs: the mean of (L1 - R1)(L2 - R2). No setting
// removes it from a method with the limit `limit`.
[[nodiscard]] PictureError limit_error(const ReferencePair& limit, const ReferencePair& truth,
                                       const std::vector<bool>& counted);

// Noise of the pair's mean: the root of the mean of ((R1 - R2) / 2)^2, with the same weights,
// relative.
[[nodiscard]] double noise_of_mean(const ReferencePair& truth, const std::vector<bool>& counted);

// The least error that the pair detects: its square is 2 s of an exact picture. Relative; 0 if the
// mean is 0. Needs the variances.
[[nodiscard]] double resolution(const ReferencePair& truth, const std::vector<bool>& counted);

[[nodiscard]] double mean_luminance(const ReferencePair& truth, const std::vector<bool>& counted);

// The light in a picture's stated error: without light straight from a source that the camera sees,
// sample by sample. The accuracy of a source's edge depends on no setting of these studies, and its
// light would dominate the error, however small the source. Without variances, which not every
// frame has.
[[nodiscard]] NoisyPicture reflected_light(const raytrace::Frame& frame);

// Pixels that in both pictures show a reflecting surface and no edge of a source.
[[nodiscard]] std::vector<bool> counted_pixels(const ReferencePair& truth);

}  // namespace earthshine::studies
