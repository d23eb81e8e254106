// SPDX-License-Identifier: Apache-2.0
// Lamps (KHR_lights_punctual) and cameras of a glTF file. Only the files that own tinygltf include
// this.
#pragma once

#include <tiny_gltf.h>

#include "scenes/mesh/gltf/model.h"

namespace earthshine::scenes {

// Lamps and cameras at the origin, shining and looking along -z, as glTF has them; their nodes say
// where they hang. What Lamp and Camera have no word for is counted in model.unused.
void read_punctual(const tinygltf::Model& source, GltfModel& model);

}  // namespace earthshine::scenes
