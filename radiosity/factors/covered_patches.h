// SPDX-License-Identifier: Apache-2.0
// Patches that a body covers wholly: they take no part, and what they show. Nobody sees them, but
// who reads the radiosity between the cells of a facet (raytrace/incoming/radiance_table.h,
// viewers) mixes in neighbours of what is seen.
#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/factors/form_factors.h"
#include "radiosity/patches/patches.h"

namespace earthshine::radiosity {

// A ray that slipped through the seam between two bodies, or met a cell's edge where a body stands
// on it, may name a patch that takes no part: it is lost, as if it had met the body's back. Rows
// stay closed. factors.open has a share for every patch.
void lose_hits_on_covered(FormFactors& factors);

class CoveredPatches {
 public:
  CoveredPatches(const Patches& patches, const OpenParts& open);

  // Gives each the mean of those around it on its side of the facet that are open. Where there are
  // none its value stays.
  void show_neighbours(std::vector<float>& values, std::size_t columns) const;

 private:
  struct Border {
    std::uint32_t patch;
    std::vector<std::uint32_t> open;
  };
  std::vector<Border> borders_;
};

}  // namespace earthshine::radiosity
