// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "scenes/mesh/gltf/file.h"
#include "scenes/mesh/gltf/writer.h"

namespace earthshine::scenes {
namespace {

GltfPart triangle(const std::string& name, float x) {
  return {name, {x, 2, 3, x + 1, 2, 3, x, 3, 3}, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 1, 2}};
}

Mesh read(const std::string& glb) { return parse_gltf(glb, "a.glb", {}); }

TEST(GltfWriter, WhatIsWrittenIsReadWithTheSceneStoodUpright) {
  const Mesh mesh =
      read(make_glb("bay", std::vector{triangle("liner", 1), triangle("dish", 5)}, {}));
  ASSERT_EQ(mesh.polygons.size(), 2U);
  ASSERT_EQ(mesh.vertices.size(), 6U);
  // z up becomes y up: (x, y, z) is written unchanged; the root node rotates it to (x, z, -y).
  EXPECT_EQ(mesh.vertices[0], Vec3(1, 3, -2));
  EXPECT_EQ(mesh.vertices[5], Vec3(5, 3, -3));
  const auto has = [&](const char* name) {
    return std::find(mesh.part_names.begin(), mesh.part_names.end(), name) != mesh.part_names.end();
  };
  EXPECT_TRUE(has("bay") && has("liner") && has("dish"));
  EXPECT_TRUE(mesh.warnings.empty());
}

TEST(GltfWriter, ATurnKeepsTheFrontInFront) {
  const Mesh mesh = read(make_glb("bay", std::vector{triangle("liner", 0)}, {}));
  const Vec3 cross =
      glm::cross(mesh.vertices[1] - mesh.vertices[0], mesh.vertices[2] - mesh.vertices[0]);
  EXPECT_EQ(cross, Vec3(0, 1, 0));  // the front faced up, along z
}

TEST(GltfWriter, PartsWithoutTrianglesAndEmptyScenesAreSoundToo) {
  EXPECT_EQ(read(make_glb("", std::vector{GltfPart{"none", {}, {}, {}}, triangle("a", 0)}, {}))
                .polygons.size(),
            1U);
  EXPECT_TRUE(
      read(make_glb("none", {}, std::vector<GltfNote>{{"x", 1.5}, {"y", "z"}})).polygons.empty());
}

}  // namespace
}  // namespace earthshine::scenes
