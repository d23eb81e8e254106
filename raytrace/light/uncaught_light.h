// SPDX-License-Identifier: Apache-2.0
// Light straight from sources that mirrors and glass send where no shadow ray follows it: curved
// mirrors, glass that bends light, a second flat mirror (scenes/specular_paths.h).
#pragma once

#include <string>
#include <vector>

#include "raytrace/frame/frame.h"
#include "raytrace/frame/options.h"
#include "scenes/effects/world.h"

namespace earthshine::raytrace {

// By one way of going on.
struct Uncaught {
  bool possible = false;             // there is a surface that may send light so
  double share = 0.0;                // of the light (luminance) that falls straight on surfaces
  std::vector<std::string> objects;  // those that send it, the brightest first; three at most
};
struct UncaughtLight {
  Uncaught mirrors, glass;
};

// Which sources are asked about.
enum class SourcesOf { All, WithoutSize };

// From shadow rays of 2048 points on all surfaces and as many on mirrors and glass: shares are good
// to some hundredths of themselves. Flat mirrors are as `indirect` has them.
[[nodiscard]] UncaughtLight uncaught_light(const scenes::World& scene, Indirect indirect,
                                           SourcesOf which);

// Light that no setting brings into a picture drawn so.
[[nodiscard]] std::vector<std::string> not_captured(const scenes::World& scene,
                                                    const RenderOptions& options);

}  // namespace earthshine::raytrace
