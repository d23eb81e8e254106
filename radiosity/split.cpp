// SPDX-License-Identifier: Apache-2.0
#include "radiosity/split.h"

#include <array>

namespace earthshine::radiosity {
namespace {

struct Halves {
  std::uint32_t s = 1, t = 1;  // parts along s and t that the next cut makes
  [[nodiscard]] std::uint32_t children() const { return s * t; }
};

constexpr std::uint64_t most_cells = std::uint64_t{1} << 20;  // along one side of a facet

// The next cut of a cell of this level; one part when its cells would be too many.
Halves next_cut(const Facet& facet, std::uint32_t level) {
  const std::uint64_t rows = std::uint64_t{facet.s_count} << s_halvings(facet, level + 1);
  const std::uint64_t columns = std::uint64_t{facet.t_count} << t_halvings(facet, level + 1);
  if (rows > most_cells || columns > most_cells) return {};
  return {level >= facet.t_first ? 2U : 1U, level >= facet.s_first ? 2U : 1U};
}

// The new cells of one facet after the other.
class Cutter {
 public:
  Cutter(const Patches& old, const std::vector<std::uint8_t>& wanted) : old_(old), wanted_(wanted) {
    result_.patches.of_triangle = old.of_triangle;
    result_.patches.second_half = old.second_half;
    result_.patches.facets.reserve(old.facets.size());
  }

  void add(const Facet& facet) {
    Patches& patches = result_.patches;
    leaves_.clear();
    facet_ = &facet;
    const std::uint32_t grid = facet.s_count * facet.t_count;
    Facet made = facet;
    made.tree = no_tree;
    const bool splits = facet.tree != no_tree || any_wanted(facet);
    if (splits) {
      made.tree = static_cast<std::uint32_t>(patches.tree.size());
      patches.tree.resize(patches.tree.size() + grid);
    }
    for (std::uint32_t c = 0; c < grid; ++c) {
      const Cell cell{c / facet.t_count, c % facet.t_count, 0};
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

  [[nodiscard]] bool is_wanted(std::uint32_t leaf) const {
    return wanted_[facet_->first_front + leaf] != 0 ||
           (facet_->first_back != no_patch && wanted_[facet_->first_back + leaf] != 0);
  }
  [[nodiscard]] bool any_wanted(const Facet& facet) const {
    for (std::uint32_t leaf = 0; leaf < facet.leaves; ++leaf) {
      if (is_wanted(leaf)) return true;
    }
    return false;
  }

  // The old entry's cell goes to `slot` of the new tree, cut once more if it is a leaf that is
  // wanted.
  void place(std::uint32_t entry, const Cell& cell, std::uint32_t slot) {
    std::vector<std::uint32_t>& tree = result_.patches.tree;
    const bool was_split = (entry & Patches::split_cell) != 0;
    const Halves cut = next_cut(*facet_, cell.level);
    if (!was_split && (cut.children() == 1 || !is_wanted(entry))) {
      tree[slot] = static_cast<std::uint32_t>(leaves_.size());
      leaves_.push_back({cell, entry});
      return;
    }
    const auto block = static_cast<std::uint32_t>(tree.size());
    tree.resize(tree.size() + cut.children());
    tree[slot] = Patches::split_cell + block;
    for (std::uint32_t k = 0; k < cut.children(); ++k) {
      const Cell child{cell.s * cut.s + k / cut.t, cell.t * cut.t + k % cut.t, cell.level + 1};
      if (was_split) {
        place(old_.tree[(entry & ~Patches::split_cell) + k], child, block + k);
      } else {
        tree[block + k] = static_cast<std::uint32_t>(leaves_.size());
        leaves_.push_back({child, entry});
      }
    }
  }

  std::uint32_t add_side(const Facet& made, std::uint32_t old_first, std::uint8_t side) {
    Patches& patches = result_.patches;
    const auto first = static_cast<std::uint32_t>(patches.count());
    const auto index = static_cast<std::uint32_t>(patches.facets.size());
    for (const Leaf& leaf : leaves_) {
      patches.area_m2.push_back(area_of(made, rectangle_of(made, leaf.cell)));
      patches.facet.push_back(index);
      patches.cell.push_back(leaf.cell);
      patches.is_back.push_back(side);
      result_.parent.push_back(old_first + leaf.parent);
    }
    return first;
  }

  const Patches& old_;
  const std::vector<std::uint8_t>& wanted_;
  const Facet* facet_ = nullptr;
  std::vector<Leaf> leaves_;
  Split result_;
};

}  // namespace

Split split(const Patches& patches, const std::vector<std::uint8_t>& wanted) {
  Cutter cutter(patches, wanted);
  for (const Facet& facet : patches.facets) cutter.add(facet);
  return cutter.take();
}

void grade(const Patches& patches, std::vector<std::uint8_t>& wanted) {
  std::vector<std::uint32_t> queue;
  for (std::uint32_t i = 0; i < patches.count(); ++i) {
    if (wanted[i] != 0) queue.push_back(i);
  }
  while (!queue.empty()) {
    const std::uint32_t patch = queue.back();
    queue.pop_back();
    const Facet& facet = patches.facets[patches.facet[patch]];
    if (facet.tree == no_tree) continue;  // no cell has been cut more often than another
    const Rectangle r = patches.rectangle(patch);
    const double s = 0.5 * (r.s0 + r.s1), t = 0.5 * (r.t0 + r.t1);
    const double ds = r.s1 - r.s0, dt = r.t1 - r.t0;
    const std::uint32_t first = patches.is_back[patch] != 0 ? facet.first_back : facet.first_front;
    // A larger cell beside this one covers the point opposite its side's middle.
    const std::array<Parameters, 4> beside{{{s - ds, t}, {s + ds, t}, {s, t - dt}, {s, t + dt}}};
    for (const Parameters& p : beside) {
      if (p.s < 0.0 || p.s > 1.0 || p.t < 0.0 || p.t > 1.0) continue;
      const std::uint32_t other = first + patches.leaf(facet, p);
      if (wanted[other] != 0 || patches.cell[other].level >= patches.cell[patch].level) continue;
      wanted[other] = 1;
      queue.push_back(other);
    }
  }
}

std::uint32_t added_by_split(const Patches& patches, std::uint32_t patch) {
  const Facet& facet = patches.facets[patches.facet[patch]];
  const std::uint32_t more = next_cut(facet, patches.cell[patch].level).children() - 1;
  return facet.first_back != no_patch ? 2 * more : more;
}

}  // namespace earthshine::radiosity
