// SPDX-License-Identifier: Apache-2.0
// How the triangles of an object hang together, by edges between vertices at the same place.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "scenes/scene.h"

namespace earthshine::scenes {

// Of each vertex the first one at the same place, to the last bit.
[[nodiscard]] std::vector<std::uint32_t> welded(std::span<const Vec3> vertices);

// Triangles that hang together by edges which two of them share.
struct SurfacePart {
  std::vector<std::uint32_t> triangles;  // of the scene, ascending
  std::vector<char> turned;              // of each: to be turned round for one orientation of all
  std::size_t open_edges = 0;            // of one triangle
  std::size_t crowded_edges = 0;         // of more than two, each counted with one of their parts
  bool crowded = false;                  // any edge of its own is of more than two
  std::size_t mixed_edges = 0;           // of two that are wound against each other
  bool orientable = true;                // one orientation for all is possible
  double volume_m3 = 0.0;                // signed, in that orientation; of a closed part
  Vec3 low{0.0}, high{0.0};              // its box

  [[nodiscard]] bool closed() const { return open_edges == 0 && !crowded; }
  // In its own orientation a body of some volume; a sheet that is closed has none.
  [[nodiscard]] bool is_body() const {
    const double edge = glm::length(high - low);
    return closed() && std::abs(volume_m3) > flat_share * edge * edge * edge;
  }
  static constexpr double flat_share = 1e-9;
};

// The parts of one object, by their first triangle. The orientation of a part is that of most of
// its area. ids: as welded() gives them.
[[nodiscard]] std::vector<SurfacePart> surface_parts(const Scene& scene, const Object& object,
                                                     std::span<const std::uint32_t> ids);

// The solid angle that a closed part fills as seen from a point, without sign: 4 pi inside, 0
// outside, something between on it (van Oosterom and Strackee, "The solid angle of a plane
// triangle", 1983).
[[nodiscard]] double solid_angle_of(const Scene& scene, const SurfacePart& part, const Vec3& point);

}  // namespace earthshine::scenes
