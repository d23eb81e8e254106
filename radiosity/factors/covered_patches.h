// SPDX-License-Identifier: Apache-2.0
// Completely covered patches: excluded from the solution, and given a value for display. They are
// invisible, but interpolation between the cells of a facet (raytrace/incoming/radiance_table.h,
// viewers) uses them as neighbours of visible patches.
#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/factors/form_factors.h"
#include "radiosity/patches/patches.h"

namespace earthshine::radiosity {

// A ray through the seam between two bodies, or to the edge of a cell on which a body stands, may
// hit an excluded patch. It is counted as lost, as if it had hit the body's back, so that rows stay
// closed. factors.open must have a share for every patch.
void lose_hits_on_covered(FormFactors& factors);

class CoveredPatches {
 public:
  CoveredPatches(const Patches& patches, const OpenParts& open);

  // Assigns each covered patch the mean of the adjacent open patches on its side of the facet.
  // Without such neighbours the value is unchanged.
  void show_neighbours(std::vector<float>& values, std::size_t columns) const;

 private:
  struct Border {
    std::uint32_t patch;
    std::vector<std::uint32_t> open;
  };
  std::vector<Border> borders_;
};

}  // namespace earthshine::radiosity
