// SPDX-License-Identifier: Apache-2.0
// A glTF file of one triangle with the material, lamp or camera of a test.
#pragma once

#include <string>

#include "tests/scenes/scene_text.h"

namespace earthshine::test {

// A right triangle with its corner at the origin and legs of 1, implicit indices: three corners as
// floats at 0, as normalised shorts (8 bytes apart) at 36, as plain bytes (4 apart) at 60.
inline std::string triangle_buffer() {
  std::string bytes;
  const auto append = [&](auto value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  for (const float x : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F}) append(x);
  for (const int x : {0, 0, 0, 0, 32767, 0, 0, 0, 0, 32767, 0, 0}) {
    append(static_cast<std::int16_t>(x));
  }
  for (const int x : {0, 0, 0, 0, 100, 0, 0, 0, 0, 100, 0, 0}) append(static_cast<std::int8_t>(x));
  return bytes;
}

class GltfTriangle : public ::testing::Test {
 protected:
  GltfTriangle() { folder_.put("a.bin", triangle_buffer()); }

  // `more`: further members of the file; `node`: further members of the triangle's node.
  scenes::Scene read(
      const std::string& material, const std::string& more = "", const std::string& node = "",
      const std::string& keys = "",
      const std::string& accessor = R"("bufferView": 0, "componentType": 5126)") const {
    folder_.put("a.gltf", R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
      "nodes": [{"name": "thing", "mesh": 0)" +
                              node + R"(}],
      "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
      "buffers": [{"byteLength": 72, "uri": "a.bin"}],
      "bufferViews": [{"buffer": 0, "byteLength": 36},
        {"buffer": 0, "byteOffset": 36, "byteLength": 24, "byteStride": 8},
        {"buffer": 0, "byteOffset": 60, "byteLength": 12, "byteStride": 4}],
      "accessors": [{)" + accessor +
                              R"(, "count": 3, "type": "VEC3"}],
      "materials": [)" + material +
                              "]" + more + "}");
    const bool says_axes = keys.find("axes") != std::string::npos;
    return folder_.read("format = 1\n[[object]]\nname = \"o\"\nmesh = \"a.gltf\"\n" + keys +
                        (says_axes ? "" : "axes = \"as-is\"\n"));
  }
  scenes::Material material(const std::string& text) const { return read(text).materials.at(0); }

  SceneFolder folder_;
};

}  // namespace earthshine::test
