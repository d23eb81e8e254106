// SPDX-License-Identifier: Apache-2.0
// What the iris sees and where it goes. Closed form: the steady state of the loop, no iteration.
#pragma once

#include <optional>

#include "degrade/stage/camera.h"
#include "degrade/stage/picture.h"

namespace earthshine::degrade {

// (sum w L^p / sum w)^(1/p); negative values count as 0. Weights w = 1 - centre (1 - (1 - u^2)(1 -
// v^2)), with u and v from -1 to 1 across the picture: centre = 0 weighs evenly, 1 leaves the
// border out.
[[nodiscard]] double power_mean(const Plane& luminance, int columns, int rows, double p,
                                double centre);

// The value below which a share q of the pixels lies.
[[nodiscard]] double quantile(Plane values, double q);

// M(L), cd/m^2: peak the 99.5 % quantile, normal the centre-weighted power mean with p = 4, average
// the mean. Homogeneous: M(k L) = k M(L). 0 for a fixed iris.
[[nodiscard]] double metered_luminance(const Picture& radiance, const CctvCamera& camera);

struct Exposure {
  double f_number = 1.0;
  double gain = 1.0;          // factor on the signal
  double metered = 0.0;       // cd/m^2
  double target = 1.0;        // signal that the metered value should have
  bool underexposed = false;  // wide open, gain at its most, and still too dark
  bool blown = false;         // closed, and still too bright
  bool moving = false;        // on its way: more than 1 % from where it will stand
};

// N* = clamp(sqrt(pi tau M / (4 t E_white (1 + m)^2)), N_min, N_max), then gain = clamp(t E_white /
// E(N), 1, gain_max): the steady state. With `before`, the f-number of the frame before, ln N^2
// goes from there the share iris_rate of its way to ln N*^2, and no further than iris_slew stops;
// the gain follows at once. A still scene brings it (1 - iris_rate)^j of the way after j frames.
[[nodiscard]] Exposure expose(const CctvCamera& camera, double metered,
                              std::optional<double> before = {});

// E / L = pi tau / (4 N^2 (1 + m)^2), lx per cd/m^2.
[[nodiscard]] double lens_transfer(const CctvCamera& camera, double f_number);

}  // namespace earthshine::degrade
