// SPDX-License-Identifier: Apache-2.0
// Airglow of the night Earth.
#pragma once

#include "scenes/scene.h"

namespace earthshine::scenes {

// Luminance of the Earth's night side by airglow, seen from above, cd/m^2; an estimate. The night
// sky over Paranal has 21.6 mag/arcsec^2 in V at the zenith (Patat, A&A 400, 2003), 2.5e-4 cd/m^2
// by L = 10.8e4 10^(-0.4 m), and airglow is 0.6 of it (there, appendix C): 1.5e-4 cd/m^2. The layer
// sends as much up as down. A slant path is 1.4 times as long in the mean over the Earth's disc
// (van Rhijn, layer at 95 km), and the ground gives back 0.3 of the light that goes down.
inline constexpr double usual_airglow_cd_m2 = 2.5e-4;

inline constexpr const char* airglow_group = "airglow";

// Adds 16 distant lamps of the group "airglow". Together they approximate the Earth's disc with
// uniform radiance: each represents an equal solid angle. Their shadows are hard and they are
// invisible to the camera. They are off where the Sun lights a part of the Earth that the
// spacecraft sees.
void add_airglow_lamps(Scene& scene, const Rgb& radiance, const base::Location& where);

}  // namespace earthshine::scenes
