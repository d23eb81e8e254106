// SPDX-License-Identifier: Apache-2.0
// Where light from a source goes on: straight on through glass that does not bend it, and off flat
// mirrors, once. Shadow rays carry both. Holds copies of what it needs, not the scene.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scenes/scene.h"
#include "scenes/surface_offset.h"

namespace earthshine::scenes {

inline constexpr std::uint32_t no_mirror = 0xFFFFFFFFU;
inline constexpr int most_panes = 256;  // that a ray goes through: beyond it, nothing is left

// One side of all that reflects in one plane. A source is seen in it where its image would be, as
// far as the mirror reaches.
struct FlatMirror {
  Vec3 point{0.0}, normal{0.0, 0.0, 1.0};  // of the plane; unit, toward the side that reflects
  Vec3 centre{0.0};                        // } of a ball around it
  double radius_m = 0.0;                   // }
  double offset_m = 0.0;                   // that rays start off it (surface_offset.h)

  [[nodiscard]] double height_m(const Vec3& p) const { return glm::dot(p - point, normal); }
  [[nodiscard]] Vec3 image(const Vec3& p) const { return p - 2.0 * height_m(p) * normal; }
  [[nodiscard]] Vec3 turned(const Vec3& d) const { return d - 2.0 * glm::dot(d, normal) * normal; }
};

// Glass lets light straight on if it is a sheet (two_sided) or does not bend it (ior = 1).
[[nodiscard]] bool is_straight_glass(const Material& material);
// Whether a ray goes straight on: what is more of a mirror than glass turns it back.
[[nodiscard]] inline bool goes_straight_on(const Vec3& way, const Vec3& onward) {
  return way == onward;
}

// Where a ray sets out again on its own line, offset_m behind a triangle that lets it straight
// through, so that it meets what it was aimed at. None where that is past the triangle's edge,
// where a wall may stand, or the ray all but grazes it.
[[nodiscard]] std::optional<Vec3> straight_through(const Scene& scene, std::uint32_t triangle,
                                                   const Vec3& position, const Vec3& direction,
                                                   double offset_m);

// Each mirror costs every source a shadow ray more at points before it: of all that reflects (area
// times share, by side) those planes are taken that have a fiftieth or more, and 32 at most. What
// is curved has none, or many small ones.
class SpecularPaths {
 public:
  SpecularPaths() = default;
  SpecularPaths(const Scene& scene, const SurfaceOffsets& offsets);

  // No glass that light goes through, no mirror.
  [[nodiscard]] bool empty() const { return faces_.empty(); }
  [[nodiscard]] std::span<const FlatMirror> mirrors() const { return mirrors_; }

  // What a triangle does to a shadow ray; null: it ends there.
  struct Face {
    Vec3 normal{0.0};      // unit, of the front
    double plane_m = 0.0;  // of its points, along the normal
    Rgb through{0.0};      // share that goes straight on
    Rgb reflected{0.0};    // } share that a flat mirror throws, and its number
    std::uint32_t mirror[2] = {no_mirror, no_mirror};  // } by front, back
    [[nodiscard]] double height_m(const Vec3& p) const { return glm::dot(p, normal) - plane_m; }
  };
  [[nodiscard]] const Face* face(std::uint32_t triangle) const {
    if (faces_.empty() || number_[triangle] == no_mirror) return nullptr;
    return &faces_[number_[triangle]];
  }

  // Of light straight from a source, the share that ends at a side of a triangle: neither let
  // through nor thrown on.
  [[nodiscard]] Rgb kept(std::uint32_t triangle, bool front) const;

 private:
  void find_mirrors(const Scene& scene, const SurfaceOffsets& offsets);

  std::vector<std::uint32_t> number_;  // per triangle
  std::vector<Face> faces_;
  std::vector<FlatMirror> mirrors_;
};

}  // namespace earthshine::scenes
