// SPDX-License-Identifier: Apache-2.0
// A camera as the matrices that other programs expect, so that positions can be projected into its
// picture and pixels cast back into the scene.
#pragma once

#include <array>

#include "raytrace/camera/camera.h"

namespace earthshine::raytrace {

// Pixels count from the picture's top left corner: the centre of the first one is (0.5, 0.5).
struct CameraMatrices {
  // Computer vision: axes x right, y down, z forward; points are columns; matrices row by row.
  //   (u w, v w, w) = K (x, y, z)      camera (m) to pixels; K = fx 0 cx  0 fy cy  0 0 1
  //   (X, Y, Z, 1) = to_world (x, y, z, 1)
  std::array<double, 9> k{};
  std::array<double, 16> to_world{};
  // OpenEXR's standard attributes (ImfStandardAttributes.h): points are rows, matrices row by row.
  //   worldToCamera  left-handed: x right, y up, z forward
  //   worldToNDC     (0, 0) and (1, 1) are the upper left and lower right corners of the display
  //                  window; the third coordinate, 1 - 1/depth, has no meaning in the standard
  std::array<double, 16> world_to_camera{};
  std::array<double, 16> world_to_ndc{};
  double screen_window_width = 1.0;  // of the picture at distance 1
};

// Of a pinhole; of a lens, its centre.
[[nodiscard]] CameraMatrices camera_matrices(const CameraModel& camera);

}  // namespace earthshine::raytrace
