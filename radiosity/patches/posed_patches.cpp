// SPDX-License-Identifier: Apache-2.0
#include "radiosity/patches/posed_patches.h"

#include "radiosity/patches/cluster_members.h"

namespace earthshine::radiosity {

Patches posed_patches(Patches patches, const scenes::Scene& scene) {
  if (patches.clustered) {
    ClusterMembers members = *patches.clustered;
    members.vertices = scene.vertices;
    patches.clustered = std::make_shared<const ClusterMembers>(std::move(members));
  }
  for (Facet& facet : patches.facets) {
    if (facet.is_cluster()) {
      facet.normal =
          patches.clustered->normal({facet.first_member, facet.members, {0.0, 1.0, 0.0, 1.0}});
      continue;
    }
    const auto& vertex = scene.triangles[facet.triangle].vertex;
    const auto at = [&](std::uint32_t v) { return scene.vertices[v]; };
    const std::size_t apex = facet.parallelogram ? 0 : facet.apex;
    const Vec3 corner = at(vertex[apex]), a = at(vertex[(apex + 1) % 3]) - corner;
    const Vec3 b = (facet.parallelogram ? at(scene.triangles[facet.triangle + 1].vertex[2])
                                        : at(vertex[(apex + 2) % 3])) -
                   corner;
    if (corner == facet.corner && a == facet.a && b == facet.b) continue;
    facet.corner = corner;
    facet.a = a;
    facet.b = b;
    facet.normal = glm::normalize(glm::cross(a, b));
  }
  return patches;
}

}  // namespace earthshine::radiosity
