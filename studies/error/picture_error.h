// SPDX-License-Identifier: Apache-2.0
// How far a picture is from the truth, known from two pictures of the truth with noise of their
// own.
//
//   error^2 = mean of (L - R1)(L - R2), over the square of mean (R1 + R2) / 2
// With R1 = T + n1, R2 = T + n2, n1 and n2 independent of each other and of L: the mean of the
// product is that of (L - T)^2, whatever their noise. Its standard error, from the variances v1, v2
// of the references' pixels:
//   s^2 = sum of [ (L - T)^2 (v1 + v2) + v1 v2 ] / pixels^2
// Differences of pixels brighter than four times the mean count in proportion, as in the errors
// that pictures state of themselves (error_weight, raytrace/frame/frame.h).
#pragma once

#include <cstddef>
#include <vector>

#include "raytrace/camera/camera.h"
#include "scenes/effects/light_groups.h"
#include "studies/study.h"

namespace earthshine::studies {

// Luminance, cd/m^2, and its variance, (cd/m^2)^2, per pixel.
struct NoisyPicture {
  std::vector<double> luminance, variance;
};
struct ReferencePair {
  NoisyPicture first, second;
};

struct PictureError {
  std::size_t pixels = 0;
  double error = 0.0;            // relative; 0 where the mean product is not positive
  double low = 0.0, high = 0.0;  // the same for the mean product less and plus 2 s
  double bias = 0.0;             // mean of L - (R1 + R2) / 2, relative
};

// counted: which pixels. Relative figures are 0 where the mean of the references is.
[[nodiscard]] PictureError picture_error(const std::vector<float>& luminance,
                                         const ReferencePair& truth,
                                         const std::vector<bool>& counted);

// How far the truth of one pair is from that of another: the mean of (L1 - R1)(L2 - R2). No setting
// takes that away from a method whose limit `limit` is.
[[nodiscard]] PictureError limit_error(const ReferencePair& limit, const ReferencePair& truth,
                                       const std::vector<bool>& counted);

// The least error that the pair tells from none: that whose square is 2 s of an exact picture.
// Relative; 0 where the mean is.
[[nodiscard]] double resolution(const ReferencePair& truth, const std::vector<bool>& counted);

[[nodiscard]] double mean_luminance(const ReferencePair& truth, const std::vector<bool>& counted);

// The pixels that show a surface at their centre and, at 4 x 4 places, no source itself: no lit
// sky, no shining side of a lamp, no surface that emits. What a source's own pixels are off by is
// no matter of the settings here, and would drown the rest.
[[nodiscard]] std::vector<bool> surface_pixels(const scenes::World& study,
                                               const raytrace::CameraModel& camera);

}  // namespace earthshine::studies
