// SPDX-License-Identifier: Apache-2.0
// The Earth as the report's Figure 7 has it: lights spread over a flat area near by, in place of
// its disc in the sky.
#pragma once

#include <optional>
#include <string>

#include "scenes/scene.h"

namespace earthshine::raytrace {

// The middle of the box around the scene: where the area gives what the Earth would.
[[nodiscard]] Vec3 scene_centre(const scenes::Scene& scene);

// Illuminance of a plate that faces the Earth's centre with nothing in between, lx: the integral of
// L cos over the disc, by the midpoint rule in the cosine (exact for a uniform Earth: pi L sin^2).
[[nodiscard]] Rgb earth_illuminance_lx(const scenes::Scene& scene);

// The area as a rectangle lamp: its points shine by Lambert's cosine and the inverse square, like
// any surface. Its exitance M gives a plate at scene_centre() that faces the Earth the Earth's
// illuminance E: M = E / f, f the share of the plate's view that the area fills (Lambert's formula,
// radiosity/direct/lambert.h). As the lights become many the area is a window of one radiance to a
// uniform Earth, larger or smaller than its disc.
//
// Nothing if `name` is empty. Throws base::Error (Input) if the scene has no area of that name, no
// Earth, or the plate does not see the side that shines.
[[nodiscard]] std::optional<scenes::Lamp> earth_area(const scenes::Scene& scene,
                                                     const std::string& name);

}  // namespace earthshine::raytrace
