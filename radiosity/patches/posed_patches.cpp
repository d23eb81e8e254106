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
    const std::uint32_t third =
        facet.parallelogram ? scene.triangles[facet.triangle + 1].vertex[2] : vertex[2];
    const Facet now =
        facet_about({scene.vertices[vertex[0]], scene.vertices[vertex[1]], scene.vertices[third]},
                    facet.parallelogram ? 0 : facet.apex);
    if (now.corner == facet.corner && now.a == facet.a && now.b == facet.b) continue;
    facet.corner = now.corner;
    facet.a = now.a;
    facet.b = now.b;
    facet.normal = now.normal;
  }
  return patches;
}

}  // namespace earthshine::radiosity
