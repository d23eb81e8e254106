// SPDX-License-Identifier: Apache-2.0
// Which triangles hang together by edges, and which of these surfaces are closed.
#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "scenes/scene.h"

namespace earthshine::radiosity {

// Triangles that hang together by edges (alike corners to the last bit), by the first of them;
// `closed` says of that one whether every edge is used equally often both ways. Sheets and glass
// are no part of any such surface: each of their triangles is a part of its own, which is open.
struct ClosedParts {
  // An edge that is used once more one way than the other: this way.
  struct RimEdge {
    std::uint32_t part, from, to;  // vertices
  };
  std::vector<std::uint32_t> of;
  std::vector<char> closed;
  std::vector<RimEdge> rims;  // by part
};
// left_out: by object, triangles that are taken as sheets are; empty: none.
[[nodiscard]] ClosedParts find_closed_parts(const scenes::Scene& scene,
                                            const std::vector<char>& left_out = {});

// The triangles of the parts that keep(part) says yes to, part by part, each in ascending order.
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

// Surfaces that are closed but for a hole that another surface stops up: a block without a bottom
// on a floor. Models leave out what nobody sees.

// By part the triangles, three corners each, that close it: for open parts whose rim lies in one
// plane, of which the part itself sticks out, and all around, corners and middles of edges, on
// opaque one-sided triangles of other parts that face the hole, within a millionth of the scene's
// size.
[[nodiscard]] std::map<std::uint32_t, std::vector<Vec3>> find_stoppers(const scenes::Scene& scene,
                                                                       const ClosedParts& parts);

}  // namespace earthshine::radiosity
