// SPDX-License-Identifier: Apache-2.0
// The sources whose light patches get by shadowed samples: Sun, a narrow Earth, lamps and small
// emitting surfaces.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "radiosity/direct/shadowed_samples.h"
#include "scenes/effects/effects.h"
#include "scenes/effects/light_groups.h"
#include "scenes/light/lamp_light.h"

namespace earthshine::radiosity {

using Emit = std::function<scenes::EmittedRay(double u, double v, double x, double y)>;

struct LightSource {
  std::string name;
  Source source;
  Rgb flux_lm{0.0};                                 // what it emits; not known of the sky's
  Emit emit;                                        // empty for the sky
  scenes::LightKind kind = scenes::LightKind::Sun;  // of a cluster: its first lamp's
};

// Refers to the scene, which must outlive them. points: receiver points per patch for distant
// sources.
[[nodiscard]] std::vector<LightSource> find_sources(const scenes::Scene& scene,
                                                    const scenes::LightGroups& groups,
                                                    const scenes::Effects& effects, int points);

}  // namespace earthshine::radiosity
