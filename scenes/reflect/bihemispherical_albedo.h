// SPDX-License-Identifier: Apache-2.0
// What a surface reflects in all, for radiosity, which knows no directions.
#pragma once

#include <vector>

#include "scenes/scene.h"

namespace earthshine::scenes {

// Of light that comes evenly from all over the hemisphere, the share that a Phong lobe of k_s = 1
// reflects (docs/theory.md, "Lobes in the radiosity"):
//   (1/pi) integral over both directions of cos^n(alpha) cos(in) cos(out) / pi,
// 5/6 for n = 0 and 4 / (3 (n + 2)) for large n; within 1e-3 of it, relative. n >= 0.
[[nodiscard]] double mean_lobe_reflectance(double n);

// Per material: k_d and the mean of its lobe.
[[nodiscard]] std::vector<Rgb> bihemispherical_albedos(const Scene& scene);

}  // namespace earthshine::scenes
