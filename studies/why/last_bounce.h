// SPDX-License-Identifier: Apache-2.0
// Where the diffuse light of a surface comes from last: straight from a source, or from an object
// that reflects it on.
//   L = L_own + L_direct + rho / N sum_k B(hit_k) / pi       N cosine-weighted rays
// Nothing is followed through mirrors and glass, and highlights are no diffuse light: what a
// picture has of those is left over.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "radiosity/solution.h"
#include "scenes/effects/light_groups.h"
#include "scenes/ray_query.h"
#include "studies/why/lit_points.h"

namespace earthshine::studies {

// By way of one object: cd/m^2 by light group, the mean over the points.
struct ByWayOf {
  std::uint32_t object = 0;
  std::vector<Rgb> by_group;
};

// `rays` from each point, fixed directions turned by the point's number: the same in each run. A
// share of p comes with a standard error below sqrt(p (1 - p) / (points rays)) where what is met is
// equally bright. groups: of the solution's columns.
[[nodiscard]] std::vector<ByWayOf> light_by_way_of(const scenes::Scene& scene,
                                                   const scenes::RayQuery& query,
                                                   const radiosity::Solution& solution,
                                                   std::size_t groups,
                                                   std::span<const SeenPoint> points, int rays);

// One share of the light on a target or at a pixel.
struct LightShare {
  std::string from;        // a light group, or an object
  bool reflected = false;  // by way of that object
  double share = 0.0;
};
inline constexpr const char* own_light = "its own light";  // of a surface that emits
// All of them for the light that the scene has now, with a fixed sky; luminance: of the points,
// cd/m^2, above 0. What the picture shows by mirror, glass, highlight or ambient term is in none.
[[nodiscard]] std::vector<LightShare> light_shares(const scenes::Scene& scene,
                                                   const scenes::LightGroups& groups,
                                                   const scenes::RayQuery& query,
                                                   const radiosity::Solution& solution,
                                                   std::span<const SeenPoint> points,
                                                   double luminance, int rays);
// Largest first, those of a hundredth and more.
[[nodiscard]] std::vector<LightShare> sorted_shares(std::vector<LightShare> shares);

}  // namespace earthshine::studies
