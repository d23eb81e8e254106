// SPDX-License-Identifier: Apache-2.0
// Scene + solution + camera -> frame. Who carries which light path (each by exactly one strategy):
//
//   source seen by the camera itself                     emission, sky radiance, lamp surfaces
//   point, spot, rectangle, disk lamps; Sun; emitters    shadow rays (diffuse and Phong lobe)
//     that are explicit in radiosity
//   Earth, wide                                          gather rays that escape (diffuse), lobe
//   rays (Phong) Earth, narrow                                        shadow rays emitters carried
//   by F; light after >= 1 diffuse      gather rays that meet patches (diffuse), lobe rays (Phong)
//     bounce
//   mirror, glass                                        recursion; behind it direct light by
//   shadow rays and the
//                                                        rest from the solution
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "radiosity/solution.h"
#include "raytrace/frame.h"
#include "scenes/effects.h"
#include "scenes/light_groups.h"
#include "scenes/ray_query.h"

namespace earthshine::raytrace {

enum class Indirect {
  Radiosity,    // final gather on the solution
  Distributed,  // the 1990 report's approximation: the Earth and area lamps as N lights, no
                // interreflection
  None          // direct light alone
};

struct RenderOptions {
  int columns = 512;
  int rows = 512;
  int gather_rays = 256;  // per pixel, spread over the camera samples
  Indirect indirect = Indirect::Radiosity;
  int distributed_lights = 64;   // N of Indirect::Distributed
  std::string distributed_over;  // the [[area]] that the Earth's N lights lie on; empty: its disc
  bool per_light = false;
  std::vector<std::string> aovs;  // of aov_names()
  std::uint64_t seed = 1;
};

[[nodiscard]] const std::vector<std::string>&
aov_names();  // albedo, normal, position, depth, range, object, material

// Told how many of `total` rows of tiles are done; called from one thread at a time.
using Progress = std::function<void(std::size_t done, std::size_t total)>;

// `solution` may be empty (default-constructed) unless indirect is Radiosity.
// Throws base::Error (Input) for an unknown AOV name or [[area]].
[[nodiscard]] Frame render(const scenes::Scene& scene, const scenes::LightGroups& groups,
                           const scenes::Effects& effects, const scenes::RayQuery& query,
                           const radiosity::Solution& solution, const scenes::Camera& camera,
                           const RenderOptions& options, const Progress& progress = {});

}  // namespace earthshine::raytrace
