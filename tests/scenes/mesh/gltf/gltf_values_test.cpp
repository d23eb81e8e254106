// SPDX-License-Identifier: Apache-2.0
// Values of a glTF file that violate the specification.
#include <algorithm>

#include "tests/scenes/mesh/gltf/gltf_triangle.h"

namespace earthshine::scenes {
namespace {

using test::holds;
using GltfValues = test::GltfTriangle;

TEST_F(GltfValues, ValuesThatNobodyCanMeanAreRefusedByTheirPlace) {
  const auto refusal = [&](const std::string& material, const std::string& more = "",
                           const std::string& node = "") -> std::string {
    try {
      static_cast<void>(read(material, more, node));
    } catch (const base::Error& error) {
      return error.what();
    }
    return "was not refused";
  };
  const auto pbr = [](const std::string& text) {
    return R"({"pbrMetallicRoughness": {)" + text + "}}";
  };
  EXPECT_TRUE(holds(refusal(pbr(R"("baseColorFactor": [1, 0, 0])")),
                    {"a.gltf: materials[0].pbrMetallicRoughness.baseColorFactor is a list of 3",
                     "4 numbers, from 0 to 1", "glTF 2.0"}));
  EXPECT_TRUE(holds(refusal(pbr(R"("baseColorFactor": [1, 0, "0", 1])")), {"[2] is \"0\""}));
  EXPECT_TRUE(holds(refusal(pbr(R"("roughnessFactor": "x")")), {"roughnessFactor is \"x\""}));
  EXPECT_TRUE(holds(refusal(pbr(R"("baseColorTexture": {"index": "0"})")),
                    {"baseColorTexture.index is \"0\"", "a whole number"}));
  EXPECT_TRUE(holds(refusal(R"({"pbrMetallicRoughness": []})"), {"is a list of 0", "a table"}));
  EXPECT_TRUE(holds(refusal(R"({}, {"alphaMode": "Blend"})"),
                    {"materials[1].alphaMode is \"Blend\"", "OPAQUE, MASK, BLEND"}));
  EXPECT_TRUE(holds(refusal(R"({"doubleSided": 1})"), {"doubleSided is 1", "true or false"}));
  EXPECT_TRUE(holds(refusal(R"({"extensions": {"KHR_materials_ior": {"ior": "glass"}}})"),
                    {"KHR_materials_ior.ior is \"glass\""}));
  EXPECT_TRUE(holds(refusal("{}", "", R"(, "extensions": {"KHR_lights_punctual": {"light": "0"}})"),
                    {"nodes[0].extensions.KHR_lights_punctual.light is \"0\"", "a whole number"}));
  EXPECT_TRUE(holds(refusal("{}", "", R"(, "scale": "2")"), {"nodes[0].scale is \"2\""}));
  EXPECT_TRUE(holds(refusal("{}", "", R"(, "camera": 0.5)"), {"nodes[0].camera is 0.5"}));
}

TEST_F(GltfValues, ValuesOutOfRangeAreNamedOnceWithWhatIsDone) {
  const auto named = [](const Scene& scene, const std::vector<std::string>& pieces) {
    return std::any_of(scene.warnings.begin(), scene.warnings.end(),
                       [&](const std::string& warning) { return bool(holds(warning, pieces)); });
  };
  const Scene bright = read(R"({"emissiveFactor": [5, 0.5, 7]}, {"emissiveFactor": [9, 0, 0]})");
  EXPECT_EQ(bright.materials.at(0).emit, base::pi * Rgb(1.0, 0.5, 1.0));
  EXPECT_TRUE(named(bright, {"a.gltf: materials[0].emissiveFactor[0] is 5 (2 more such)",
                             "3 numbers, from 0 to 1", "the nearest allowed is taken"}));
  const Scene wide = read("{}", R"(, "cameras": [{"type": "perspective", "perspective":
      {"yfov": 4, "znear": 1}}, {"type": "perspective", "perspective":
      {"yfov": 1, "znear": 1, "aspectRatio": -2}}])",
                          R"(, "camera": 0)", "cameras = true\n");
  EXPECT_TRUE(wide.cameras.empty());
  EXPECT_TRUE(named(wide, {"cameras[0].perspective.yfov is 4", "the camera is left out"}));
  EXPECT_TRUE(named(wide, {"cameras[1].perspective.aspectRatio is -2", "1 is taken"}));
  EXPECT_EQ(wide.objects.at(0).unused, "");  // it is not orthographic
  EXPECT_TRUE(
      named(read("{}", "", R"(, "camera": -1)"), {"nodes[0].camera is -1", "taken as none"}));
  // Contents of unknown extensions are not checked; float rounding is tolerated.
  const Scene other = read(R"({"extensions": {"XYZ_toon": {"shadeTexture": 3}}, "extras":
      {"alphaMode": 1}, "emissiveFactor": [1.0000001, 0, 0]})",
                           R"(, "extensions": {"XYZ_all": {"scene": "x", "materials": 2}})");
  ASSERT_EQ(other.warnings.size(), 1U);
  EXPECT_TRUE(named(other, {"not used", "XYZ_toon (1)"}));
  const Scene foreign = read(R"({"extensions": {"XYZ_toon": {"KHR_texture_transform": 5}}})");
  ASSERT_EQ(foreign.warnings.size(), 1U);
  EXPECT_TRUE(named(foreign, {"not used", "XYZ_toon (1)"}));
  // 2^32 must not become entry 0.
  const Scene plain =
      read(R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 4294967296}}})",
           R"(, "textures": [{"source": 0}], "images": [{"uri": "none.png"}])");
  EXPECT_TRUE(named(plain, {"baseColorTexture.index is 4294967296", "taken as none"}));
  EXPECT_EQ(plain.warnings.size(), 1U);
}

TEST_F(GltfValues, WholeNumbersMayBeWrittenWithAPoint) {
  const Scene scene =
      read("{}, {}", R"(, "scene": 0.0)", "", "", R"("bufferView": 0.0, "componentType": 5126.0)");
  EXPECT_DOUBLE_EQ(scene.objects.at(0).area_m2, 0.5);
}

}  // namespace
}  // namespace earthshine::scenes
