// SPDX-License-Identifier: Apache-2.0
// Effects that are on but cannot matter, found by bounds from the scene alone: no ray is cast, and
// what cannot be bounded so stays on.
#pragma once

#include <string>
#include <vector>

#include "scenes/effects/effects.h"

namespace earthshine::scenes {

struct Culling {
  std::string effect;  // the row of describe_effects()
  std::string why;     // "cannot matter: ..."
  double error = 0.0;  // of the radiosity, relative, root mean square over the area: at most this
};

// Lights that closed walls keep from every camera (radiosity/bodies/walls.h).
struct HiddenLights {
  bool sky = false;         // Sun and Earth
  std::vector<bool> lamps;  // of the scene's; empty: none
};

// Switches them off in groups and effects and says which:
//   sun, earth       the disc is below the horizon of every surface; seen itself it stays
//   a lamp           every surface turns its black back to it or lies outside its beam, and no
//                    camera can see its shining side
//   any of them      closed walls keep it from every camera
//   gloss            only the Earth was there to be reflected; highlights and gloss without light
//   interreflection  no surface is in front of another; or all reflectances are so small that
//                    |B - B0| <= r / (1 - r) |B0| is below a thousandth of the wanted error, r the
//                    largest: by reciprocity F has norm 1 at most in the area-weighted square mean.
//                    Left on where lobes, mirrors, glass, emitting surfaces or a wide Earth would
//                    have to read the solution.
// Groups keep their names, so that layers stay the same.
[[nodiscard]] std::vector<Culling> cull_effects(const Scene& scene, const Asked& asked,
                                                double wanted_error, const HiddenLights& hidden,
                                                LightGroups& groups, Effects& effects);

}  // namespace earthshine::scenes
