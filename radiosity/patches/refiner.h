// SPDX-License-Identifier: Apache-2.0
// Which patches are halved, and which way, by what is uneven within them.
#pragma once

#include <cstddef>
#include <vector>

#include "radiosity/patches/split.h"

namespace earthshine::radiosity {

// A patch's part in a squared error, and how much of it goes away when the patch is halved along s
// or along t.
struct Unevenness {
  double error = 0.0;
  double along_s = 0.0, along_t = 0.0;
};

// Chooses which patches to cut by an estimate of the error that each of them holds. The estimates
// are the caller's (radiosity/variation.h: per light group, for any weights of the groups;
// raytrace/surfaces/surface_refiner.h: of all light together, as it is).
class Refiner {
 public:
  explicit Refiner(const Patches& patches) : uneven_(patches.count()), patch_m2_(patches.area_m2) {}

  // Each patch's part of the squared error over all area.
  [[nodiscard]] Unevenness& of(std::uint32_t patch) { return uneven_[patch]; }
  [[nodiscard]] const Unevenness& of(std::uint32_t patch) const { return uneven_[patch]; }
  [[nodiscard]] double total() const;

  struct Budget {
    double enough = 0.0;           // squared error that may remain: no more is cut then
    double share = 1.0;            // of the squared error, held by the patches that are cut at once
    std::size_t most_patches = 0;  // after the cut
  };
  // The most urgent patches by error per patch added, graded (split.h): as many as hold the share
  // (Doerfler 1996: where all are cut in every round, most cuts are of patches that hold little) or
  // leave enough, if halves hold half of what their patch held; fewer where more patches than the
  // budget's would result. A cell longer than four times its width is cut across, others where more
  // of the error goes away. Empty: nothing to cut is left, or there is no need.
  [[nodiscard]] std::vector<Cut> worst(const Patches& patches, const Budget& budget) const;
  // After the cut: returns the patches that are new. They are expected to hold half of the part of
  // their parent's error that their area has, without direction.
  std::vector<std::uint32_t> follow(const Patches& patches,
                                    const std::vector<std::uint32_t>& parent);

 private:
  std::vector<Unevenness> uneven_;  // per patch
  std::vector<double> patch_m2_;    // area per patch
};

}  // namespace earthshine::radiosity
