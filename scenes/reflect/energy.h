// SPDX-License-Identifier: Apache-2.0
// What a material may reflect and let through at most.
#pragma once

#include <string>

#include "base/error.h"
#include "scenes/scene.h"

namespace earthshine::scenes {

// Energy: diffuse + 2 specular / (n + 2) + mirror + transmit <= 1 in every channel, else an Error
// at `where` that gives the numbers. `what` names the material in the message.
void check_energy(const Material& material, const base::Location& where, const std::string& what);

// What it sends on of the light that arrives: the sum above.
[[nodiscard]] Rgb reflected_share(const Material& material);

// Divides all shares of a material that breaks the bound by its largest sum, so that it loses
// nothing and keeps its hue. Returns that sum; 1 where there was nothing to do.
double conserve_energy(Material& material);

}  // namespace earthshine::scenes
