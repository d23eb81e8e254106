// SPDX-License-Identifier: Apache-2.0
// Light from sources that mirrors and glass redirect where shadow rays cannot follow: by curved
// mirrors, glass that bends light, or a second flat mirror (scenes/specular_paths.h).
#pragma once

#include <string>
#include <vector>

#include "raytrace/frame/frame.h"
#include "raytrace/frame/options.h"
#include "scenes/effects/world.h"

namespace earthshine::raytrace {

// By mirrors, or by glass.
struct Uncaught {
  bool possible = false;             // a surface may redirect light in this way
  double share = 0.0;                // relative to the direct light on all surfaces (luminance)
  std::vector<std::string> objects;  // at most three that redirect it, the brightest first
};
struct UncaughtLight {
  Uncaught mirrors, glass;
};

// Sources to consider.
enum class SourcesOf { All, WithoutSize };

// By shadow rays from 2048 points on all surfaces and 2048 on mirrors and glass: shares have a
// relative error of a few hundredths. `indirect` decides whether flat mirrors are sampled.
[[nodiscard]] UncaughtLight uncaught_light(const scenes::World& scene, Indirect indirect,
                                           SourcesOf which);

// Light that no setting brings into a picture with these options.
[[nodiscard]] std::vector<std::string> not_captured(const scenes::World& scene,
                                                    const RenderOptions& options);

}  // namespace earthshine::raytrace
