// SPDX-License-Identifier: Apache-2.0
// Face clusters: neighbouring small triangles of like normal as one patch (Willmott, Heckbert and
// Garland, "Face cluster radiosity", 1999), so that a solve costs what its light asks for and not
// what the mesh has.
#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/patches/cluster_members.h"
#include "scenes/scene.h"

namespace earthshine::radiosity {

struct Clusters {
  ClusterMembers members;            // vertices left out
  std::vector<std::uint32_t> first;  // per cluster its first member; one entry more
  [[nodiscard]] std::size_t count() const { return first.empty() ? 0 : first.size() - 1; }
};

// Triangles of one object and material that hang together by edges at which the surface turns by
// less than 22.5 degrees, and none of whose edges is longer than the diagonal of a square of
// edge_m, are parted until the middles of each cluster's triangles are within edge_m and their
// normals within 11 degrees along every axis. Mirrors, glass, what has an opacity mask and what
// another face lies on are left out; one triangle, or the two of a quadrilateral, are no cluster.
// None for edge_m = 0. Where clusters are only counted their triangles need no order.
enum class Members : std::uint8_t { Ordered, Unordered };
[[nodiscard]] Clusters find_clusters(const scenes::Scene& scene, double edge_m, Members members);

}  // namespace earthshine::radiosity
