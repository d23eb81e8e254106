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
[[nodiscard]] ClosedParts find_closed_parts(const scenes::Scene& scene);

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

}  // namespace earthshine::radiosity
