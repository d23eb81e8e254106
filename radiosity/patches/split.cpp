// SPDX-License-Identifier: Apache-2.0
#include "radiosity/patches/split.h"

#include <array>

#include "base/numbers/random.h"
#include "radiosity/patches/cluster_members.h"
#include "radiosity/patches/parted_cell.h"

namespace earthshine::radiosity {
namespace {

constexpr std::uint64_t most_cells_a_side = std::uint64_t{1} << 20;  // per side of a facet

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

// Creates the new cells facet by facet.
class Cutter {
 public:
  Cutter(const Patches& old, const std::vector<Cut>& wanted) : old_(old), wanted_(wanted) {
    result_.patches.of_triangle = old.of_triangle;
    result_.patches.second_half = old.second_half;
    result_.patches.clustered = old.clustered;
    result_.patches.cluster_edge_m = old.cluster_edge_m;
    result_.patches.traces = old.traces;
    result_.patches.facets.reserve(old.facets.size());
  }

  void add(const Facet& facet) {
    Patches& patches = result_.patches;
    leaves_.clear();
    facet_ = &facet;
    const std::uint32_t grid = facet.s_count * facet.t_count;
    Facet made = facet;
    number_ = static_cast<std::uint32_t>(patches.facets.size());
    has_walls_ = old_.traces && old_.traces->any(number_);
    const bool splits = facet.tree != no_tree || has_walls_ || any_wanted();
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

  // The request of any of `count` leaves, the parts of one cell.
  [[nodiscard]] Cut cut_of(std::uint32_t leaf, std::uint32_t count = 1) const {
    Cut cut = Cut::None;
    for (const std::uint32_t first : {facet_->first_front, facet_->first_back}) {
      if (first == no_patch) continue;
      for (std::uint32_t k = leaf; k < leaf + count && cut == Cut::None; ++k) {
        cut = wanted_[first + k];
      }
    }
    return can_cut_cell(*facet_, old_.cell[facet_->first_front + leaf], cut) ? cut : Cut::None;
  }
  [[nodiscard]] bool any_wanted() const {
    for (std::uint32_t leaf = 0; leaf < facet_->leaves; ++leaf) {
      if (cut_of(leaf) != Cut::None) return true;
    }
    return false;
  }

  // Copies the old entry's cell to `slot` of the new tree, halved if requested.
  void place(std::uint32_t entry, const Cell& cell, std::uint32_t slot) {
    std::vector<std::uint32_t>& tree = result_.patches.tree;
    const bool was_parted = (entry & Patches::parted_cell) != 0;
    const bool was_split = !was_parted && (entry & Patches::split_cell) != 0;
    Cut cut = (entry & Patches::halves_t) != 0 ? Cut::T : Cut::S;
    if (!was_split) cut = was_parted ? cut_of_parts(entry & Patches::pair_of) : cut_of(entry);
    if (cut == Cut::None) return add_leaf(cell, entry, slot);
    const auto pair = static_cast<std::uint32_t>(tree.size());
    tree.resize(tree.size() + 2);
    tree[slot] = (Patches::split_cell | (cut == Cut::T ? Patches::halves_t : 0U)) + pair;
    const std::uint32_t old_pair = entry & Patches::pair_of;
    for (std::uint32_t half = 0; half < 2; ++half) {
      const Cell child = half_of(cell, cut, half);
      if (was_split) {
        place(old_.tree[old_pair + half], child, pair + half);
      } else {
        add_leaf(child, entry, pair + half);
      }
    }
  }

  [[nodiscard]] Cut cut_of_parts(std::uint32_t at) const {
    const std::uint32_t first = old_.tree[at];
    std::uint32_t count = 1;
    while (first + count < facet_->leaves &&
           old_.cell[facet_->first_front + first + count].part == count) {
      ++count;
    }
    return cut_of(first, count);
  }

  // Adds the cell, or its parts, at `slot` of the new tree. `entry`: of the old cell that contains
  // it.
  void add_leaf(const Cell& cell, std::uint32_t entry, std::uint32_t slot) {
    std::vector<std::uint32_t>& tree = result_.patches.tree;
    const auto first = static_cast<std::uint32_t>(leaves_.size());
    const PartedCell parted = has_walls_ ? parts_of(cell) : PartedCell();
    if (parted.outlines.empty()) {
      leaves_.push_back({cell, parent_of(entry, cell, nullptr)});
      tree[slot] = first;
      return;
    }
    Patches& patches = result_.patches;
    tree[slot] =
        Patches::split_cell | Patches::parted_cell | static_cast<std::uint32_t>(tree.size());
    tree.push_back(first);
    tree.push_back(static_cast<std::uint32_t>(patches.part_nodes.size()));
    Cell part = cell;
    part.outline = static_cast<std::uint32_t>(patches.outlines.size());
    append(patches, parted);
    for (const Outline& outline : parted.outlines) {
      leaves_.push_back({part, parent_of(entry, cell, &outline)});
      ++part.part;
      ++part.outline;
    }
  }

  [[nodiscard]] PartedCell parts_of(const Cell& cell) {
    old_.traces->near(number_, outline_of(*facet_, cell), near_);
    return part_cell(*facet_, cell, near_);
  }

  // The old leaf that contains the middle of a cell or part.
  [[nodiscard]] std::uint32_t parent_of(std::uint32_t entry, const Cell& cell,
                                        const Outline* part) const {
    if ((entry & Patches::parted_cell) == 0) return entry;
    const Outline o = part != nullptr ? *part : outline_of(*facet_, cell);
    const std::uint32_t at = entry & Patches::pair_of;
    return old_.tree[at] + old_.part_at(old_.tree[at + 1], 0.25 * (o[0] + o[1] + o[2] + o[3]));
  }

  std::uint32_t add_side(const Facet& made, std::uint32_t old_first, std::uint8_t side) {
    Patches& patches = result_.patches;
    const auto first = static_cast<std::uint32_t>(patches.count());
    for (const Leaf& leaf : leaves_) {
      patches.area_m2.push_back(area_of(patches, made, leaf.cell));
      patches.facet.push_back(number_);
      patches.cell.push_back(leaf.cell);
      patches.is_back.push_back(side);
      result_.parent.push_back(old_first + leaf.parent);
    }
    return first;
  }

  const Patches& old_;
  const std::vector<Cut>& wanted_;
  const Facet* facet_ = nullptr;
  std::uint32_t number_ = 0;  // index of the facet
  bool has_walls_ = false;
  std::vector<Trace> near_;
  std::vector<Leaf> leaves_;
  Split result_;
};

}  // namespace

Split split(const Patches& patches, const std::vector<Cut>& wanted) {
  Cutter cutter(patches, wanted);
  for (const Facet& facet : patches.facets) cutter.add(facet);
  return cutter.take();
}

Patches part_along(Patches patches, Traces traces) {
  if (!traces.any()) return patches;
  patches.traces = std::make_shared<const Traces>(std::move(traces));
  const std::vector<Cut> none(patches.count(), Cut::None);
  return split(patches, none).patches;
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
    // Without a tree all cells have equal size; cells of clusters have no known neighbours.
    if (facet.tree == no_tree || facet.is_cluster()) continue;
    const Rectangle r = patches.rectangle(patch);
    const double ds = 0.25 * (r.s1 - r.s0), dt = 0.25 * (r.t1 - r.t0);
    const std::uint32_t first = patches.is_back[patch] != 0 ? facet.first_back : facet.first_front;
    const auto cuts = [&](std::uint32_t i) {
      return wanted[patch] == Cut::S ? patches.cell[i].s_cuts : patches.cell[i].t_cuts;
    };
    // Two points on each side: a neighbour has at least half the width.
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
  const Facet& f = patches.facets[patches.facet[patch]];
  if (patches.is_part(patch)) {
    const Outline o = outline_of(f, patches.cell[patch]);
    const auto edge = [&](std::size_t a, std::size_t b) {
      return glm::length((o[b].x - o[a].x) * f.a + (o[b].y - o[a].y) * f.b);
    };
    return {std::max(edge(0, 1), edge(3, 2)), std::max(edge(1, 2), edge(0, 3))};
  }
  const std::array<Vec3, 4> c = patches.corners(patch);
  const auto longest = [&](int a, int b, int d, int e) {
    return std::max(glm::length(c[static_cast<std::size_t>(a)] - c[static_cast<std::size_t>(b)]),
                    glm::length(c[static_cast<std::size_t>(d)] - c[static_cast<std::size_t>(e)]));
  };
  // corners() begins at s0 t0 and goes along s first, on a back along t first.
  const double first = longest(0, 1, 3, 2), second = longest(1, 2, 0, 3);
  return patches.is_back[patch] != 0 ? CellSize{second, first} : CellSize{first, second};
}

std::uint64_t identity(const Patches& patches, std::uint32_t patch) {
  const Cell& cell = patches.cell[patch];
  const std::uint64_t place = (std::uint64_t{cell.s} << 32) | cell.t;
  const std::uint64_t facet =
      (std::uint64_t{patches.facet[patch]} << 16) | (std::uint64_t{cell.s_cuts} << 8) | cell.t_cuts;
  return base::mix64(base::mix64(facet) ^ place) ^ (2U * cell.part + patches.is_back[patch]);
}

}  // namespace earthshine::radiosity
