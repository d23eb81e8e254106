// SPDX-License-Identifier: Apache-2.0
// The last origin of a surface's diffuse light: a source, or an object that reflects the light.
//   L = L_own + L_direct + rho / N sum_k B(hit_k) / pi       N cosine-weighted rays
// The emitted light of a surface counts as light from a source, the rest of its radiosity as
// reflected. Rays stop at mirrors and glass, and highlights are not diffuse: the shares omit this
// light.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "radiosity/solution.h"
#include "raytrace/incoming/radiance_table.h"
#include "scenes/effects/world.h"
#include "studies/why/lit_points.h"

namespace earthshine::studies {

// Mean light by rays over some points, cd/m^2 by light group.
struct LastBounce {
  struct Reflector {
    std::uint32_t object = 0;
    std::vector<Rgb> by_group;
  };
  std::vector<Reflector> reflectors;
  std::vector<Rgb> straight;  // from emitters without shadow rays (emitter_is_explicit)
};

// Reads a solution. The solution, the scene and the other arguments must outlive it.
class LastBounces {
 public:
  LastBounces(const scenes::Scene& scene, const scenes::LightGroups& groups,
              const scenes::RayQuery& query, const radiosity::Solution& solution);
  // Casts `rays` from each point, in fixed directions turned by the point's number: the same in
  // each run. A share p has a standard error below sqrt(p (1 - p) / (points rays)) if all hits are
  // equally bright.
  [[nodiscard]] LastBounce of(std::span<const SeenPoint> points, int rays) const;

 private:
  const scenes::Scene& scene_;
  const scenes::LightGroups& groups_;
  const scenes::RayQuery& query_;
  raytrace::LeakMask nothing_parted_;
  raytrace::RadianceTable table_;
  std::vector<bool> is_explicit_;  // per material
};

// One share of the light on a target or at a pixel.
struct LightShare {
  std::string from;        // a light group, or an object
  bool reflected = false;  // reflected by that object
  double share = 0.0;
};
inline constexpr const char* own_light = "its own light";  // of a surface that emits
inline constexpr double least_light_share = 0.01;          // to be reported

// Adds up the origins of light, in cd/m^2 of luminance.
class LightShares {
 public:
  explicit LightShares(const scenes::Scene& scene, const scenes::LightGroups& groups)
      : scene_(scene), groups_(groups) {}
  void add(std::string_view from, bool reflected, double luminance);
  // weight: factor on each group's light; empty: 1. The points' own light counts only if it has a
  // group.
  void add(const LastBounce& light, std::span<const Rgb> weight = {});
  void add_own(std::span<const SeenPoint> points, std::span<const Rgb> weight = {});
  // As shares of `luminance`, above 0; largest first.
  [[nodiscard]] std::vector<LightShare> of(double luminance) const;

 private:
  const scenes::Scene& scene_;
  const scenes::LightGroups& groups_;
  std::vector<LightShare> list_;
};

// All shares for the current light of the scene, with a fixed sky; luminance: of the points,
// cd/m^2, above 0. Light by mirrors, glass, highlights or the ambient term is in no share.
[[nodiscard]] std::vector<LightShare> light_shares(const scenes::World& world,
                                                   const radiosity::Solution& solution,
                                                   std::span<const SeenPoint> points,
                                                   double luminance, int rays);

}  // namespace earthshine::studies
