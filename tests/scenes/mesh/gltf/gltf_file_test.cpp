// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "scenes/mesh/gltf/file.h"
#include "tests/scenes/scene_text.h"

namespace earthshine::scenes {
namespace {

using test::holds;

const std::string toml =
    "format = 1\n[[material]]\nname = \"m\"\n[[object]]\nname = \"o\"\nmesh = \"a.gltf\"\n"
    "axes = \"as-is\"\n";

template <class T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

// Four corners of a unit square at 0, then indices 0 1 2 0 2 3 as shorts at 48, and as a strip
// at 60.
std::string square_buffer() {
  std::string bytes;
  for (const float x : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 1.F, 1.F, 0.F, 0.F, 1.F, 0.F})
    append(bytes, x);
  for (const int i : {0, 1, 2, 0, 2, 3, 0, 1, 3, 2}) append(bytes, static_cast<std::uint16_t>(i));
  return bytes;
}

struct Parts {
  std::string nodes = R"([{"name": "root", "children": [1]}, {"name": "square", "mesh": 0}])";
  std::string scenes = R"([{"nodes": [0]}])";
  std::string primitive = R"({"attributes": {"POSITION": 0}, "indices": 1, "material": 0})";
  std::string buffer = R"({"byteLength": 68, "uri": "a.bin"})";
  std::string views =
      R"([{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 20},
          {"buffer": 0, "byteOffset": 48, "byteLength": 1073741824}])";
  std::string accessors =
      R"([{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
          {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
          {"bufferView": 1, "byteOffset": 12, "componentType": 5123, "count": 4, "type": "SCALAR"}])";
  std::string materials =
      R"([{"name": "paint", "doubleSided": true, "emissiveFactor": [0, 1, 0],
           "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 0.125, 1], "metallicFactor": 0}}])";

  [[nodiscard]] std::string text() const {
    return R"({"asset": {"version": "2.0"}, "scene": 0, "nodes": )" + nodes + R"(, "scenes": )" +
           scenes + R"(, "meshes": [{"name": "mesh", "primitives": [)" + primitive +
           R"(]}], "buffers": [)" + buffer + R"(], "bufferViews": )" + views +
           R"(, "accessors": )" + accessors + R"(, "materials": )" + materials + "}";
  }
};

class Gltf : public ::testing::Test {
 protected:
  Gltf() { folder_.put("a.bin", square_buffer()); }
  Scene read(const Parts& parts, const std::string& more = "") const {
    folder_.put("a.gltf", parts.text());
    return folder_.read(toml + more);
  }
  std::string refusal(const Parts& parts, const std::string& more = "") const {
    folder_.put("a.gltf", parts.text());
    return folder_.refusal(toml + more);
  }
  test::SceneFolder folder_;
};

TEST_F(Gltf, GltfAndGlbGiveTheSameSquare) {
  const Scene scene = read({});
  EXPECT_DOUBLE_EQ(scene.objects.at(0).area_m2, 1.0);
  EXPECT_EQ(scene.objects.at(0).triangle_count, 2U);
  const Material& paint = scene.materials.at(scene.triangles.at(0).material);
  EXPECT_EQ(paint.name, "paint");
  EXPECT_EQ(paint.diffuse, Rgb(0.5, 0.25, 0.125));
  EXPECT_EQ(paint.emit, Rgb(0, base::pi, 0));
  EXPECT_TRUE(paint.two_sided);

  Parts parts;
  parts.buffer = R"({"byteLength": 68})";
  std::string json = parts.text();
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::string data = square_buffer();
  std::string glb = "glTF";
  append(glb, std::uint32_t{2});
  append(glb, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + data.size()));
  append(glb, static_cast<std::uint32_t>(json.size()));
  append(glb, std::uint32_t{0x4E4F534A});
  glb += json;
  append(glb, static_cast<std::uint32_t>(data.size()));
  append(glb, std::uint32_t{0x004E4942});
  glb += data;
  folder_.put("a.glb", glb);
  const std::string as_glb = "format = 1\n[[object]]\nname = \"o\"\nmesh = \"a.glb\"\n";
  EXPECT_DOUBLE_EQ(folder_.read(as_glb).objects.at(0).area_m2, 1.0);
  for (std::size_t size = 0; size < glb.size(); size += 7) {
    folder_.put("a.glb", glb.substr(0, size));
    EXPECT_TRUE(holds(folder_.refusal(as_glb), {"a.glb"}));
  }
}

TEST_F(Gltf, StripsAndFansGiveTheirTriangles) {
  Parts parts;
  parts.primitive = R"({"attributes": {"POSITION": 0}, "indices": 2, "mode": 5, "material": 0})";
  Scene scene = read(parts);
  EXPECT_DOUBLE_EQ(scene.objects.at(0).area_m2, 1.0);
  parts.primitive = R"({"attributes": {"POSITION": 0}, "mode": 6, "material": 0})";
  scene = read(parts);
  EXPECT_DOUBLE_EQ(scene.objects.at(0).area_m2, 1.0);
  for (const Triangle& t : scene.triangles) {
    const auto& v = scene.vertices;
    EXPECT_GT(glm::cross(v[t.vertex[1]] - v[t.vertex[0]], v[t.vertex[2]] - v[t.vertex[0]]).z, 0.0);
  }
}

TEST_F(Gltf, NodeTransformsApplyAndMirrorsKeepFrontsOutward) {
  Parts parts;
  parts.nodes =
      R"([{"name": "root", "scale": [-2, 2, 2], "translation": [0, 0, 5], "children": [1]},
                    {"name": "square", "mesh": 0, "rotation": [1, 0, 0, 0]}])";  // half a turn
                                                                                 // about x
  const Scene scene = read(parts);
  EXPECT_DOUBLE_EQ(scene.objects.at(0).area_m2, 4.0);
  for (const Triangle& t : scene.triangles) {
    const auto& v = scene.vertices;
    EXPECT_LT(glm::cross(v[t.vertex[1]] - v[t.vertex[0]], v[t.vertex[2]] - v[t.vertex[0]]).z, 0.0);
    EXPECT_NEAR(v[t.vertex[0]].z, 5.0, 1e-12);
  }
}

TEST_F(Gltf, PartsAreNodesWithWhatHangsBelowAndMeshes) {
  Parts parts;
  parts.nodes =
      R"([{"name": "root", "children": [1, 2]}, {"name": "one", "mesh": 0}, {"name": "two", "mesh": 0, "translation": [0, 0, 1]}])";
  EXPECT_EQ(read(parts, "part = \"root\"\n").triangles.size(), 4U);
  EXPECT_EQ(read(parts, "part = \"one\"\n").triangles.size(), 2U);
  EXPECT_EQ(read(parts, "part = \"mesh\"\n").triangles.size(), 4U);
  EXPECT_TRUE(holds(refusal(parts, "part = \"tow\"\n"), {"no part \"tow\"", "\"two\"?"}));
}

TEST_F(Gltf, WhatIsNotUsedIsNamed) {
  Parts parts;
  parts.primitive =
      R"({"attributes": {"POSITION": 0, "NORMAL": 0, "TEXCOORD_0": 0}, "indices": 1, "material": 0,
          "targets": [{"POSITION": 0}, {"TEXCOORD_0": 0}]}, {"attributes": {"POSITION": 0}, "mode": 1})";
  parts.nodes = R"([{"name": "root", "children": [1]}, {"mesh": 0}, {"mesh": 0}, {}])";
  parts.materials +=
      R"(, "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}],
      "extensionsUsed": ["KHR_materials_sheen", "KHR_materials_ior"])";
  EXPECT_EQ(read(parts).objects.at(0).unused,
            "1 NORMAL, 1 TEXCOORD_0, 1 cameras, 1 morph targets of TEXCOORD_0, "
            "1 nodes outside the scene that is read, 1 points or lines; round_deg rounds the "
            "surface by the normals");
  EXPECT_EQ(read({}).objects.at(0).unused, "");
}

TEST_F(Gltf, RequiredExtensionsAreRefusedByNameWithWhatToDo) {
  const std::vector<std::pair<std::string, std::string>> known = {
      {"KHR_draco_mesh_compression", "gltf-transform/cli copy"},
      {"EXT_meshopt_compression", "gltf-transform/cli copy"},
      {"XYZ_from_tomorrow", "Export it without"}};
  for (const auto& [extension, remedy] : known) {
    Parts parts;
    parts.materials += R"(, "extensionsUsed": [")" + extension + R"("], "extensionsRequired": [")" +
                       extension + R"("])";
    EXPECT_TRUE(holds(refusal(parts), {"a.gltf", extension, remedy}));
  }
  Parts textures;
  textures.materials += R"(, "extensionsUsed": ["KHR_texture_transform"],
                             "extensionsRequired": ["KHR_texture_transform"])";
  EXPECT_EQ(read(textures).triangles.size(), 2U);
}

TEST_F(Gltf, SparsePositionsReplaceOthers) {
  Parts parts;
  parts.accessors =
      R"([{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "sparse": {"count": 1,
           "indices": {"bufferView": 1, "byteOffset": 2, "componentType": 5123},
           "values": {"bufferView": 0, "byteOffset": 0}}},
          {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}])";
  // Corner 1 coincides with corner 0: the first triangle vanishes.
  const Scene scene = read(parts);
  EXPECT_EQ(scene.objects.at(0).degenerate_count, 1U);
  EXPECT_DOUBLE_EQ(scene.objects.at(0).area_m2, 0.5);
}

TEST_F(Gltf, WhatTheLibraryAcceptsAndShouldNotIsRefused) {
  struct Broken {
    std::string Parts::*part;
    std::string text;
    std::vector<std::string> message;
  };
  const std::string positions =
      R"([{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},)";
  const std::vector<Broken> all{
      {&Parts::accessors,
       R"([{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
            "sparse": {"count": 1000000000000000,
             "indices": {"bufferView": 1, "byteOffset": 2, "componentType": 5123},
             "values": {"bufferView": 0, "byteOffset": 0}}},
           {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}])",
       {"accessors[0].sparse.count is 1000000000000000;", "2147483647"}},
      {&Parts::nodes,
       R"([{"children": [1]}, {"mesh": 0, "children": [0]}])",
       {"node 0 is reached twice", "tree"}},
      {&Parts::nodes, R"([{"children": [1, 1]}, {"mesh": 0}])", {"node 1 is reached twice"}},
      {&Parts::nodes, R"([{"children": [7]}])", {"node 7 does not exist"}},
      {&Parts::nodes, R"([{"mesh": 3}])", {"mesh 3 does not exist"}},
      {&Parts::nodes, R"([{"mesh": 0, "scale": [1, 2]}])", {"scale"}},
      {&Parts::nodes, R"([{"mesh": 0, "rotation": [0, 0, 0, 0]}])", {"rotation", "no length"}},
      {&Parts::scenes, R"([{"nodes": [9]}])", {"node 9 does not exist"}},
      {&Parts::primitive, R"({"attributes": {"POSITION": 9}, "material": 0})", {"accessor 9"}},
      {&Parts::primitive,
       R"({"attributes": {"POSITION": 1}, "material": 0})",
       {"POSITION is VEC3"}},
      {&Parts::primitive,
       R"({"attributes": {"POSITION": 0}, "indices": 0, "material": 0})",
       {"SCALAR"}},
      {&Parts::primitive, R"({"attributes": {"POSITION": 0}, "material": 8})", {"material 8"}},
      {&Parts::primitive, R"({"attributes": {"POSITION": 0}, "mode": 0})", {"no faces"}},
      {&Parts::buffer,
       R"({"byteLength": 68, "uri": "../../../../etc/passwd"})",
       {"leads out of the scene's folder"}},
      {&Parts::buffer, R"({"byteLength": 68, "uri": "/etc/passwd"})", {"not relative"}},
      {&Parts::buffer, R"({"byteLength": 68, "uri": "none.bin"})", {"a.gltf", "none.bin"}},
      {&Parts::buffer, R"({"byteLength": 99, "uri": "a.bin"})", {"a.gltf", "99"}},
      {&Parts::views,
       R"([{"buffer": 4, "byteLength": 48}, {"buffer": 0, "byteLength": 20}])",
       {"buffer 4 does not exist"}},
      {&Parts::views,
       R"([{"buffer": 0, "byteLength": 4800}, {"buffer": 0, "byteLength": 20}])",
       {"leaves its buffer"}},
      {&Parts::views,
       R"([{"buffer": 0, "byteOffset": 18446744073709551612, "byteLength": 48}])",
       {"a.gltf"}},
      // The buffer has 68 bytes, the picture ends at byte 48 + 2^30.
      {&Parts::materials,
       R"([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}], "textures": [{"source": 0}],
           "images": [{"bufferView": 2, "mimeType": "image/png"}])",
       {"images[0]", "1073741872", "68"}},
      {&Parts::accessors,
       positions + R"({"bufferView": 5, "componentType": 5123, "count": 6, "type": "SCALAR"}])",
       {"invalid bufferView"}},
      {&Parts::accessors,
       positions + R"({"bufferView": -2, "componentType": 5123, "count": 6, "type": "SCALAR"}])",
       {"a.gltf"}},
      {&Parts::accessors,
       R"([{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
           {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}])",
       {"vertex index 3 is out of range"}},
      {&Parts::accessors,
       positions +
           R"({"bufferView": 1, "componentType": 5123, "count": 4000000000, "type": "SCALAR"}])",
       {"4000000000"}},
      {&Parts::accessors,
       positions + R"({"bufferView": 1, "componentType": 5123, "count": 60, "type": "SCALAR"}])",
       {"leaves its buffer"}},
      {&Parts::accessors,
       positions + R"({"bufferView": 1, "byteOffset": 18446744073709551612, "componentType": 5123,
         "count": 6, "type": "SCALAR"}])",
       {"accessors[1].byteOffset is 18446744073709551612;"}},
      {&Parts::nodes,
       R"([{"mesh": 0, "matrix": [1,0,0,0.5, 0,1,0,0, 0,0,1,0, 0,0,0,1]}])",
       {"matrix of node", "projection", "0.5 0 0 1"}},
      {&Parts::accessors,
       positions + R"({"bufferView": 1, "componentType": 5126, "count": 3, "type": "SCALAR"}])",
       {"indices"}}};
  for (const Broken& broken : all) {
    Parts parts;
    parts.*(broken.part) = broken.text;
    EXPECT_TRUE(holds(refusal(parts), broken.message)) << broken.text;
  }
}

TEST_F(Gltf, TexturesAreNotOpenedWhereverTheyLie) {
  Parts parts;
  parts.materials =
      R"([{"name": "paint", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
          "textures": [{"source": 0}], "images": [{"uri": "../../textures/a.png"}])";
  const Scene scene = read(parts);
  ASSERT_EQ(scene.warnings.size(), 1U);
  EXPECT_TRUE(holds(scene.warnings[0],
                    {"a texture is left out", "a.gltf", "leads out of the scene's folder"}));
}

TEST_F(Gltf, DeepTextsAndChainsAreRefused) {
  Parts parts;
  parts.materials = std::string(200000, '[');
  EXPECT_TRUE(holds(refusal(parts), {"a.gltf", "nested too deeply"}));
  parts = {};
  parts.nodes = "[";
  for (int i = 0; i < 1000; ++i) parts.nodes += "{\"children\": [" + std::to_string(i + 1) + "]},";
  parts.nodes += R"({"mesh": 0}])";
  EXPECT_TRUE(holds(refusal(parts), {"a.gltf", "nested too deeply", "64"}));
}

}  // namespace
}  // namespace earthshine::scenes
