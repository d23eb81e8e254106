// SPDX-License-Identifier: Apache-2.0
#include "radiosity/factors/hit_targets.h"

namespace earthshine::radiosity {

HitTargets::HitTargets(const Patches& patches, const std::vector<bool>& passes_on)
    : patches_(patches), targets_(patches.of_triangle.size()) {
  for (std::size_t k = 0; k < targets_.size(); ++k) {
    const Facet& facet = patches.facets[patches.of_triangle[k]];
    Target& target = targets_[k];
    target.s_count = facet.s_count;
    target.t_count = facet.t_count;
    target.first_front = facet.first_front;
    target.first_back = facet.first_back;
    target.tree = facet.tree;
    target.passes_on = passes_on[facet.material] ? 1 : 0;
    target.kind =
        static_cast<std::uint8_t>(facet.is_cluster()    ? cluster_kind
                                  : facet.parallelogram ? triangle_kinds + patches.second_half[k]
                                                        : facet.apex);
  }
}

}  // namespace earthshine::radiosity
