// SPDX-License-Identifier: Apache-2.0
// Selects the patches to halve, and the direction, by the variation within them.
#pragma once

#include <cstddef>
#include <vector>

#include "radiosity/patches/split.h"

namespace earthshine::radiosity {

// A patch's contribution to the squared error, and the reductions by halving it along s or along t.
struct Unevenness {
  double error = 0.0;
  double along_s = 0.0, along_t = 0.0;
};

// Selects patches by an estimate of their errors, which the caller supplies (radiosity/variation.h:
// per light group, for any weights of the groups; raytrace/surfaces/surface_refiner.h: for the sum
// of all light).
class Refiner {
 public:
  explicit Refiner(const Patches& patches) : uneven_(patches.count()), patch_m2_(patches.area_m2) {}

  // Each patch's contribution to the squared error over all area.
  [[nodiscard]] Unevenness& of(std::uint32_t patch) { return uneven_[patch]; }
  [[nodiscard]] const Unevenness& of(std::uint32_t patch) const { return uneven_[patch]; }
  [[nodiscard]] double total() const;

  struct Budget {
    double enough = 0.0;           // squared error at which refinement ends
    double share = 1.0;            // of the squared error, in the patches of one round
    std::size_t most_patches = 0;  // after dividing
  };
  // The most urgent patches by error per added patch, graded (split.h). Selects as many as have the
  // given share of the error (Doerfler 1996: dividing all in every round would mostly divide
  // patches with little error), or as reach `enough` if halves keep half of the error; fewer if the
  // budget of patches would be exceeded. A cell longer than four times its width is divided across,
  // others where the error falls most. Empty: nothing can or need be divided.
  [[nodiscard]] std::vector<Cut> worst(const Patches& patches, const Budget& budget) const;
  // After dividing: returns the new patches. Each is assigned half of its parent's error in
  // proportion to area, without direction.
  std::vector<std::uint32_t> follow(const Patches& patches,
                                    const std::vector<std::uint32_t>& parent);

 private:
  std::vector<Unevenness> uneven_;  // per patch
  std::vector<double> patch_m2_;    // area per patch
};

}  // namespace earthshine::radiosity
