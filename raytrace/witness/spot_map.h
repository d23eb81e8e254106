// SPDX-License-Identifier: Apache-2.0
// Light that fills less than a pixel, as the witness predicts it for the picture.
#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "raytrace/camera/camera.h"

namespace earthshine::raytrace {

// An image of a source, a highlight or a piece of lit surface, projected by a pinhole.
struct Spot {
  glm::dvec2 film{0.0};                    // centre, px
  double radius_px = 0.0, blur_px = 0.0;   // blur: radius of the lens blur of a point
  double area_px2 = 0.0, luminance = 0.0;  // luminance: cd/m^2
};

// Per pixel, the mean and the mean square of a camera sample's light from spots.
class SpotMap {
 public:
  struct Pixel {
    double light = 0.0, square = 0.0;  // cd/m^2, (cd/m^2)^2
    // Share of the pixel that spots of one luminance with these two means fill.
    [[nodiscard]] double coverage() const { return square > 0.0 ? light * light / square : 1.0; }
  };

  // filter_px: full width of the pixel filter's support.
  SpotMap(const CameraModel& camera, double filter_px);
  // Divides a spot, as a square, among the pixels that it overlaps.
  void add(const Spot& spot);
  [[nodiscard]] const Pixel& at(int x, int y) const { return pixels_[index(x, y)]; }
  // The greatest `light` of the pixel at that film position and its neighbours.
  [[nodiscard]] double most_around(const glm::dvec2& film) const;
  [[nodiscard]] bool contains(const Spot& spot) const;

 private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(x);
  }

  int columns_, rows_;
  double filter_px_;
  std::vector<Pixel> pixels_;
};

}  // namespace earthshine::raytrace
