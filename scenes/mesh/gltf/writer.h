// SPDX-License-Identifier: Apache-2.0
// Coloured triangles as a GLB file for other people's viewers: glTF 2.0 with vertex colours and
// KHR_materials_unlit, so that the colours show as they are.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace earthshine::scenes {

// Asset.generator of these files: who reads one knows that its root node has turned it.
inline constexpr const char* own_generator = "earthshine";

// One node and its mesh. A part without triangles is left out.
struct GltfPart {
  std::string name;
  std::vector<float> positions;        // x, y, z per vertex, m
  std::vector<float> colours;          // r, g, b per vertex, linear, 0 to 1
  std::vector<std::uint32_t> indices;  // three per triangle, counter-clockwise seen from the front
};

using GltfNote = std::pair<std::string, std::variant<std::string, double>>;

// The bytes of the file. A scene's z axis is up and glTF's y: the root node, of that name, turns
// the one into the other and carries the notes as its extras. Only fronts are shown. Throws
// base::Error (Work) above 4 GiB, which is as far as GLB goes.
[[nodiscard]] std::string make_glb(const std::string& name, std::span<const GltfPart> parts,
                                   std::span<const GltfNote> notes);

}  // namespace earthshine::scenes
