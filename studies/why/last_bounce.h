// SPDX-License-Identifier: Apache-2.0
// Where the diffuse light of a surface comes from last: straight from a source, or from an object
// that reflects it on.
//   L = L_own + L_direct + rho / N sum_k B(hit_k) / pi       N cosine-weighted rays
// Of what an emitting surface sends, its own light comes straight from it and only the rest by way
// of it. Nothing is followed through mirrors and glass, and highlights are no diffuse light: what a
// picture has of those is left over.
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

// What rays bring to some points, the mean over them, cd/m^2 by light group.
struct LastBounce {
  struct ByWayOf {
    std::uint32_t object = 0;
    std::vector<Rgb> by_group;
  };
  std::vector<ByWayOf> by_way;
  std::vector<Rgb> straight;  // of emitters that no shadow ray is sent to (emitter_is_explicit)
};

// Reads a solution, which must outlive it, as the scene and the rest do.
class LastBounces {
 public:
  LastBounces(const scenes::Scene& scene, const scenes::LightGroups& groups,
              const scenes::RayQuery& query, const radiosity::Solution& solution);
  // `rays` from each point, fixed directions turned by the point's number: the same in each run. A
  // share of p comes with a standard error below sqrt(p (1 - p) / (points rays)) where what is met
  // is equally bright.
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
  bool reflected = false;  // by way of that object
  double share = 0.0;
};
inline constexpr const char* own_light = "its own light";  // of a surface that emits
inline constexpr double least_light_share = 0.01;          // that is worth naming

// Adds up where light comes from, in cd/m^2 of luminance.
class LightShares {
 public:
  explicit LightShares(const scenes::Scene& scene, const scenes::LightGroups& groups)
      : scene_(scene), groups_(groups) {}
  void add(std::string_view from, bool reflected, double luminance);
  // weight: of each group's light; empty: 1. Of the points' own light only what has a group counts.
  void add(const LastBounce& light, std::span<const Rgb> weight = {});
  void add_own(std::span<const SeenPoint> points, std::span<const Rgb> weight = {});
  // As shares of `luminance`, above 0; largest first.
  [[nodiscard]] std::vector<LightShare> of(double luminance) const;

 private:
  const scenes::Scene& scene_;
  const scenes::LightGroups& groups_;
  std::vector<LightShare> list_;
};

// All of them for the light that the scene has now, with a fixed sky; luminance: of the points,
// cd/m^2, above 0. What the picture shows by mirror, glass, highlight or ambient term is in none.
[[nodiscard]] std::vector<LightShare> light_shares(const scenes::World& world,
                                                   const radiosity::Solution& solution,
                                                   std::span<const SeenPoint> points,
                                                   double luminance, int rays);

}  // namespace earthshine::studies
