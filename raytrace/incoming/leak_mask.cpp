// SPDX-License-Identifier: Apache-2.0
#include "raytrace/incoming/leak_mask.h"

#include <algorithm>
#include <mutex>

#include "base/parallel.h"
#include "radiosity/patches/patch_offset.h"
#include "raytrace/incoming/radiance_table.h"

namespace earthshine::raytrace {
namespace {

using Pair = std::pair<std::uint32_t, std::uint32_t>;

// Pairs of cells of the facet that interpolate with each other, by leaf numbers.
void neighbours_of(const radiosity::Patches& patches, const radiosity::Facet& facet,
                   std::vector<Pair>& pairs) {
  pairs.clear();
  if (facet.is_cluster()) return;
  if (facet.tree == radiosity::no_tree) {
    const std::uint32_t columns = facet.t_count;
    for (std::uint32_t leaf = 0; leaf < facet.leaves; ++leaf) {
      const std::uint32_t t = leaf % columns;
      if (t + 1 < columns) pairs.emplace_back(leaf, leaf + 1);
      if (leaf + columns >= facet.leaves) continue;
      if (t > 0) pairs.emplace_back(leaf, leaf + columns - 1);
      pairs.emplace_back(leaf, leaf + columns);
      if (t + 1 < columns) pairs.emplace_back(leaf, leaf + columns + 1);
    }
    return;
  }
  std::vector<KnotTerm> terms;
  for (std::uint32_t leaf = 0; leaf < facet.leaves; ++leaf) {
    terms.clear();
    for (std::uint32_t knot = 0; knot < knots_per_cell; ++knot) {
      add_knot_terms(patches, facet, leaf, knot / 3, knot % 3, terms);
    }
    for (const KnotTerm& term : terms) {
      if (term.leaf != leaf) pairs.push_back(std::minmax({leaf, term.leaf}));
    }
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

// Appends the pairs that do not see each other, moved up to the side's first patch.
void find_parted(const scenes::RayQuery& query, const radiosity::Patches& patches,
                 const std::vector<Pair>& pairs, std::uint32_t first, std::vector<Pair>& parted) {
  constexpr double lift_per_length = 1e-3;  // above rounding errors where a wall meets the floor
  scenes::RayPacket packet;
  for (std::size_t begin = 0; begin < pairs.size(); begin += scenes::RayPacket::width) {
    const std::size_t count = std::min(scenes::RayPacket::width, pairs.size() - begin);
    for (std::size_t k = 0; k < count; ++k) {
      const auto [low, high] = pairs[begin + k];
      const Vec3 from = patches.point(first + low, 0.5, 0.5);
      const Vec3 offset = patches.point(first + high, 0.5, 0.5) - from;
      const double length = glm::length(offset);
      const double lift = std::max(radiosity::patch_offset_m(patches, query, first + low),
                                   lift_per_length * length);
      query.set(packet, k, from + lift * patches.normal(first + low), offset / length, length);
    }
    const std::uint32_t hidden = query.occluded(packet, count);
    for (std::size_t k = 0; k < count; ++k) {
      if (((hidden >> k) & 1U) == 0) continue;
      parted.emplace_back(first + pairs[begin + k].first, first + pairs[begin + k].second);
    }
  }
}

}  // namespace

LeakMask::LeakMask(const scenes::RayQuery& query, const radiosity::Patches& patches) {
  std::mutex together;
  base::parallel_chunks(patches.facets.size(), 16, [&](std::size_t begin, std::size_t end) {
    std::vector<Pair> pairs, parted;
    std::uint64_t rays = 0;
    for (std::size_t f = begin; f < end; ++f) {
      const radiosity::Facet& facet = patches.facets[f];
      neighbours_of(patches, facet, pairs);
      for (const std::uint32_t first : {facet.first_front, facet.first_back}) {
        if (first == radiosity::no_patch) continue;
        find_parted(query, patches, pairs, first, parted);
        rays += pairs.size();
      }
    }
    const std::lock_guard<std::mutex> lock(together);
    parted_.insert(parted_.end(), parted.begin(), parted.end());
    rays_ += rays;
  });
  if (parted_.empty()) return;
  std::sort(parted_.begin(), parted_.end());
  at_wall_.assign(patches.count(), 0);
  for (const auto& [low, high] : parted_) at_wall_[low] = at_wall_[high] = 1;
}

bool LeakMask::parted(std::uint32_t a, std::uint32_t b) const {
  if (!at_wall(a) || !at_wall(b)) return false;
  return std::binary_search(parted_.begin(), parted_.end(), Pair(std::minmax(a, b)));
}

}  // namespace earthshine::raytrace
