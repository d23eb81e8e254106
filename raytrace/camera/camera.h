// SPDX-License-Identifier: Apache-2.0
// Pixel to ray: pinhole or thin lens, with the projection of scenes/view.
#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "scenes/ray_query.h"
#include "scenes/scene.h"
#include "scenes/view/projection.h"

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

struct CameraModel {
  Vec3 position{0.0}, forward{0.0}, right{0.0}, up{0.0};
  scenes::Projection projection;
  double focus_m = 0.0;        // distance of the plane in focus, along the axis
  double lens_radius_m = 0.0;  // 0: pinhole
  int columns = 0, rows = 0;

  // Motion during the exposure of a row, and from row to row (scenes/view/motion.h).
  scenes::Motion motion;
  double exposure_s = 0.0, readout_s = 0.0;
  double from_s = -std::numeric_limits<double>::infinity();  // } only this part of the exposures
  double until_s = std::numeric_limits<double>::infinity();  // }
  [[nodiscard]] bool moves() const {
    return motion.moves() && (exposure_s > 0.0 || readout_s != 0.0);
  }
  // The camera, at rest, at that time; at a share u in [0, 1] of the exposure of pixels in row y.
  [[nodiscard]] CameraModel at(double t_s) const;
  [[nodiscard]] CameraModel at_row(double y, double u) const;

  // (x, y) in pixels from the top left corner: the centre of pixel (i, j) is (i + 0.5, j + 0.5).
  // (lens_u, lens_v) in [0,1)^2 determine the point of the lens.
  [[nodiscard]] Ray ray(double x, double y, double lens_u, double lens_v) const;

  // Width of a pixel by its height.
  [[nodiscard]] double pixel_aspect() const {
    return projection.half_width * rows / (projection.half_height * columns);
  }
  // In the axes of the projection: x right, y down, z forward, from the position.
  [[nodiscard]] Vec3 to_camera(const Vec3& point) const;
  // Angle between neighbouring pixels toward a direction, rad; for a pinhole that on the axis.
  [[nodiscard]] double pixel_angle(const Vec3& direction) const;

  // Through a point of the lens (of a pinhole the position): the direction of (x, y), of unit
  // length; where a point in front of the camera is seen, px; and how many px^2 a square metre
  // there is.
  [[nodiscard]] Vec3 direction_from(const Vec3& on_lens, double x, double y) const;
  [[nodiscard]] glm::dvec2 film_from(const Vec3& on_lens, const Vec3& point) const;
  [[nodiscard]] double film_per_m2(const Vec3& on_lens, const Vec3& point,
                                   const Vec3& normal) const;

 private:
  [[nodiscard]] Vec3 through_lens(const Vec3& on_lens, const Vec3& point) const;
};

// The sample's camera: `camera` itself if it does not move, otherwise at time() of the row's
// exposure, from 0 to 1, which is kept in `moved`.
template <class Time>
const CameraModel& camera_of_sample(const CameraModel& camera, double y, const Time& time,
                                    CameraModel& moved) {
  if (!camera.moves()) return camera;
  moved = camera.at_row(y, time());
  return moved;
}

[[nodiscard]] CameraModel make_camera_model(const scenes::Camera& camera, int columns, int rows);

// Splits a line of the scene into pieces whose pictures are straight to a fraction of a pixel: the
// whole line without distortion, pieces of at most a degree with it.
template <class Use>
void for_straight_pieces(const CameraModel& camera, const Vec3& a, const Vec3& b, const Use& use,
                         int deepest = 12) {
  const Vec3 to_a = a - camera.position, to_b = b - camera.position;
  constexpr double one_degree = 0.99985;  // its cosine
  if (!camera.projection.is_distorted() || deepest == 0 ||
      glm::dot(to_a, to_b) >= one_degree * glm::length(to_a) * glm::length(to_b)) {
    use(a, b);
    return;
  }
  const Vec3 middle = 0.5 * (a + b);
  for_straight_pieces(camera, a, middle, use, deepest - 1);
  for_straight_pieces(camera, middle, b, use, deepest - 1);
}

// A camera as the matrices that other programs expect, so that positions can be projected into its
// picture and pixels cast back into the scene.

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
