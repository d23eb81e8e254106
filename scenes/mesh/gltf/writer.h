// SPDX-License-Identifier: Apache-2.0
// Writes coloured triangles as a GLB file for common viewers: glTF 2.0 with vertex colours and
// KHR_materials_unlit, so that viewers show the colours unchanged.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace earthshine::scenes {

// Asset.generator of these files. The reader uses it to detect the rotation of the root node.
inline constexpr const char* own_generator = "earthshine";

// One node and its mesh. Parts without triangles are omitted.
struct GltfPart {
  std::string name;
  std::vector<float> positions;        // x, y, z per vertex, m
  std::vector<float> colours;          // r, g, b per vertex, linear, 0 to 1
  std::vector<std::uint32_t> indices;  // three per triangle, counter-clockwise seen from the front
};

using GltfNote = std::pair<std::string, std::variant<std::string, double>>;

// The bytes of the file. The scene's z axis is up, glTF's y axis is: the root node, called `name`,
// rotates one to the other and has the notes as its extras. Only fronts are visible. Throws
// base::Error (Work) above 4 GiB, the limit of GLB.
[[nodiscard]] std::string make_glb(const std::string& name, std::span<const GltfPart> parts,
                                   std::span<const GltfNote> notes);

}  // namespace earthshine::scenes
