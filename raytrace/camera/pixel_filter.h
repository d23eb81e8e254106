// SPDX-License-Identifier: Apache-2.0
// Positions of camera rays in and around a pixel. Offsets are drawn from the filter itself, so that
// every sample has weight 1 and a pixel is the plain mean of its samples.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/numbers/random.h"
#include "scenes/scene.h"

namespace earthshine::raytrace {

// Separable, symmetric, never negative; w is the full width of its support in pixels, x in [-w/2,
// w/2]:
//   Box             1
//   Triangle        1 - 2|x|/w
//   Gaussian        exp(-x^2 / (2 s^2)), s = w/6: cut at three standard deviations
//   BlackmanHarris  0.35875 + 0.48829 cos t + 0.14128 cos 2t + 0.01168 cos 3t, t = 2 pi x / w
//                   (Harris 1978, the 4-term window of -92 dB)
class PixelFilter {
 public:
  PixelFilter(scenes::FilterShape shape, double width_px);
  explicit PixelFilter(const scenes::Camera& camera)
      : PixelFilter(camera.filter, camera.filter_width_px) {}

  // Offset from the pixel's centre in pixels, x to the right and y down. An increasing function
  // maps each of (u, v) in [0, 1]^2, so that stratified points stay stratified. The box of width 1
  // gives (u - 0.5, v - 0.5) exactly.
  [[nodiscard]] std::array<double, 2> offset(double u, double v) const { return {at(u), at(v)}; }
  // Probability density of the offsets, 1/px^2.
  [[nodiscard]] double density(const glm::dvec2& offset) const {
    return density_at(offset.x) * density_at(offset.y);
  }
  [[nodiscard]] double width_px() const { return width_px_; }

 private:
  [[nodiscard]] double at(double u) const;
  [[nodiscard]] double density_at(double x) const;

  scenes::FilterShape shape_;
  double width_px_;
  std::vector<double> inverse_;  // x / w, see invert(); for the smooth shapes
};

// Camera samples of a pixel, on film and lens: even and odd ones are two independent sets of low
// discrepancy.
class PixelPoints {
 public:
  PixelPoints(std::uint64_t seed, std::uint64_t pixel)
      : key_(seed, base::Stream::Pixel, pixel),
        halves_{base::SobolOwen4(key_.with(0)), base::SobolOwen4(key_.with(1))} {}
  [[nodiscard]] std::array<float, 4> point(std::size_t sample) const {
    return halves_[sample % 2].point(static_cast<std::uint32_t>(sample / 2));
  }
  // Time of the sample in the exposure, in [0, 1). Of a pinhole the point of the lens, stratified
  // together with the place in the pixel: the edges of a picture in motion converge as still ones.
  [[nodiscard]] double time(std::size_t sample, bool has_lens) const {
    if (!has_lens) return double(point(sample)[2]);
    const base::SobolOwen4 times(key_.with(2 + sample % 2));
    return double(times.point(static_cast<std::uint32_t>(sample / 2))[0]);
  }

 private:
  base::Key key_;
  std::array<base::SobolOwen4, 2> halves_;
};

}  // namespace earthshine::raytrace
