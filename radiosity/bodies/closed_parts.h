// SPDX-License-Identifier: Apache-2.0
// Connected surfaces of triangles, and which of them are closed.
#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "scenes/scene.h"

namespace earthshine::radiosity {

// Triangles connected by edges (exactly equal vertices), identified by their first triangle.
// `closed` of that triangle: every edge of the part is used equally often in both directions. Each
// triangle of a sheet or of glass is a separate open part.
struct ClosedParts {
  // An edge used more often in this direction than in the other.
  struct RimEdge {
    std::uint32_t part, from, to;  // vertices
  };
  std::vector<std::uint32_t> of;
  std::vector<char> closed;
  std::vector<RimEdge> rims;  // by part
};
// left_out: triangles of these objects are treated like sheets; empty: none.
[[nodiscard]] ClosedParts find_closed_parts(const scenes::Scene& scene,
                                            const std::vector<char>& left_out = {});

// The triangles of the parts for which keep(part) is true, part by part, in ascending order.
template <class Keep>
[[nodiscard]] std::vector<std::vector<std::uint32_t>> triangles_by_part(const ClosedParts& parts,
                                                                        const Keep& keep) {
  std::map<std::uint32_t, std::vector<std::uint32_t>> of_part;
  for (std::uint32_t t = 0; t < parts.of.size(); ++t) {
    if (keep(parts.of[t])) of_part[parts.of[t]].push_back(t);
  }
  std::vector<std::vector<std::uint32_t>> all;
  for (auto& [part, triangles] : of_part) all.push_back(std::move(triangles));
  return all;
}

// Surfaces that are closed except for a hole on another surface, such as a block without a bottom
// on a floor: models omit invisible faces.

// For each such part the closing triangles, three corners each. Conditions: the rim is planar, the
// part lies on one side of it, and all around, at vertices and middles of edges, the rim lies
// within a millionth of the scene's size on opaque one-sided triangles of other parts that face the
// hole.
[[nodiscard]] std::map<std::uint32_t, std::vector<Vec3>> find_stoppers(const scenes::Scene& scene,
                                                                       const ClosedParts& parts);

}  // namespace earthshine::radiosity
