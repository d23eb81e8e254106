// SPDX-License-Identifier: Apache-2.0
#include "radiosity/patches/split.h"

#include <array>

#include "radiosity/patches/cluster_members.h"

namespace earthshine::radiosity {
namespace {

constexpr std::uint64_t most_cells_a_side = std::uint64_t{1} << 20;  // of a facet

constexpr std::uint8_t most_digits = 30;  // of the parameter s of a cluster

bool can_cut_cell(const Facet& facet, const Cell& cell, Cut cut) {
  if (facet.is_cluster() && cut == Cut::S) return cell.s_cuts < most_digits;
  if (facet.is_cluster() && span_of(facet, cell).count > 1) return false;
  if (cut == Cut::S)
    return (std::uint64_t{facet.s_count} << (cell.s_cuts + 1)) <= most_cells_a_side;
  return cut == Cut::T && (std::uint64_t{facet.t_count} << (cell.t_cuts + 1)) <= most_cells_a_side;
}

Cell half_of(Cell cell, Cut cut, std::uint32_t half) {
  if (cut == Cut::S) {
    cell.s = 2 * cell.s + half;
    ++cell.s_cuts;
  } else {
    cell.t = 2 * cell.t + half;
    ++cell.t_cuts;
  }
  return cell;
}

// The new cells of one facet after the other.
class Cutter {
 public:
  Cutter(const Patches& old, const std::vector<Cut>& wanted) : old_(old), wanted_(wanted) {
    result_.patches.of_triangle = old.of_triangle;
    result_.patches.second_half = old.second_half;
    result_.patches.clustered = old.clustered;
    result_.patches.cluster_edge_m = old.cluster_edge_m;
    result_.patches.facets.reserve(old.facets.size());
  }

  void add(const Facet& facet) {
    Patches& patches = result_.patches;
    leaves_.clear();
    facet_ = &facet;
    const std::uint32_t grid = facet.s_count * facet.t_count;
    Facet made = facet;
    const bool splits = facet.tree != no_tree || any_wanted();
    if (splits) {
      made.tree = static_cast<std::uint32_t>(patches.tree.size());
      patches.tree.resize(patches.tree.size() + grid);
    }
    for (std::uint32_t c = 0; c < grid; ++c) {
      const Cell cell{c / facet.t_count, c % facet.t_count};
      const std::uint32_t entry = facet.tree == no_tree ? c : old_.tree[facet.tree + c];
      if (splits) {
        place(entry, cell, made.tree + c);
      } else {
        leaves_.push_back({cell, entry});
      }
    }
    made.leaves = static_cast<std::uint32_t>(leaves_.size());
    made.first_front = add_side(made, facet.first_front, 0);
    if (facet.first_back != no_patch) made.first_back = add_side(made, facet.first_back, 1);
    patches.facets.push_back(made);
  }

  Split take() { return std::move(result_); }

 private:
  struct Leaf {
    Cell cell;
    std::uint32_t parent;  // leaf of the old facet
  };

  [[nodiscard]] Cut cut_of(std::uint32_t leaf) const {
    Cut cut = wanted_[facet_->first_front + leaf];
    if (cut == Cut::None && facet_->first_back != no_patch) {
      cut = wanted_[facet_->first_back + leaf];
    }
    return can_cut_cell(*facet_, old_.cell[facet_->first_front + leaf], cut) ? cut : Cut::None;
  }
  [[nodiscard]] bool any_wanted() const {
    for (std::uint32_t leaf = 0; leaf < facet_->leaves; ++leaf) {
      if (cut_of(leaf) != Cut::None) return true;
    }
    return false;
  }

  // The old entry's cell goes to `slot` of the new tree, halved if it is a leaf that is wanted.
  void place(std::uint32_t entry, const Cell& cell, std::uint32_t slot) {
    std::vector<std::uint32_t>& tree = result_.patches.tree;
    const bool was_split = (entry & Patches::split_cell) != 0;
    Cut cut = (entry & Patches::halves_t) != 0 ? Cut::T : Cut::S;
    if (!was_split) cut = cut_of(entry);
    if (cut == Cut::None) {
      tree[slot] = add_leaf(cell, entry);
      return;
    }
    const auto pair = static_cast<std::uint32_t>(tree.size());
    tree.resize(tree.size() + 2);
    tree[slot] = (Patches::split_cell | (cut == Cut::T ? Patches::halves_t : 0U)) + pair;
    const std::uint32_t old_pair = entry & ~(Patches::split_cell | Patches::halves_t);
    for (std::uint32_t half = 0; half < 2; ++half) {
      const Cell child = half_of(cell, cut, half);
      if (was_split) {
        place(old_.tree[old_pair + half], child, pair + half);
      } else {
        tree[pair + half] = add_leaf(child, entry);
      }
    }
  }

  std::uint32_t add_leaf(const Cell& cell, std::uint32_t parent) {
    leaves_.push_back({cell, parent});
    return static_cast<std::uint32_t>(leaves_.size() - 1);
  }

  std::uint32_t add_side(const Facet& made, std::uint32_t old_first, std::uint8_t side) {
    Patches& patches = result_.patches;
    const auto first = static_cast<std::uint32_t>(patches.count());
    const auto index = static_cast<std::uint32_t>(patches.facets.size());
    for (const Leaf& leaf : leaves_) {
      patches.area_m2.push_back(area_of(patches, made, leaf.cell));
      patches.facet.push_back(index);
      patches.cell.push_back(leaf.cell);
      patches.is_back.push_back(side);
      result_.parent.push_back(old_first + leaf.parent);
    }
    return first;
  }

  const Patches& old_;
  const std::vector<Cut>& wanted_;
  const Facet* facet_ = nullptr;
  std::vector<Leaf> leaves_;
  Split result_;
};

}  // namespace

Split split(const Patches& patches, const std::vector<Cut>& wanted) {
  Cutter cutter(patches, wanted);
  for (const Facet& facet : patches.facets) cutter.add(facet);
  return cutter.take();
}

void grade(const Patches& patches, std::vector<Cut>& wanted) {
  std::vector<std::uint32_t> queue;
  for (std::uint32_t i = 0; i < patches.count(); ++i) {
    if (wanted[i] != Cut::None) queue.push_back(i);
  }
  while (!queue.empty()) {
    const std::uint32_t patch = queue.back();
    queue.pop_back();
    const Facet& facet = patches.facets[patches.facet[patch]];
    // No cell has been cut more often than another, or which ones are neighbours is not known.
    if (facet.tree == no_tree || facet.is_cluster()) continue;
    const Rectangle r = patches.rectangle(patch);
    const double ds = 0.25 * (r.s1 - r.s0), dt = 0.25 * (r.t1 - r.t0);
    const std::uint32_t first = patches.is_back[patch] != 0 ? facet.first_back : facet.first_front;
    const auto cuts = [&](std::uint32_t i) {
      return wanted[patch] == Cut::S ? patches.cell[i].s_cuts : patches.cell[i].t_cuts;
    };
    // Two on each side: a neighbour is at least half as wide.
    const std::array<Parameters, 8> beside{{{r.s0 - ds, r.t0 + dt},
                                            {r.s0 - ds, r.t1 - dt},
                                            {r.s1 + ds, r.t0 + dt},
                                            {r.s1 + ds, r.t1 - dt},
                                            {r.s0 + ds, r.t0 - dt},
                                            {r.s1 - ds, r.t0 - dt},
                                            {r.s0 + ds, r.t1 + dt},
                                            {r.s1 - ds, r.t1 + dt}}};
    for (const Parameters& p : beside) {
      if (p.s < 0.0 || p.s > 1.0 || p.t < 0.0 || p.t > 1.0) continue;
      const std::uint32_t other = first + patches.leaf(facet, p);
      if (wanted[other] != Cut::None || cuts(other) >= cuts(patch)) continue;
      wanted[other] = wanted[patch];
      queue.push_back(other);
    }
  }
}

bool can_cut(const Patches& patches, std::uint32_t patch, Cut cut) {
  return can_cut_cell(patches.facets[patches.facet[patch]], patches.cell[patch], cut);
}

CellSize cell_size(const Patches& patches, std::uint32_t patch) {
  if (patches.is_several(patch)) {
    const auto [low, high] = patches.box(patch);
    return {base::max_component(high - low), 0.0};
  }
  const std::array<Vec3, 4> c = patches.corners(patch);
  const auto longest = [&](int a, int b, int d, int e) {
    return std::max(glm::length(c[static_cast<std::size_t>(a)] - c[static_cast<std::size_t>(b)]),
                    glm::length(c[static_cast<std::size_t>(d)] - c[static_cast<std::size_t>(e)]));
  };
  // corners() runs from s0 t0 along s first, on a back along t first.
  const double first = longest(0, 1, 3, 2), second = longest(1, 2, 0, 3);
  return patches.is_back[patch] != 0 ? CellSize{second, first} : CellSize{first, second};
}

}  // namespace earthshine::radiosity
