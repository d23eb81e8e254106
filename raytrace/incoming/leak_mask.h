// SPDX-License-Identifier: Apache-2.0
// Which neighbouring cells of a facet something parts: a wall that stands on a floor has light on
// the one side that the other side knows nothing of, however close the cells.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "radiosity/patches/patches.h"
#include "scenes/ray_query.h"

namespace earthshine::raytrace {

class LeakMask {
 public:
  // Nothing is parted.
  LeakMask() = default;
  // Casts one ray between the centres of every two cells that share radiance where it is
  // interpolated (radiance_table.h), on each side that has patches, a thousandth of its length
  // above the surface: some four rays a patch.
  LeakMask(const scenes::RayQuery& query, const radiosity::Patches& patches);

  // Of two patches on one side of one facet.
  [[nodiscard]] bool parted(std::uint32_t a, std::uint32_t b) const;
  // Whether the patch is parted from any other: cheap.
  [[nodiscard]] bool at_wall(std::uint32_t patch) const {
    return !at_wall_.empty() && at_wall_[patch] != 0;
  }
  [[nodiscard]] std::uint64_t rays() const { return rays_; }

 private:
  using Pair = std::pair<std::uint32_t, std::uint32_t>;
  std::vector<std::uint8_t> at_wall_;  // per patch; empty: no patch is
  std::vector<Pair> parted_;           // the lower patch first; sorted
  std::uint64_t rays_ = 0;
};

}  // namespace earthshine::raytrace
