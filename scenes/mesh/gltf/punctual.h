// SPDX-License-Identifier: Apache-2.0
// Lamps (KHR_lights_punctual) and cameras of a glTF file.
#pragma once

#include "scenes/mesh/gltf/model.h"

namespace earthshine::scenes {

// Lamps and cameras at the origin, shining and looking along -z, as glTF has them; their nodes say
// where they hang. What Lamp and Camera have no word for is counted in model.unused.
void read_punctual(GltfModel& model);

// The number of the lamp that hangs on a node; negative: none.
[[nodiscard]] int lamp_on(const tinygltf::Node& node);

}  // namespace earthshine::scenes
