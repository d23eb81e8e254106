// SPDX-License-Identifier: Apache-2.0
#include "radiosity/patches/patch_offset.h"

#include <algorithm>

#include "radiosity/patches/cluster_members.h"

namespace earthshine::radiosity {

double patch_offset_m(const Patches& patches, const scenes::RayQuery& query, std::uint32_t patch) {
  const Facet& facet = patches.facets[patches.facet[patch]];
  if (!facet.is_cluster()) {
    const double first = query.offset_m(facet.triangle);
    return facet.parallelogram ? std::max(first, query.offset_m(facet.triangle + 1)) : first;
  }
  const ClusterSpan span = span_of(facet, patches.cell[patch]);
  double most = 0.0;
  for (std::uint32_t k = 0; k < span.count; ++k) {
    most = std::max(most, query.offset_m(patches.clustered->triangle[span.first + k]));
  }
  return most;
}

}  // namespace earthshine::radiosity
