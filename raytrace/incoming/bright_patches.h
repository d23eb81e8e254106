// SPDX-License-Identifier: Apache-2.0
// Patches so bright that gather rays, which find them by chance, would leave specks: a wall at
// hand's width from a lamp, a sunlit spot in a dark bay. They get rays aimed at them, and both ways
// of finding them are combined by multiple importance sampling (Veach 1997, balance heuristic), so
// that nothing is counted twice or lost.
#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/solution.h"

namespace earthshine::raytrace {

class BrightPatches {
 public:
  BrightPatches() = default;
  // Those whose luminance exceeds 16 times the area mean; none in an evenly lit scene.
  explicit BrightPatches(const radiosity::Solution& solution);

  [[nodiscard]] bool empty() const { return patches_.empty(); }

  struct Aim {
    std::uint32_t patch;
    std::uint32_t triangle;  // of a patch of several triangles; else scenes::no_triangle
    Vec3 point, normal;      // on the patch's side
  };
  // A point on one of them, chosen in proportion to its flux.
  [[nodiscard]] Aim aim(double choice, double x, double y) const;

  // Density of aim() per unit of solid angle in a direction that meets `patch` at distance_m under
  // the given cosine at the patch; 0 for patches that are not bright.
  [[nodiscard]] double density_per_sr(std::uint32_t patch, double distance_m,
                                      double cosine_at_patch) const;
  [[nodiscard]] const radiosity::Patches& patches() const { return *source_; }

 private:
  const radiosity::Patches* source_ = nullptr;
  std::vector<std::uint32_t> patches_;
  std::vector<double> cumulative_;     // running sum of flux, ends at 1
  std::vector<float> density_per_m2_;  // per patch of the scene: probability / area
};

}  // namespace earthshine::raytrace
