// SPDX-License-Identifier: Apache-2.0
// Face clusters: neighbouring small triangles with similar normals form one patch (Willmott,
// Heckbert and Garland, "Face cluster radiosity", 1999), so that the cost of a solve depends on the
// light, not on the mesh.
#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/patches/cluster_members.h"
#include "scenes/scene.h"

namespace earthshine::radiosity {

struct Clusters {
  ClusterMembers members;            // without vertices
  std::vector<std::uint32_t> first;  // first member of each cluster, and the end
  [[nodiscard]] std::size_t count() const { return first.empty() ? 0 : first.size() - 1; }
};

// Connected triangles of one object and material, where the surface bends by less than 22.5 degrees
// at common edges and no edge is longer than the diagonal of a square of edge_m. They are divided
// until the centres of each cluster's triangles are within edge_m and their normals within 11
// degrees along every axis. Mirrors, glass, opacity masks and faces under another face are
// excluded; one triangle, or the two of a quadrilateral, form no cluster. None for edge_m = 0. To
// count clusters their members need no order.
enum class Members : std::uint8_t { Ordered, Unordered };
[[nodiscard]] Clusters find_clusters(const scenes::Scene& scene, double edge_m, Members members);

}  // namespace earthshine::radiosity
