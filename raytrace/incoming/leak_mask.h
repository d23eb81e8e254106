// SPDX-License-Identifier: Apache-2.0
// Finds neighbouring cells of a facet with an occluder between them: a wall on a floor separates
// light and shadow, however close the cells are. Prevents light leaks by interpolation.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "radiosity/patches/patches.h"
#include "scenes/ray_query.h"

namespace earthshine::raytrace {

class LeakMask {
 public:
  // No cells are separated.
  LeakMask() = default;
  // Casts one ray between the centres of every two cells that interpolate with each other
  // (radiance_table.h), on each side that has patches, lifted by a thousandth of its length: about
  // four rays per patch.
  LeakMask(const scenes::RayQuery& query, const radiosity::Patches& patches);

  // Whether two patches on one side of one facet are separated.
  [[nodiscard]] bool parted(std::uint32_t a, std::uint32_t b) const;
  // Whether the patch is separated from any other; fast.
  [[nodiscard]] bool at_wall(std::uint32_t patch) const {
    return !at_wall_.empty() && at_wall_[patch] != 0;
  }
  [[nodiscard]] std::uint64_t rays() const { return rays_; }

 private:
  using Pair = std::pair<std::uint32_t, std::uint32_t>;
  std::vector<std::uint8_t> at_wall_;  // per patch; empty: no patch is at a wall
  std::vector<Pair> parted_;           // the lower patch first; sorted
  std::uint64_t rays_ = 0;
};

}  // namespace earthshine::raytrace
