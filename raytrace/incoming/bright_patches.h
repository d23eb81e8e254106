// SPDX-License-Identifier: Apache-2.0
// Patches so bright that gather rays, which find them by chance, would leave specks: a wall at
// hand's width from a lamp, a sunlit spot in a dark bay. They get rays aimed at them, and both ways
// of finding them are combined by multiple importance sampling (Veach 1997, balance heuristic), so
// that nothing is counted twice or lost.
//
// Which one is aimed at goes by what they send to the place: down a tree of them, to either half in
// proportion to flux / d^2 times the cosine of its direction, of its box (Conty Estevez and Kulla
// 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting").
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "radiosity/solution.h"

namespace earthshine::raytrace {

class BrightPatches {
 public:
  // Of a surface, where rays leave it: its normal on that side.
  struct Place {
    Vec3 position{0.0}, normal{0.0};
  };
  struct Aim {
    std::uint32_t patch;
    std::uint32_t triangle;  // of a patch of several triangles; else scenes::no_triangle
    Vec3 point, normal;      // on the patch's side
  };

  BrightPatches() = default;
  // Those whose luminance exceeds 16 times the area mean; none in an evenly lit scene. The solution
  // must outlive it.
  explicit BrightPatches(const radiosity::Solution& solution);

  [[nodiscard]] bool empty() const { return nodes_.empty(); }
  [[nodiscard]] bool holds(std::uint32_t patch) const { return number_[patch] != none; }

  // A point on one of them, by numbers in [0, 1); none where all boxes are behind the surface. Not
  // to be asked, nor the two around it, where there are none.
  [[nodiscard]] std::optional<Aim> aim(const Place& from, double choice, double x, double y) const;
  // Density of aim() per unit of solid angle in a direction that meets `patch` at distance_m under
  // the given cosine at the patch; 0 for patches that are not bright.
  [[nodiscard]] double density_per_sr(const Place& from, std::uint32_t patch, double distance_m,
                                      double cosine_at_patch) const;
  [[nodiscard]] const radiosity::Patches& patches() const { return *source_; }

 private:
  static constexpr std::uint32_t none = 0xFFFFFFFFU;
  // Of the patches `begin` to `end` - 1 in the tree's order. Behind a node with n patches, of which
  // the first half are its first child's, come that child's nodes, 2 (n / 2) - 1 of them.
  struct Node {
    Vec3 centre{0.0}, half{0.0};  // of its box
    double radius_m = 0.0, flux = 0.0;
    [[nodiscard]] double sent_to(const Place& place) const;
  };
  struct Span {
    std::uint32_t node, begin, end;
    [[nodiscard]] std::uint32_t middle() const { return begin + (end - begin) / 2; }
    [[nodiscard]] Span first() const { return {node + 1, begin, middle()}; }
    [[nodiscard]] Span second() const { return {node + 2 * (middle() - begin), middle(), end}; }
  };
  [[nodiscard]] Span all() const { return {0, 0, static_cast<std::uint32_t>(patches_.size())}; }
  void build(const Span& span, const std::vector<double>& flux);
  // The share of the first child, of what both send there; negative where neither does.
  [[nodiscard]] double first_share(const Span& span, const Place& from) const;

  const radiosity::Patches* source_ = nullptr;
  std::vector<std::uint32_t> patches_;  // in the tree's order
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> number_;  // of a patch of the scene, in that order
};

}  // namespace earthshine::raytrace
