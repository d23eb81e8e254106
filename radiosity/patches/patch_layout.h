// SPDX-License-Identifier: Apache-2.0
// Division of facets without the geometry, which the scene supplies: stored in files and validated
// when read.
#pragma once

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <vector>

#include "radiosity/patches/parted_cell.h"
#include "radiosity/patches/patches.h"

namespace earthshine::radiosity {

struct PatchLayout {
  // Per facet, as in Facet.
  std::vector<std::uint32_t> s_count, t_count, first_front, first_back, leaves, tree_start;
  std::vector<std::uint32_t> tree;
  std::vector<double> area_m2;  // per patch
  double cluster_edge_m = 0.0;  // as in Patches
};

[[nodiscard]] PatchLayout layout_of(const Patches& patches);

// Computes the walls on facets, when divided cells need them.
using FindTraces = std::function<Traces(const scenes::Scene&, const Patches&)>;

// Builds the patches of the layout. Throws std::invalid_argument with the reason unless every patch
// belongs to exactly one leaf of one side, every leaf is reached once, and areas add up to their
// facets' areas.
[[nodiscard]] Patches rebuild_patches(const scenes::Scene& scene, PatchLayout layout,
                                      const FindTraces& walls = {});

}  // namespace earthshine::radiosity
