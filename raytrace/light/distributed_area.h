// SPDX-License-Identifier: Apache-2.0
// The Earth as in Figure 7 of the report: lights on a flat area nearby replace its disc in the sky.
#pragma once

#include <optional>
#include <string>

#include "scenes/scene.h"

namespace earthshine::raytrace {

// Centre of the scene's bounding box: the area has the Earth's illuminance there.
[[nodiscard]] Vec3 scene_centre(const scenes::Scene& scene);

// Illuminance of an unoccluded plate that faces the Earth's centre, lx: the integral of L cos over
// the disc, by the midpoint rule in the cosine (exact for a uniform Earth: pi L sin^2).
[[nodiscard]] Rgb earth_illuminance_lx(const scenes::Scene& scene);

// The area as a rectangle lamp: its points shine by Lambert's cosine and the inverse square law. A
// plate at scene_centre() that faces the Earth gets the Earth's illuminance E from it: its exitance
// is M = E / f, f the share of the plate's view that the area fills (Lambert's formula,
// radiosity/direct/lambert.h). With many lights the area becomes a uniform surface of the radiance
// M / pi, larger or smaller than the Earth's disc.
//
// Empty if `name` is empty. Throws base::Error (Input) if the scene has no area of that name, no
// Earth, or if the plate does not see the shining side.
[[nodiscard]] std::optional<scenes::Lamp> earth_area(const scenes::Scene& scene,
                                                     const std::string& name);

}  // namespace earthshine::raytrace
