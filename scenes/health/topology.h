// SPDX-License-Identifier: Apache-2.0
// Connectivity of the triangles of an object by edges between vertices at equal positions.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "scenes/scene.h"

namespace earthshine::scenes {

// For each vertex the first one at exactly the same position.
[[nodiscard]] std::vector<std::uint32_t> welded(std::span<const Vec3> vertices);

// Triangles connected by edges that two of them share.
struct SurfacePart {
  std::vector<std::uint32_t> triangles;  // of the scene, ascending
  std::vector<char> flipped;             // per triangle: reverse for consistency
  std::size_t open_edges = 0;            // with one triangle
  std::size_t crowded_edges = 0;         // with more than two; each counts for one of their parts
  bool crowded = false;                  // has an edge with more than two triangles
  std::size_t mixed_edges = 0;           // between two triangles of opposite winding
  bool orientable = true;                // a consistent orientation is possible
  double volume_m3 = 0.0;                // of a closed part, signed, in the consistent orientation
  Vec3 low{0.0}, high{0.0};              // its box

  [[nodiscard]] bool closed() const { return open_edges == 0 && !crowded; }
  // Whether it has volume; a closed sheet has none.
  [[nodiscard]] bool is_body() const {
    const double edge = glm::length(high - low);
    return closed() && std::abs(volume_m3) > flat_share * edge * edge * edge;
  }
  static constexpr double flat_share = 1e-9;
};

// The parts of one object in order of their first triangle. A part is oriented like
// the larger share of its area. ids: result of welded().
[[nodiscard]] std::vector<SurfacePart> surface_parts(const Scene& scene, const Object& object,
                                                     std::span<const std::uint32_t> ids);

// Unsigned solid angle of a closed part from a point: 4 pi inside, 0 outside, between on the
// surface (van Oosterom and Strackee, "The solid angle of a plane triangle", 1983).
[[nodiscard]] double solid_angle_of(const Scene& scene, const SurfacePart& part, const Vec3& point);

}  // namespace earthshine::scenes
