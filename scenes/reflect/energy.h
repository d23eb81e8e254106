// SPDX-License-Identifier: Apache-2.0
// What a material may reflect and let through at most.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"
#include "scenes/scene.h"

namespace earthshine::scenes {

// Energy: diffuse + 2 specular / (n + 2) + mirror + transmit <= 1 in every channel, else an Error
// at `where` that gives the numbers. `what` names the material in the message.
void check_energy(const Material& material, const base::Location& where, const std::string& what);

// Of light along the normal, the share that the lobe reflects: 2 k_s / (n + 2).
[[nodiscard]] Rgb lobe_albedo(const Material& material);

// What it sends on of the light that arrives: the sum above.
[[nodiscard]] Rgb reflected_share(const Material& material);

// Divides all shares of a material that breaks the bound by its largest sum, so that it loses
// nothing and keeps its hue. Returns that sum; 1 where there was nothing to do.
double conserve_energy(Material& material);

// What a surface reflects in all, for radiosity, which knows no directions.

// Of light that comes evenly from all over the hemisphere, the share that a Phong lobe of k_s = 1
// reflects (docs/theory.md, "Lobes in the radiosity"):
//   (1/pi) integral over both directions of cos^n(alpha) cos(in) cos(out) / pi,
// 5/6 for n = 0 and 4 / (3 (n + 2)) for large n; within 1e-3 of it, relative. n >= 0. Of an even
// lobe (Material::even_lobe) with the larger cosine below the fraction: 2 / (n + 2) for large n.
[[nodiscard]] double mean_lobe_reflectance(double n, bool even = false);

// Per material: k_d and the mean of its lobe.
[[nodiscard]] std::vector<Rgb> bihemispherical_albedos(const Scene& scene);

}  // namespace earthshine::scenes
