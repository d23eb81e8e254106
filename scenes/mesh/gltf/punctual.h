// SPDX-License-Identifier: Apache-2.0
// Lamps (KHR_lights_punctual) and cameras of a glTF file.
#pragma once

#include "scenes/mesh/gltf/model.h"

namespace earthshine::scenes {

// Reads lamps and cameras at the origin, directed along -z as in glTF; their nodes position them.
// Properties that Lamp and Camera lack are counted in model.unused.
void read_punctual(GltfModel& model);

// Index of the lamp at a node; negative: none.
[[nodiscard]] int lamp_on(const tinygltf::Node& node);

}  // namespace earthshine::scenes
