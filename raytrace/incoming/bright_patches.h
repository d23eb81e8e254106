// SPDX-License-Identifier: Apache-2.0
// Bright patches: cosine-distributed gather rays find them too seldom and would leave bright
// specks, for example a wall close to a lamp, or a sunlit spot in a dark bay. Additional rays are
// aimed at them; multiple importance sampling (Veach 1997, balance heuristic) combines both
// samplings.
//
// The aimed patch is drawn by its contribution to the place: down a binary tree, with probabilities
// in proportion to flux / d^2 times the cosine of the direction of the node's box (Conty Estevez
// and Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting").
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "radiosity/solution.h"

namespace earthshine::raytrace {

class BrightPatches {
 public:
  // The surface point that rays leave, and the normal on that side.
  struct Place {
    Vec3 position{0.0}, normal{0.0};
  };
  struct Aim {
    std::uint32_t patch;
    std::uint32_t triangle;  // of a patch with several triangles; else scenes::no_triangle
    Vec3 point, normal;      // normal: on the patch's side
  };

  BrightPatches() = default;
  // Selects the patches whose luminance exceeds 16 times the area mean; none in an evenly lit
  // scene. The solution must outlive this object.
  explicit BrightPatches(const radiosity::Solution& solution);

  [[nodiscard]] bool empty() const { return nodes_.empty(); }
  [[nodiscard]] bool holds(std::uint32_t patch) const { return number_[patch] != none; }

  // A point on one of the patches, by numbers in [0, 1); none if all boxes are behind the surface.
  // This and the functions beside it require !empty().
  [[nodiscard]] std::optional<Aim> aim(const Place& from, double choice, double x, double y) const;
  // Density of aim() per unit of solid angle in a direction that meets `patch` at distance_m, with
  // the given cosine at the patch; 0 for patches that are not bright.
  [[nodiscard]] double density_per_sr(const Place& from, std::uint32_t patch, double distance_m,
                                      double cosine_at_patch) const;
  [[nodiscard]] const radiosity::Patches& patches() const { return *source_; }

 private:
  static constexpr std::uint32_t none = 0xFFFFFFFFU;
  // Node of the patches `begin` to `end` - 1 in the tree's order. The first half of its n patches
  // belongs to the first child, whose 2 (n / 2) - 1 nodes follow this node.
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
  // Probability of the first child, from the contributions of both; negative if both are 0.
  [[nodiscard]] double first_share(const Span& span, const Place& from) const;

  const radiosity::Patches* source_ = nullptr;
  std::vector<std::uint32_t> patches_;  // in the tree's order
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> number_;  // per patch of the scene: index in patches_
};

}  // namespace earthshine::raytrace
