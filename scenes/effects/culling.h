// SPDX-License-Identifier: Apache-2.0
// Finds effects that are on but cannot matter. Uses bounds from the scene only and casts no rays.
// An effect without a bound stays on.
#pragma once

#include <string>
#include <vector>

#include "scenes/effects/effects.h"

namespace earthshine::scenes {

struct Culling {
  std::string effect;  // the row of describe_effects()
  std::string why;     // "cannot matter: ..."
  double error = 0.0;  // upper bound of the relative RMS error of the radiosity over the area
};

// Lights that closed walls hide from every camera (radiosity/bodies/walls.h).
struct HiddenLights {
  bool sky = false;         // Sun and Earth
  std::vector<bool> lamps;  // of the scene's; empty: none
};

// Switches effects off in groups and effects, and lists them:
//   sun, earth       its disc is below the horizon of every surface; it stays visible to cameras
//   a lamp           every surface turns its black back to it or lies outside its beam, and no
//                    camera can see its emitting side
//   any of them      closed walls hide it from every camera
//   gloss            the Earth was the only light to reflect; highlights and gloss without light
//   interreflection  no surface is in front of another; or all reflectances are so small that
//                    |B - B0| <= r / (1 - r) |B0| is below a thousandth of the wanted error, r the
//                    largest: by reciprocity F has norm 1 at most in the area-weighted square mean.
//                    Stays on where lobes, mirrors, glass, emitting surfaces or a wide Earth need
//                    the solution.
// Groups keep their names, so that layers do not change.
[[nodiscard]] std::vector<Culling> cull_effects(const Scene& scene, const Asked& asked,
                                                double wanted_error, const HiddenLights& hidden,
                                                LightGroups& groups, Effects& effects);

}  // namespace earthshine::scenes
