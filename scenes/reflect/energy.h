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

}  // namespace earthshine::scenes
