// SPDX-License-Identifier: Apache-2.0
// Pixel to ray: pinhole or thin lens.
#pragma once

#include <cstddef>

#include "scenes/scene.h"

namespace earthshine::raytrace {

struct Ray {
  Vec3 origin{0.0};
  Vec3 direction{0.0};  // unit
};

// A part of the picture, in pixels from its top left corner.
struct Window {
  int x = 0, y = 0, columns = 0, rows = 0;
  [[nodiscard]] std::size_t pixel_count() const {
    return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  }
  // Of a pixel of the picture that lies in the window.
  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row - y) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column - x);
  }
  [[nodiscard]] bool contains(int column, int row) const {
    return column >= x && column < x + columns && row >= y && row < y + rows;
  }
};

// The camera's frame and the half size of its picture at unit distance.
struct CameraModel {
  Vec3 position{0.0}, forward{0.0}, right{0.0}, up{0.0};
  double half_width = 0.0, half_height = 0.0;  // tangents of the half fields of view
  double focus_m = 0.0;                        // distance of the plane in focus, along the axis
  double lens_radius_m = 0.0;                  // 0: pinhole
  int columns = 0, rows = 0;

  // (x, y) in pixels from the top left corner, so that the centre of pixel (i, j) is (i + 0.5, j +
  // 0.5); (lens_u, lens_v) in [0,1)^2 choose the point of the lens.
  [[nodiscard]] Ray ray(double x, double y, double lens_u, double lens_v) const;
};

// Square pixels; fov_deg is the vertical field whatever the size of the picture.
[[nodiscard]] CameraModel make_camera_model(const scenes::Camera& camera, int columns, int rows);

}  // namespace earthshine::raytrace
