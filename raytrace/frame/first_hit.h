// SPDX-License-Identifier: Apache-2.0
// The unfiltered layers: the hit of the ray through the centres of a pixel and the lens.
#pragma once

#include <string>
#include <vector>

#include "base/image.h"
#include "raytrace/camera/camera.h"
#include "scenes/ray_query.h"

namespace earthshine::raytrace {

// Without a hit: albedo, N and P 0; Z and range infinite; object and material -1.
struct FirstHitLayer {
  std::string aov;  // its word in --aov
  std::vector<std::string> channels;
};

//   albedo    albedo.R/G/B  diffuse reflectance
//   normal    N.X/Y/Z       unit, facing the camera
//   position  P.X/Y/Z       m
//   depth     Z             m along the camera's axis
//   range     range         m along the ray
//   object    object        index in the scene
//   material  material      index in the scene
[[nodiscard]] const std::vector<FirstHitLayer>& first_hit_layers();

// Fills the first-hit channels of `image`, `window` of the camera's picture. Positions are computed
// in double precision and rounded once. Returns the number of rays.
std::uint64_t fill_first_hit(const scenes::Scene& scene, const scenes::RayQuery& query,
                             const CameraModel& camera, const Window& window, base::Image& image);

}  // namespace earthshine::raytrace
