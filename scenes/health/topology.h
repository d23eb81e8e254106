// SPDX-License-Identifier: Apache-2.0
// How the triangles of an object hang together, by edges between vertices at the same place.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "scenes/scene.h"

namespace earthshine::scenes {

// Numbers for vertices, the same for those at the same place to the last bit.
[[nodiscard]] std::vector<std::uint32_t> welded(const std::vector<Vec3>& vertices);

// Triangles that hang together by edges which two of them share.
struct SurfacePart {
  std::vector<std::uint32_t> triangles;  // of the scene, ascending
  std::vector<char> turned;              // of each: to be turned round for one orientation of all
  std::size_t open_edges = 0;            // of one triangle
  std::size_t crowded_edges = 0;         // of more than two: non-manifold
  std::size_t mixed_edges = 0;           // of two that are wound against each other
  bool orientable = true;                // one orientation for all is possible
  double volume_m3 = 0.0;                // signed, in that orientation; of a closed part
  Vec3 low{0.0}, high{0.0};              // its box

  [[nodiscard]] bool closed() const { return open_edges == 0 && crowded_edges == 0; }
};

// The parts of one object, by their first triangle. The orientation of a part is that of most of
// its area. ids: as welded() gives them.
[[nodiscard]] std::vector<SurfacePart> surface_parts(const Scene& scene, const Object& object,
                                                     std::span<const std::uint32_t> ids);

// Whether a closed part goes round a point that lies on none of its triangles: its solid angles add
// up to 4 pi (van Oosterom and Strackee, "The solid angle of a plane triangle", 1983).
[[nodiscard]] bool surrounds(const Scene& scene, const SurfacePart& part, const Vec3& point);

}  // namespace earthshine::scenes
