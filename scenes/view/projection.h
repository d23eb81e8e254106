// SPDX-License-Identifier: Apache-2.0
// Directions to places of the picture and back: the pinhole, or a lens with distortion in the
// models and coefficients of OpenCV.
#pragma once

#include <glm/vec2.hpp>

#include "scenes/scene.h"

namespace earthshine::scenes {

// Points are in camera axes, as OpenCV has them: x right, y down, z forward. Places run from (0, 0)
// at the picture's upper left corner to (1, 1) at its lower right corner, whatever its pixels.
struct Projection {
  Projection() = default;
  // Of a picture of columns x rows. Intrinsics scale with them; without intrinsics pixels are
  // square and fov_deg is the vertical field of view.
  Projection(const Camera& camera, int columns, int rows);

  // Not of unit length: z = 1 but for a fisheye lens.
  [[nodiscard]] Vec3 direction(const glm::dvec2& place) const;
  // Of a point with z > 0, or any point for a fisheye lens. Points beyond the angle up to which the
  // distortion grows continue linearly, so that they are outside the picture.
  [[nodiscard]] glm::dvec2 place(const Vec3& point) const;
  // Whether the point has a place at all, in the picture or beside it.
  [[nodiscard]] bool is_before(const Vec3& point) const {
    return distortion_ == Distortion::Fisheye || point.z > 0.0;
  }
  // Whether the point is in the picture, if nothing hides it.
  [[nodiscard]] bool shows(const Vec3& point) const;
  // Area of film, at unit focal length, per steradian: 1 / cos^3 of the angle to the axis for a
  // pinhole.
  [[nodiscard]] double film_per_sr(const Vec3& point) const;
  // The largest length of film, at unit focal length, per radian: 1 / cos^2 for a pinhole.
  [[nodiscard]] double film_per_rad(const Vec3& point) const;
  // The largest distance in the picture, px of columns x rows, per radian about a direction.
  [[nodiscard]] double px_per_rad(const Vec3& point, int columns, int rows) const;
  // Area of film by the area that a pinhole would have: 1 without distortion.
  [[nodiscard]] double magnification(const Vec3& point) const;
  // The distortion inverts over the whole picture; otherwise points of the scene would be seen at
  // two places.
  [[nodiscard]] bool covers_picture() const;
  [[nodiscard]] bool is_distorted() const { return distortion_ != Distortion::None; }

  double half_width = 0.0, half_height = 0.0;  // of the picture at unit focal length
  glm::dvec2 middle{0.0};  // of the picture from the principal point, at unit focal length

 private:
  [[nodiscard]] glm::dvec2 film(const Vec3& point) const;
  [[nodiscard]] glm::dvec2 brown_conrady(const glm::dvec2& pinhole) const;
  [[nodiscard]] glm::dmat2 brown_conrady_slope(const glm::dvec2& pinhole) const;
  [[nodiscard]] glm::dvec2 start_for(const glm::dvec2& film) const;
  [[nodiscard]] glm::dvec2 without_brown_conrady(const glm::dvec2& film) const;
  [[nodiscard]] double fisheye(double angle) const;
  [[nodiscard]] double fisheye_slope(double angle) const;
  [[nodiscard]] double fisheye_angle(double radius) const;

  Distortion distortion_ = Distortion::None;
  std::array<double, 5> k_{};
  double limit_ = 0.0;  // of the pinhole's radius, or of the angle: the distortion grows up to it
};

}  // namespace earthshine::scenes
