// SPDX-License-Identifier: Apache-2.0
// Energy bounds of a material.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"
#include "scenes/scene.h"

namespace earthshine::scenes {

// Requires diffuse + 2 specular / (n + 2) + mirror + transmit <= 1 in every channel. Otherwise
// throws an Error at `where` with the numbers. `what` names the material in the message.
void check_energy(const Material& material, const base::Location& where, const std::string& what);

// Directional albedo of the lobe for light along the normal: 2 k_s / (n + 2).
[[nodiscard]] Rgb lobe_albedo(const Material& material);

// Share of the incident light that leaves again: the sum above.
[[nodiscard]] Rgb reflected_share(const Material& material);

// Divides all shares of a material that breaks the bound by its largest sum, which preserves its
// hue. Returns the divisor, 1 if the bound holds.
double conserve_energy(Material& material);

// Total reflectance of a surface, for the radiosity, which is independent of direction.

// Bihemispherical albedo of a Phong lobe with k_s = 1 (docs/theory.md, "Lobes in the radiosity"):
//   (1/pi) integral over both directions of cos^n(alpha) cos(in) cos(out) / pi,
// 5/6 for n = 0 and 4 / (3 (n + 2)) for large n; relative error 1e-3. n >= 0. For an even lobe
// (Material::even_lobe) the integrand is divided by the larger cosine: 2 / (n + 2) for large n.
[[nodiscard]] double mean_lobe_reflectance(double n, bool even = false);

// Per material: k_d plus the albedo of its lobe.
[[nodiscard]] std::vector<Rgb> bihemispherical_albedos(const Scene& scene);

}  // namespace earthshine::scenes
