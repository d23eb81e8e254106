// SPDX-License-Identifier: Apache-2.0
// Which triangles hang together by edges, and which of these surfaces are closed.
#pragma once

#include <cstdint>
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

}  // namespace earthshine::radiosity
