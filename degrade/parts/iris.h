// SPDX-License-Identifier: Apache-2.0
// Light meter and steady state of the iris, in closed form without iteration.
#pragma once

#include <optional>

#include "degrade/stage/camera.h"
#include "degrade/stage/picture.h"

namespace earthshine::degrade {

// (sum w L^p / sum w)^(1/p); negative values count as 0. The weights are w = 1 - centre
// (1 - (1 - u^2)(1 - v^2)), with u and v from -1 to 1 across the picture. centre = 0 weights all
// pixels equally, 1 excludes the border.
[[nodiscard]] double power_mean(const Plane& luminance, int columns, int rows, double p,
                                double centre);

// The q-quantile of the pixels.
[[nodiscard]] double quantile(Plane values, double q);

// Metered luminance M(L), cd/m^2. Peak: the 99.5 % quantile. Normal: the centre-weighted power mean
// with p = 4. Average: the mean. Fixed: 0. Homogeneous: M(k L) = k M(L).
[[nodiscard]] double metered_luminance(const Picture& radiance, const CctvCamera& camera);

struct Exposure {
  double f_number = 1.0;
  double gain = 1.0;          // factor on the signal
  double metered = 0.0;       // cd/m^2
  double target = 1.0;        // signal wanted for the metered value
  bool underexposed = false;  // wide open with full gain, and too dark
  bool blown = false;         // closed, and too bright
  bool moving = false;        // more than 1 % from the final f-number
};

// Steady state: N* = clamp(sqrt(pi tau M / (4 t E_white (1 + m)^2)), N_min, N_max), then
// gain = clamp(t E_white / E(N), 1, gain_max). With `before`, the f-number of the previous frame,
// ln N^2 moves by the share iris_rate of its distance to ln N*^2, and by at most iris_slew stops.
// The gain follows without delay. In a still scene (1 - iris_rate)^j of the distance remains after
// j frames.
[[nodiscard]] Exposure expose(const CctvCamera& camera, double metered,
                              std::optional<double> before = {});

// E / L = pi tau / (4 N^2 (1 + m)^2), lx per cd/m^2.
[[nodiscard]] double lens_transfer(const CctvCamera& camera, double f_number);

}  // namespace earthshine::degrade
