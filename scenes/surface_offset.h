// SPDX-License-Identifier: Apache-2.0
// How far off a surface rays start: the rounding errors of single precision where the surface is,
// whatever else the scene holds (Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed.,
// 6.8 "Managing rounding error").
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/scene.h"
#include "scenes/triangle_point.h"

namespace earthshine::scenes {

class SurfaceOffsets {
 public:
  SurfaceOffsets() = default;
  explicit SurfaceOffsets(const Scene& scene);

  // What the coordinates of the ray structure are relative to: the middle of what is small and near
  // a camera. A value of single precision, so that subtracting it is exact nearby.
  [[nodiscard]] const Vec3& centre() const { return centre_; }

  // m, along the normal: no ray that starts so far off the triangle meets it. Bounds the error of
  // the ray's origin, of the triangle's corners and of Embree's distance to its plane. For planes
  // along the axes it follows the distance to the centre along their normal alone.
  [[nodiscard]] double of(std::uint32_t triangle) const { return double(offset_m_[triangle]); }

  // m: faces nearer to each other than this touch. At least of() of both; at least 1e-5 of the
  // smaller face, but no more than 20 um, for coordinates that a file has rounded.
  [[nodiscard]] double contact(std::uint32_t a, std::uint32_t b) const;
  [[nodiscard]] double contact(std::uint32_t triangle) const {
    return double(contact_m_[triangle]);
  }

 private:
  Vec3 centre_{0.0};
  std::vector<float> offset_m_, contact_m_;  // per triangle
};

// SurfaceOffsets::centre(), and of() for one triangle.
[[nodiscard]] Vec3 centre_of_detail(const Scene& scene);
[[nodiscard]] double surface_offset_m(const Scene& scene, std::uint32_t triangle,
                                      const Vec3& centre);
// The bound for a triangle of no instance whose corners are relative to the centre.
[[nodiscard]] double rounding_offset_m(const Corners& about_centre);

}  // namespace earthshine::scenes
