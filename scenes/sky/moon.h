// SPDX-License-Identifier: Apache-2.0
// Moonlight at the spacecraft and on the Earth.
#pragma once

#include "scenes/scene.h"

namespace earthshine::scenes {

// Visual magnitude at the mean distances of Moon and Sun, V = -12.73 + 0.026 |a| + 4e-9 a^4, a the
// phase angle in degrees: Allen, "Astrophysical Quantities" (1973), as Krisciunas and Schaefer,
// "A model of the brightness of moonlight", PASP 103 (1991) have it. Measured to a = 150; the
// brightening within 7 deg of full is left out.
[[nodiscard]] double moon_magnitude(double phase_deg);

// Of a plate that faces the Moon: the Sun's illuminance times the ratio of both by magnitude, the
// Sun's V = -26.74 (Allen), so that no zero point enters; in the Sun's hue. sun_lx: at one
// astronomical unit.
[[nodiscard]] Rgb moon_illuminance_lx(const Rgb& sun_lx, double phase_deg, double distance_m,
                                      double sun_distance_m);

inline constexpr double mean_moon_distance_m = 384400e3;
inline constexpr double astronomical_unit_m = 149597870700.0;  // IAU 2012

// Adds the Moon to the scene's lamps, a distant one of the group "moon", where it is not behind the
// Earth. `where`: of [moon].
void add_moon_lamp(Scene& scene, const base::Location& where);

}  // namespace earthshine::scenes
