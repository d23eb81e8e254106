// SPDX-License-Identifier: Apache-2.0
// Offset of ray origins from a surface: a bound of the local single-precision rounding errors,
// independent of the rest of the scene (Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th
// ed., 6.8 "Managing rounding error").
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "scenes/scene.h"
#include "scenes/triangle_point.h"

namespace earthshine::scenes {

class SurfaceOffsets {
 public:
  SurfaceOffsets() = default;
  // centre: of another pose of the scene; without it centre_of_detail().
  explicit SurfaceOffsets(const Scene& scene, const std::optional<Vec3>& centre = std::nullopt);

  // Centre of detail: origin of the ray structure's coordinates, amid small objects near a camera.
  // Representable in single precision, so that subtracting it is exact nearby.
  [[nodiscard]] const Vec3& centre() const { return centre_; }

  // Offset along the normal, m: a ray that starts there cannot hit its own triangle. Bounds the
  // errors of the ray's origin, of the triangle's corners and of Embree's distance to its plane.
  // For axis-aligned planes it depends only on the distance to the centre along the normal.
  [[nodiscard]] double of(std::uint32_t triangle) const { return double(offset_m_[triangle]); }

  // Contact distance, m: nearer faces touch. At least of() of both, and at least 1e-5 of the
  // smaller face but at most 20 um, for coordinates that a file has rounded.
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
// Bound for a triangle that is no instance, with corners relative to the centre.
[[nodiscard]] double rounding_offset_m(const Corners& about_centre);

}  // namespace earthshine::scenes
