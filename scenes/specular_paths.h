// SPDX-License-Identifier: Apache-2.0
// Specular continuation of light from a source: straight through glass that does not refract, and
// by one reflection in a flat mirror. Shadow rays follow both. Copies its data from the scene.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scenes/scene.h"
#include "scenes/surface_offset.h"

namespace earthshine::scenes {

inline constexpr std::uint32_t no_mirror = 0xFFFFFFFFU;
inline constexpr int most_panes = 256;  // per ray; more block all light

// One side of all surfaces that reflect in one plane. A source appears at its mirror image, within
// the mirror's extent.
struct FlatMirror {
  Vec3 point{0.0}, normal{0.0, 0.0, 1.0};  // of the plane; unit, toward the side that reflects
  Vec3 centre{0.0};                        // } bounding sphere
  double radius_m = 0.0;                   // }
  double offset_m = 0.0;                   // offset of rays that start on it (surface_offset.h)

  [[nodiscard]] double height_m(const Vec3& p) const { return glm::dot(p - point, normal); }
  [[nodiscard]] Vec3 image(const Vec3& p) const { return p - 2.0 * height_m(p) * normal; }
  [[nodiscard]] Vec3 reflected(const Vec3& d) const {
    return d - 2.0 * glm::dot(d, normal) * normal;
  }
};

// Glass transmits light in a straight line if it is a sheet (two_sided) or has ior = 1.
[[nodiscard]] bool is_straight_glass(const Material& material);
// Whether a ray continues in a straight line. A surface that is more mirror than glass reflects it.
[[nodiscard]] inline bool goes_straight_on(const Vec3& incoming, const Vec3& outgoing) {
  return incoming == outgoing;
}

// Restart of a ray on its own line, offset_m behind a triangle that transmits it straight, so that
// it reaches its target. No value if this point is beyond the triangle's edge, where a wall may be,
// or the ray is nearly tangential.
[[nodiscard]] std::optional<Vec3> straight_through(const Scene& scene, std::uint32_t triangle,
                                                   const Vec3& position, const Vec3& direction,
                                                   double offset_m);

// Each mirror costs one more shadow ray per source at points in front of it. Planes with at least a
// fiftieth of all reflecting area (area times share, by side) count as mirrors, 32 at most. Curved
// surfaces have none, or many small ones.
class SpecularPaths {
 public:
  SpecularPaths() = default;
  SpecularPaths(const Scene& scene, const SurfaceOffsets& offsets);

  // No transparent glass and no mirror.
  [[nodiscard]] bool empty() const { return faces_.empty(); }
  [[nodiscard]] std::span<const FlatMirror> mirrors() const { return mirrors_; }

  // Effect of a triangle on a shadow ray; null: the ray ends there.
  struct Face {
    Vec3 normal{0.0};                                  // unit, of the front
    double plane_m = 0.0;                              // of its points, along the normal
    Rgb through{0.0};                                  // share that is transmitted straight
    Rgb reflected{0.0};                                // } share reflected by a flat mirror,
    std::uint32_t mirror[2] = {no_mirror, no_mirror};  // } and its number; front, back
    [[nodiscard]] double height_m(const Vec3& p) const { return glm::dot(p, normal) - plane_m; }
  };
  [[nodiscard]] const Face* face(std::uint32_t triangle) const {
    if (faces_.empty() || number_[triangle] == no_mirror) return nullptr;
    return &faces_[number_[triangle]];
  }

  // Share of a source's light that ends at a side of a triangle: neither transmitted nor reflected
  // by a flat mirror.
  [[nodiscard]] Rgb kept(std::uint32_t triangle, bool front) const;

 private:
  void find_mirrors(const Scene& scene, const SurfaceOffsets& offsets);

  std::vector<std::uint32_t> number_;  // per triangle
  std::vector<Face> faces_;
  std::vector<FlatMirror> mirrors_;
};

}  // namespace earthshine::scenes
