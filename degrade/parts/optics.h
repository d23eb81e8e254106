// SPDX-License-Identifier: Apache-2.0
// From the scene's luminance to the light on the sensor. Deterministic.
#pragma once

#include "degrade/parts/iris.h"
#include "degrade/stage/camera.h"
#include "degrade/stage/picture.h"

namespace earthshine::degrade {

// E = pi tau L / (4 N^2 (1 + m)^2), lx; m the magnification.
[[nodiscard]] Picture through_lens(Picture radiance, const CctvCamera& camera, double f_number);

// E <- E cos(theta)^power, theta the angle off the axis: tan theta = r tan(fov / 2) / (rows / 2),
// r in resels. fov_deg: vertical, above 0 and below 180.
[[nodiscard]] Picture fall_off_from_axis(Picture illuminance, double power, double fov_deg);

// E <- (1 - g) E + g mean(E): stray light. The mean is unchanged.
[[nodiscard]] Picture add_glare(Picture illuminance, double share);

// S <- S (1 - droop r^2), r from 0 in the centre to 1 in the corners.
[[nodiscard]] Picture shade(Picture signal, double droop);

}  // namespace earthshine::degrade
