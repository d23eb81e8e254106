// SPDX-License-Identifier: Apache-2.0
// Camera rays: pinhole or thin lens.
#pragma once

#include <array>
#include <cstddef>

#include "scenes/ray_query.h"
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
  // Index in the window of a pixel of the picture.
  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row - y) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column - x);
  }
  [[nodiscard]] bool contains(int column, int row) const {
    return column >= x && column < x + columns && row >= y && row < y + rows;
  }
};

// The camera's axes and the half size of its picture at unit distance.
struct CameraModel {
  Vec3 position{0.0}, forward{0.0}, right{0.0}, up{0.0};
  double half_width = 0.0, half_height = 0.0;  // tangents of the half fields of view
  double focus_m = 0.0;                        // distance of the plane in focus, along the axis
  double lens_radius_m = 0.0;                  // 0: pinhole
  int columns = 0, rows = 0;

  // (x, y) in pixels from the top left corner: the centre of pixel (i, j) is (i + 0.5, j + 0.5).
  // (lens_u, lens_v) in [0,1)^2 determine the point of the lens.
  [[nodiscard]] Ray ray(double x, double y, double lens_u, double lens_v) const;

  // For a point of the lens (the position of a pinhole): the unit direction of (x, y); the film
  // position of a point in front of the camera, px; and px^2 per m^2 of a surface there.
  [[nodiscard]] Vec3 direction_from(const Vec3& on_lens, double x, double y) const;
  [[nodiscard]] glm::dvec2 film_from(const Vec3& on_lens, const Vec3& point) const;
  [[nodiscard]] double film_per_m2(const Vec3& on_lens, const Vec3& point,
                                   const Vec3& normal) const;
};

// Square pixels; fov_deg is the vertical field for any size of the picture.
[[nodiscard]] CameraModel make_camera_model(const scenes::Camera& camera, int columns, int rows);

// A camera as the matrices of other programs, to project positions into its picture and to cast
// pixels back into the scene. Pixels count from the picture's top left corner: the centre of the
// first one is (0.5, 0.5).
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

// For a lens, from its centre.
[[nodiscard]] CameraMatrices camera_matrices(const CameraModel& camera);

// Winding number of an object's opaque one-sided triangles around a point: 1 inside a closed body,
// 0 outside, -1 inside a closed room (fronts inward), in between for open surfaces. The sum of
// signed solid angles over 4 pi (van Oosterom and Strackee 1983, equation 8) needs no rays and no
// tolerance.
[[nodiscard]] double winding_number(const scenes::Scene& scene, std::uint32_t object,
                                    const Vec3& point);

// Throws base::Error (Input), with the camera's place in the scene file and the object's name, if
// the camera is inside a body with black backs:
//   every ray from it first meets the back of an opaque one-sided surface, or
//   one closed object winds around it and at least half of its rays first meet that object's back.
// Valid positions include a closed room (fronts inward, or two-sided walls), a hull with a lining,
// an open bay and the inside of glass. The rays have fixed directions over the sphere.
void check_camera(const scenes::Scene& scene, const scenes::RayQuery& query,
                  const scenes::Camera& camera);

}  // namespace earthshine::raytrace
