// SPDX-License-Identifier: Apache-2.0
#include "radiosity/patches/patch_layout.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "radiosity/patches/cluster_members.h"
#include "radiosity/patches/parted_cell.h"

namespace earthshine::radiosity {
namespace {

constexpr std::uint64_t most_cells = std::uint64_t{1} << 26;
constexpr std::uint32_t deepest_level = 31;
constexpr std::uint32_t last_row = 0x7FFFFFFFU;  // largest row that can be halved in 32 bits
// Rounding error of sums over many areas.
constexpr double area_rounding = 1e-7;

void demand(bool holds, const char* otherwise) {
  if (!holds) throw std::invalid_argument(otherwise);
}

// Reads the leaves of a facet in the order of their numbers. `used` marks visited tree entries, so
// that no two facets share a pair and no path is cyclic.
class Leaves {
 public:
  Leaves(Patches& patches, std::uint32_t number, std::vector<bool>& used)
      : patches_(patches),
        number_(number),
        facet_(patches.facets[number]),
        tree_(patches.tree),
        used_(used),
        cells_(facet_.leaves),
        seen_(facet_.leaves) {
    const Facet& facet = facet_;
    const std::uint64_t grid = std::uint64_t{facet.s_count} * facet.t_count;
    for (std::uint32_t s = 0; s < facet.s_count; ++s) {
      for (std::uint32_t t = 0; t < facet.t_count; ++t) {
        const std::uint32_t in_grid = s * facet.t_count + t;
        if (facet.tree == no_tree) {
          take(in_grid, {s, t, 0, 0});
        } else {
          demand(facet.tree + grid <= tree_.size(), "a facet's tree leads out of the table");
          walk(std::uint64_t{facet.tree} + in_grid, {s, t, 0, 0});
        }
      }
    }
    demand(found_ == facet.leaves, "a facet has leaves that nothing leads to");
  }

  [[nodiscard]] const std::vector<Cell>& cells() const { return cells_; }

 private:
  void take(std::uint32_t leaf, const Cell& cell) {
    demand(leaf < cells_.size() && !seen_[leaf], "a leaf's number is out of range or taken");
    cells_[leaf] = cell;
    seen_[leaf] = true;
    ++found_;
  }
  void walk(std::uint64_t at, const Cell& cell) {
    demand(!used_[at], "two cells share a place in the tree");
    used_[at] = true;
    const std::uint32_t entry = tree_[at];
    if ((entry & Patches::split_cell) == 0) return take(entry, cell);
    if ((entry & Patches::parted_cell) != 0) return take_parts(entry & Patches::pair_of, cell);
    const bool along_t = (entry & Patches::halves_t) != 0;
    const std::uint64_t pair = entry & Patches::pair_of;
    demand(pair + 2 <= tree_.size(), "the tree leads out of the table");
    demand((along_t ? cell.t_cuts : cell.s_cuts) < deepest_level && cell.s <= last_row &&
               cell.t <= last_row,
           "the tree is too deep");
    demand(!along_t || !facet_.is_cluster() || span_of(facet_, cell).count == 1,
           "several triangles are halved along t");
    for (std::uint32_t k = 0; k < 2; ++k) {
      Cell half = cell;
      if (along_t) {
        half.t = 2 * cell.t + k;
        ++half.t_cuts;
      } else {
        half.s = 2 * cell.s + k;
        ++half.s_cuts;
      }
      walk(pair + k, half);
    }
  }

  // The scene's walls define the parts.
  void take_parts(std::uint64_t at, const Cell& cell) {
    demand(at + 2 <= tree_.size() && !used_[at] && !used_[at + 1],
           "the tree leads out of the table");
    used_[at] = used_[at + 1] = true;
    demand(patches_.traces != nullptr, "a cell is parted that no wall stands on");
    std::vector<Trace> near;
    patches_.traces->near(number_, outline_of(facet_, cell), near);
    const PartedCell parted = part_cell(facet_, cell, near);
    demand(!parted.outlines.empty(), "a cell is parted that no wall stands on");
    tree_[at + 1] = static_cast<std::uint32_t>(patches_.part_nodes.size());
    Cell part = cell;
    part.outline = static_cast<std::uint32_t>(patches_.outlines.size());
    append(patches_, parted);
    for (std::size_t k = 0; k < parted.outlines.size(); ++k, ++part.part, ++part.outline) {
      take(tree_[at] + static_cast<std::uint32_t>(k), part);
    }
  }

  Patches& patches_;
  std::uint32_t number_;
  const Facet& facet_;
  std::vector<std::uint32_t>& tree_;
  std::vector<bool>& used_;
  std::vector<Cell> cells_;
  std::vector<bool> seen_;
  std::uint64_t found_ = 0;
};

void place(Patches& patches, std::uint32_t index, std::uint32_t first, std::uint8_t side,
           const std::vector<Cell>& cells) {
  demand(std::uint64_t{first} + cells.size() <= patches.count(), "a facet's patches lead too far");
  double area = 0.0;
  for (std::size_t leaf = 0; leaf < cells.size(); ++leaf) {
    const std::size_t patch = first + leaf;
    demand(patches.facet[patch] == no_patch, "two facets share a patch");
    demand(patches.area_m2[patch] > 0.0, "a patch has no area");
    patches.facet[patch] = index;
    patches.cell[patch] = cells[leaf];
    patches.is_back[patch] = side;
    area += patches.area_m2[patch];
  }
  const double whole = patches.facets[index].area_m2;
  demand(std::abs(area - whole) <= area_rounding * whole, "areas do not add up to the facet's");
}

}  // namespace

PatchLayout layout_of(const Patches& patches) {
  PatchLayout layout;
  for (const Facet& facet : patches.facets) {
    layout.s_count.push_back(facet.s_count);
    layout.t_count.push_back(facet.t_count);
    layout.first_front.push_back(facet.first_front);
    layout.first_back.push_back(facet.first_back);
    layout.leaves.push_back(facet.leaves);
    layout.tree_start.push_back(facet.tree);
  }
  layout.tree = patches.tree;
  layout.area_m2 = patches.area_m2;
  layout.cluster_edge_m = patches.cluster_edge_m;
  return layout;
}

Patches rebuild_patches(const scenes::Scene& scene, PatchLayout layout, const FindTraces& walls) {
  // Undivided facets supply the geometry.
  Patches patches =
      subdivide(scene, std::numeric_limits<double>::infinity(), layout.cluster_edge_m);
  const std::size_t facets = patches.facets.size();
  for (const auto* column : {&layout.s_count, &layout.t_count, &layout.first_front,
                             &layout.first_back, &layout.leaves, &layout.tree_start}) {
    demand(column->size() == facets, "the scene has another number of facets");
  }
  patches.tree = std::move(layout.tree);
  patches.area_m2 = std::move(layout.area_m2);
  constexpr std::uint32_t parted = Patches::split_cell | Patches::parted_cell;
  if (walls && std::any_of(patches.tree.begin(), patches.tree.end(),
                           [](std::uint32_t entry) { return (entry & parted) == parted; })) {
    patches.traces = std::make_shared<const Traces>(walls(scene, patches));
  }
  const std::size_t count = patches.area_m2.size();
  demand(count <= most_cells, "it has too many patches");
  patches.facet.assign(count, no_patch);
  patches.cell.assign(count, {});
  patches.is_back.assign(count, 0);
  std::vector<bool> used(patches.tree.size());
  std::uint64_t placed = 0;
  for (std::uint32_t k = 0; k < facets; ++k) {
    Facet& facet = patches.facets[k];
    const bool sheet = facet.first_back != no_patch;
    facet.s_count = layout.s_count[k];
    facet.t_count = layout.t_count[k];
    facet.first_front = layout.first_front[k];
    facet.first_back = layout.first_back[k];
    facet.leaves = layout.leaves[k];
    facet.tree = layout.tree_start[k];
    const std::uint64_t grid = std::uint64_t{facet.s_count} * facet.t_count;
    demand(grid > 0 && grid <= facet.leaves, "a facet's grid has no cell or more than leaves");
    demand(grid == 1 || !facet.is_cluster(), "a cluster has a grid");
    placed += std::uint64_t{facet.leaves} * (sheet ? 2 : 1);
    demand(placed <= count, "the facets have more leaves than there are patches");
    demand((facet.first_back != no_patch) == sheet, "a sheet has no back, or another surface has");
    const Leaves leaves(patches, k, used);
    place(patches, k, facet.first_front, 0, leaves.cells());
    if (sheet) place(patches, k, facet.first_back, 1, leaves.cells());
  }
  demand(placed == count, "a patch has no facet");
  return patches;
}

}  // namespace earthshine::radiosity
