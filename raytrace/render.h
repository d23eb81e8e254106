// SPDX-License-Identifier: Apache-2.0
// Scene + solution + camera -> frame. Each kind of light path is carried by exactly one strategy:
//
//   source seen by the camera itself       emission, sky radiance, lamp surfaces
//   lamps of every type;                   shadow rays (diffuse and Phong lobe)
//     Sun; emitters that are explicit in
//     radiosity
//   Earth, wide                            gather rays that escape (diffuse), lobe rays (Phong)
//   Earth, narrow                          shadow rays
//   emitters carried by F; light after     gather rays that meet patches (diffuse), lobe rays
//     >= 1 diffuse bounce                    (Phong)
//   mirror, glass                          recursion; behind it direct light by shadow rays and the
//                                            rest from the solution
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "radiosity/solution.h"
#include "raytrace/frame/frame.h"
#include "raytrace/frame/options.h"
#include "scenes/effects/quality.h"
#include "scenes/effects/world.h"

namespace earthshine::raytrace {

// `solution` may be empty (default-constructed) unless indirect is Radiosity. A crop has the same
// pixels as the whole picture there. Throws base::Error (Input) for an unknown AOV name or
// [[area]], or a crop that leaves the picture.
[[nodiscard]] Frame render(const scenes::World& world, const radiosity::Solution& solution,
                           const scenes::Camera& camera, const RenderOptions& options,
                           const Progress& progress = {});

}  // namespace earthshine::raytrace
