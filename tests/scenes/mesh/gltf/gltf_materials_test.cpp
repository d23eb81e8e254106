// SPDX-License-Identifier: Apache-2.0
// Conversion of glTF's materials to Phong, of its lamps and cameras, and of quantised numbers.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "base/files/png_file.h"
#include "scenes/reflect/energy.h"
#include "scenes/reflect/ggx_lobes.h"
#include "scenes/texture/texture.h"
#include "tests/scenes/mesh/gltf/gltf_triangle.h"

namespace earthshine::scenes {
namespace {

using test::holds;

using GltfMaterials = test::GltfTriangle;

TEST_F(GltfMaterials, MetalIsAnEvenLobeOverADiffusePart) {
  const Material metal = material(
      R"({"pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.6, 0.4, 1], "roughnessFactor": 0.5}})");
  const PhongLobe lobe = phong_of_ggx(0.25);
  EXPECT_NEAR(metal.diffuse.g, 0.6 * lobe.diffuse, 1e-12);
  EXPECT_NEAR(metal.specular.r, 0.8 * lobe.peak, 1e-12);
  EXPECT_NEAR(metal.shininess, lobe.shininess, 1e-12);
  EXPECT_TRUE(metal.even_lobe);
  const Material mirror = material(
      R"({"pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.6, 0.4, 1], "roughnessFactor": 0}})");
  EXPECT_EQ(mirror.mirror, Rgb(0.8, 0.6, 0.4));
  // The roughest material, the format's default, has GGX's albedo without the cap: 0.3767 = (2 (1 -
  // ln 2))^2, the integral of 1 / ((1 + x)(1 + y)) over both cosines squared.
  const Material rough = material("{}");
  EXPECT_NEAR(rough.diffuse.r, std::pow(2.0 * (1.0 - std::log(2.0)), 2), 1e-3);
  EXPECT_EQ(rough.specular, Rgb(0.0));
}

TEST_F(GltfMaterials, DielectricsReflectByTheirIndex) {
  const std::string pbr =
      R"("pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.4, "baseColorFactor": [0.5, 0.5, 0.5, 1]})";
  const PhongLobe lobe = phong_of_ggx(0.16);
  const Material usual = material("{" + pbr + "}");
  // F0 = ((1.5 - 1) / (1.5 + 1))^2; the lobe's own diffuse part stays in the base colour.
  const double taken = 0.04 * lobe.albedo() / (lobe.albedo() + lobe.diffuse);
  EXPECT_NEAR(usual.diffuse.r, (1.0 - taken) * 0.5, 1e-12);
  EXPECT_NEAR(usual.specular.r, 0.04 * lobe.peak, 1e-12);
  const Material dense =
      material("{" + pbr + R"(, "extensions": {"KHR_materials_ior": {"ior": 2}}})");
  EXPECT_NEAR(dense.specular.r, lobe.peak / 9.0, 1e-12);
  const Material tinted = material("{" + pbr + R"(, "extensions": {"KHR_materials_specular":
      {"specularFactor": 0.5, "specularColorFactor": [2, 1, 0]}}})");
  EXPECT_NEAR(tinted.specular.r, 0.04 * lobe.peak, 1e-12);
  EXPECT_NEAR(tinted.specular.g, 0.02 * lobe.peak, 1e-12);
  EXPECT_NEAR(tinted.diffuse.b, (1.0 - taken) * 0.5, 1e-12);
  // Wide and weak: becomes diffuse light.
  const Material rough = material(
      R"({"pbrMetallicRoughness": {"metallicFactor": 0, "baseColorFactor": [0.5, 0.5, 0.5, 1]}})");
  EXPECT_EQ(rough.diffuse, Rgb(0.5));
  EXPECT_EQ(rough.specular, Rgb(0.0));
}

TEST_F(GltfMaterials, SpecularGlossinessEmissionAndUnlit) {
  const Scene glossy = read(R"({"emissiveFactor": [1, 0.5, 0], "extensions": {
      "KHR_materials_emissive_strength": {"emissiveStrength": 20},
      "KHR_materials_pbrSpecularGlossiness": {"diffuseFactor": [0.4, 0.4, 0.4, 1],
        "specularFactor": [0.2, 0.2, 0.2], "glossinessFactor": 0.75}}})",
                            R"(, "extensionsUsed": ["KHR_materials_pbrSpecularGlossiness"],
      "extensionsRequired": ["KHR_materials_pbrSpecularGlossiness"])");
  const Material& made = glossy.materials.at(0);
  const PhongLobe lobe = phong_of_ggx(0.0625);
  // The lobe takes its share of F = 0.2 from the diffuse light. The facets' diffuse part, F d, is
  // added as far as it exceeds the part that the diffuse light retains for it.
  const double in_lobe = lobe.albedo() / (lobe.albedo() + lobe.diffuse);
  const double even = std::max(0.0, 0.2 * lobe.diffuse - 0.4 * 0.2 * (1.0 - in_lobe));
  EXPECT_NEAR(made.diffuse.r, (1.0 - 0.2 * in_lobe) * 0.4 + even, 1e-12);
  EXPECT_NEAR(made.specular.r, 0.2 * lobe.peak, 1e-12);
  // Black with maximum roughness: only the diffuse part.
  const Scene rough = read(R"({"extensions": {"KHR_materials_pbrSpecularGlossiness": {
      "diffuseFactor": [0, 0, 0, 1], "specularFactor": [0.25, 0.25, 0.25], "glossinessFactor": 0}}})");
  EXPECT_NEAR(rough.materials.at(0).diffuse.r, 0.25 * phong_of_ggx(1.0).diffuse, 1e-12);
  EXPECT_NEAR(made.emit.r, 20.0 * base::pi, 1e-9);
  EXPECT_NEAR(made.emit.g, 10.0 * base::pi, 1e-9);
  EXPECT_EQ(glossy.objects.at(0).unused, "");
  const Scene unlit = read(R"({"extensions": {"KHR_materials_unlit": {}},
      "pbrMetallicRoughness": {"baseColorFactor": [0.3, 0.2, 0.1, 1]}})");
  EXPECT_EQ(unlit.materials.at(0).diffuse, Rgb(0.3, 0.2, 0.1));
  EXPECT_TRUE(holds(unlit.objects.at(0).unused, {"unlit"}));
}

TEST_F(GltfMaterials, GlassPassesItsColourAndBendsOnlyWhereItIsThick) {
  const std::string pbr =
      R"("pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0, "baseColorFactor": [1, 0.5, 0.25, 1]})";
  const Material sheet = material(
      "{" + pbr + R"(, "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}}})");
  EXPECT_NEAR(sheet.transmit.g, 0.5 * 0.96, 1e-12);
  EXPECT_NEAR(sheet.mirror.g, 0.04, 1e-12);
  EXPECT_EQ(sheet.diffuse, Rgb(0.0));
  EXPECT_EQ(sheet.ior, 1.0);
  const Material body = material("{" + pbr + R"(, "extensions": {
      "KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.33},
      "KHR_materials_volume": {"thicknessFactor": 1}}})");
  EXPECT_EQ(body.ior, 1.33);
  const Material blended = material(
      R"({"alphaMode": "BLEND", "pbrMetallicRoughness": {"metallicFactor": 0, "baseColorFactor": [0.5, 0.5, 0.5, 0.25]}})");
  EXPECT_EQ(blended.diffuse, Rgb(0.125));
  EXPECT_EQ(blended.transmit, Rgb(0.75));
}

TEST_F(GltfMaterials, TexturesAreTurnedCounterClockwiseAndMetalHasTheirMean) {
  base::write_png(folder_.path() / "a b.png", 2, 2, 1, std::vector<std::uint8_t>{255, 0, 0, 255});
  const std::string more =
      R"(, "images": [{"uri": "a%20b.png"}], "textures": [{"source": 0, "sampler": 0}],
      "samplers": [{"wrapS": 33071, "wrapT": 33648, "magFilter": 9728}])";
  const std::string turned =
      R"("baseColorTexture": {"index": 0, "extensions": {"KHR_texture_transform":
      {"offset": [0.5, 0.25], "rotation": 1.57079632679489662, "scale": [2, 4]}}})";
  const Scene plain =
      read(R"({"pbrMetallicRoughness": {"metallicFactor": 0, )" + turned + "}}", more);
  ASSERT_TRUE(plain.materials.at(0).maps);
  const TextureMap& map = plain.materials.at(0).maps->diffuse;
  // (u, v) = (0.1, 0.2) scaled is (0.2, 0.8); a quarter turn counter-clockwise, with v downward,
  // maps (1, 0) to (0, -1) and (0, 1) to (1, 0): (0.8, -0.2); shifted (1.3, 0.05).
  const glm::dvec2 place = map.transform->apply({0.1, 0.2});
  EXPECT_NEAR(place.x, 1.3, 1e-12);
  EXPECT_NEAR(place.y, 0.05, 1e-12);
  // Repeated or mirrored, u = -3.25 would be 0.75: black; clamped it is 0. Mirrored, v = 1.75 is
  // 0.25; repeated or clamped it would be 0.75 or 1: black.
  EXPECT_NEAR(map.texture->at({-3.25, 0.25}).r, 1.0, 1e-9);
  EXPECT_NEAR(map.texture->at({0.25, 1.75}).r, 1.0, 1e-9);
  EXPECT_NEAR(map.texture->at({0.499, 0.25}).r, 1.0, 1e-9);  // nearest texel
  EXPECT_TRUE(holds(plain.warnings.at(0), {"1 primitives lack the texture coordinates"}));
  const Scene metal =
      read(R"({"pbrMetallicRoughness": {"roughnessFactor": 0, )" + turned + "}}", more);
  EXPECT_NEAR(metal.materials.at(0).mirror.g, 0.5, 1e-4);
  // Means of 0.5 halve both factors: a^2 = 0.25^2; half metal, half a dielectric whose light is
  // diffuse except for F0 = 0.04.
  const Scene half =
      read(R"({"pbrMetallicRoughness": {"metallicRoughnessTexture": {"index": 0}}})", more);
  const Material& made = half.materials.at(0);
  const PhongLobe lobe = phong_of_ggx(0.25);
  // The dielectric's own highlight, k_s = 0.02 * 3.664 = 0.073, fades between 0.05 and 0.1.
  const double kept = 0.5 * 0.04 * lobe.peak / 0.05 - 1.0;
  const double taken = 0.04 * kept * lobe.albedo() / (lobe.albedo() + lobe.diffuse);
  EXPECT_NEAR(made.shininess, lobe.shininess, 1e-3);
  EXPECT_NEAR(made.diffuse.r, 0.5 * (1.0 - taken) + 0.5 * lobe.diffuse, 1e-3);
  EXPECT_NEAR(made.specular.r, (0.5 + 0.5 * 0.04 * kept) * lobe.peak, 1e-3);
  ASSERT_EQ(half.warnings.size(), 1U);
  EXPECT_TRUE(holds(half.warnings[0], {"a.gltf: not used", "metallic-roughness maps, but for"}));
}

TEST_F(GltfMaterials, TexturesThatAreNotThereAreNamed) {
  const std::string textured = R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 7}}})";
  const Scene scene = read(textured, R"(, "textures": [{}])");
  ASSERT_EQ(scene.warnings.size(), 1U);
  EXPECT_TRUE(holds(scene.warnings[0], {"a.gltf", "texture 7 does not exist", "the file has 1"}));
}

TEST_F(GltfMaterials, NumbersThatAreNoneAreRefusedByTheirName) {
  const float nan = std::nanf("");
  std::string bytes = test::triangle_buffer();
  std::memcpy(bytes.data() + 4, &nan, sizeof nan);
  folder_.put("a.bin", bytes);
  try {
    static_cast<void>(read("{}"));
    ADD_FAILURE() << "was not refused";
  } catch (const base::Error& error) {
    EXPECT_TRUE(holds(error.what(), {"a.gltf", "POSITION of a vertex has nan", "finite"}));
  }
}

TEST_F(GltfMaterials, LampsAndCamerasComeWhenAskedFor) {
  const std::string more = R"(, "extensionsUsed": ["KHR_lights_punctual"],
      "extensions": {"KHR_lights_punctual": {"lights": [{"type": "spot", "color": [1, 0.5, 0],
        "intensity": 200, "spot": {"innerConeAngle": 0.2, "outerConeAngle": 0.5}},
        {"type": "directional", "intensity": 5}]}},
      "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 1, "aspectRatio": 2}}])";
  // A quarter turn about x: -z becomes +y.
  const std::string node = R"(, "camera": 0, "translation": [1, 2, 3],
      "rotation": [0.70710678118654752, 0, 0, 0.70710678118654752],
      "extensions": {"KHR_lights_punctual": {"light": 0}})";
  const Scene none = read("{}", more, node);
  EXPECT_TRUE(none.lamps.empty() && none.cameras.empty());
  EXPECT_EQ(none.objects.at(0).unused, "1 cameras, 2 lights");
  const Scene both = read("{}", more, node, "lights = true\ncameras = true\nscale = 2.0\n");
  EXPECT_EQ(both.objects.at(0).unused, "");
  const Lamp& lamp = both.lamps.at(0);
  EXPECT_EQ(lamp.name, "o.thing");
  EXPECT_EQ(lamp.group, "o.thing");
  EXPECT_EQ(lamp.intensity_cd, Rgb(200, 100, 0));
  // At the triangle's corner: lifted by 0.16 mm (LiftLamps).
  EXPECT_NEAR(glm::length(lamp.position - Vec3(2, 4, 6)), 1.6e-4, 1e-10);
  EXPECT_NEAR(glm::length(lamp.axis - Vec3(0, 1, 0)), 0.0, 1e-12);
  EXPECT_NEAR(lamp.beam_deg, 2.0 * 0.2 * 180.0 / base::pi, 1e-9);
  EXPECT_NEAR(lamp.field_deg, 2.0 * 0.5 * 180.0 / base::pi, 1e-9);
  const Camera& camera = both.cameras.at(0);
  EXPECT_EQ(camera.name, "o.thing");
  EXPECT_NEAR(glm::length(camera.look_at - Vec3(2, 5, 6)), 0.0, 1e-12);
  EXPECT_NEAR(glm::length(camera.up - Vec3(0, 0, 1)), 0.0, 1e-12);
  EXPECT_NEAR(camera.fov_deg, 180.0 / base::pi, 1e-9);
  EXPECT_EQ(camera.columns, 2 * camera.rows);
}

TEST_F(GltfMaterials, LampsThatCannotBeAreNamed) {
  const auto lit = [&](const std::string& light) {
    return read("{}",
                R"(, "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": [)" +
                    light + "]}}",
                R"(, "extensions": {"KHR_lights_punctual": {"light": 0}})", "lights = true\n");
  };
  const Scene sound = lit(R"({"type": "point", "intensity": 5})");
  EXPECT_EQ(sound.objects.at(0).unused, "");
  const Scene laser = lit(R"({"type": "laser", "intensity": 5})");
  EXPECT_TRUE(holds(laser.objects.at(0).unused, {"1 lights of an unknown"}));
  EXPECT_TRUE(holds(laser.warnings.at(0), {"not used", "lights of an unknown type (1)"}));
  const Scene dark = lit(R"({"type": "point", "intensity": -5})");
  EXPECT_EQ(dark.warnings.size(), sound.warnings.size() + 1);
  EXPECT_TRUE(holds(dark.warnings.at(0), {"lights[0].intensity is -5", "from 0 to 1e+15"}));
}

TEST_F(GltfMaterials, QuantisedPositionsAreTheNumbersTheyStandFor) {
  const std::string required = R"(, "extensionsUsed": ["KHR_mesh_quantization"],
      "extensionsRequired": ["KHR_mesh_quantization"])";
  const auto area = [&](const std::string& accessor) {
    return read("{}", required, "", "", accessor).objects.at(0).area_m2;
  };
  EXPECT_DOUBLE_EQ(area(R"("bufferView": 1, "componentType": 5122, "normalized": true)"), 0.5);
  EXPECT_DOUBLE_EQ(area(R"("bufferView": 2, "componentType": 5120)"), 0.5 * 100 * 100);
}

}  // namespace
}  // namespace earthshine::scenes
