// SPDX-License-Identifier: Apache-2.0
// Conversion of the lines of an MTL file.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/files/png_file.h"
#include "scenes/mesh/mesh_file.h"
#include "scenes/mesh/obj_file.h"
#include "scenes/texture/texture.h"
#include "tests/scenes/scene_text.h"

namespace earthshine::scenes {
namespace {

using test::holds;

Material material_of(const std::string& lines) {
  Mesh mesh;
  parse_mtl("newmtl m\n" + lines, "a.mtl", {}, mesh);
  EXPECT_EQ(mesh.warnings.size(), 0U);
  return mesh.materials.at(0);
}

TEST(MtlMaterials, ModelsWithoutHighlightHaveNone) {
  for (const int model : {0, 1}) {
    const Material plain = material_of(fmt::format("Kd 0.5\nKs 0.3\nNs 20\nillum {}\n", model));
    EXPECT_EQ(plain.diffuse, Rgb(0.5));
    EXPECT_EQ(plain.specular, Rgb(0.0));
  }
  EXPECT_EQ(material_of("Kd 0.5\nKs 0.3\nNs 20\nillum 2\n").specular, Rgb(0.3));
}

TEST(MtlMaterials, ModelsThatReflectHaveTheAlbedoKs) {
  const Material satin = material_of("Ks 0.3\nNs 20\nillum 3\n");
  EXPECT_NEAR(satin.specular.r * 2.0 / (satin.shininess + 2.0), 0.3, 1e-12);
  EXPECT_EQ(satin.mirror, Rgb(0.0));
  for (const std::string sharp : {"", "Ns 1000\n"}) {
    const Material mirror = material_of("Ks 0.3\n" + sharp + "illum 5\n");
    EXPECT_EQ(mirror.mirror, Rgb(0.3));
    EXPECT_EQ(mirror.specular, Rgb(0.0));
  }
}

TEST(MtlMaterials, DissolveLetsThroughAndBendsOnlyWhereTheModelRefracts) {
  const Material pane = material_of("Kd 0.4\nKs 0.2\nd 0.25\nTr 0.1\nNi 1.5\nTf 1 0.5 0\n");
  EXPECT_EQ(pane.diffuse, Rgb(0.1));
  EXPECT_EQ(pane.specular, Rgb(0.05));
  EXPECT_EQ(pane.transmit, Rgb(0.75, 0.375, 0.0));
  EXPECT_EQ(pane.ior, 1.0);
  EXPECT_EQ(material_of("Kd 0.4\nTr 0.75\n").transmit, Rgb(0.75));
  EXPECT_EQ(material_of("Ks 0.4\nd 0.25\nillum 5\n").mirror, Rgb(0.1));
  EXPECT_EQ(material_of("Ks 0.4\nNs 20\nd 0.25\nillum 3\n").specular, Rgb(0.1 * 11.0));
  for (const int model : {6, 7}) {
    EXPECT_EQ(material_of(fmt::format("d 0\nNi 1.5\nillum {}\n", model)).ior, 1.5);
  }
  const Material opaque = material_of("Kd 0.4\nd 1\nTf 1 1 1\nNi 1.5\nillum 4\n");
  EXPECT_EQ(opaque.transmit, Rgb(0.0));
}

TEST(MtlMaterials, WhatIsNotReadIsNamed) {
  Mesh mesh;
  parse_mtl("newmtl m\nd -halo 0.5\nTf xyz 1 1 1\nillum 10\nPr 0.5\nKa 1 1 1\nsharpness 60\n",
            "a.mtl", {}, mesh);
  ASSERT_EQ(mesh.warnings.size(), 1U);
  EXPECT_TRUE(holds(mesh.warnings[0], {"a.mtl", "\"d -halo\" (1)", "\"Tf xyz\" (1)",
                                       "\"illum 10\" (1)", "\"Pr\" (1)"}));
  EXPECT_EQ(mesh.unused.size(), 4U);
}

TEST(MtlMaterials, TexturesHaveTheirOptionsAndNamesWithBlanks) {
  const test::SceneFolder folder;
  const std::vector<std::uint8_t> grey(12, 188);
  base::write_png(folder.path() / "old wood.png", 2, 2, 3, grey);
  base::write_png(folder.path() / "edge.png", 2, 1, 1, std::vector<std::uint8_t>{0, 255});
  Mesh mesh;
  const std::filesystem::path folders[] = {folder.path()};
  parse_mtl(
      "newmtl m\nKd 0.5\nmap_Kd -s 2 4 1 -o 0.25 0.5 -clamp on old wood.png\nmap_Ke -mm 0 2 a.png\n"
      "newmtl n\nmap_Kd old wood.png\nmap_d -imfchan m old wood.png\n"
      "newmtl clamped\nmap_Kd -clamp on edge.png\nnewmtl repeated\nmap_Kd -clamp off edge.png\n",
      folder.path() / "a.mtl", folders, mesh);
  ASSERT_EQ(mesh.warnings.size(), 1U);  // only for map_Ke: every texture was read
  const TextureMap& map = mesh.materials.at(0).maps->diffuse;
  EXPECT_EQ(map.texture->name(), "old wood.png");
  // v points up in the file and down here: (u, v) = (0.1, 0.2), w = 0.8, becomes u' = 0.25 + 0.2
  // and v' = 0.5 + 0.8, w' = 1 - v' = -0.3.
  const glm::dvec2 place = map.transform->apply({0.1, 0.8});
  EXPECT_NEAR(place.x, 0.45, 1e-12);
  EXPECT_NEAR(place.y, -0.3, 1e-12);
  EXPECT_TRUE(mesh.materials.at(1).has_holes());
  EXPECT_EQ(mesh.materials.at(1).diffuse, Rgb(1.0));  // a texture without its Kd
  // Three widths to the left: the black edge, or half way from the white edge to it.
  EXPECT_NEAR(mesh.materials.at(2).maps->diffuse.texture->at({-3.0, 0.5}).r, 0.0, 1e-9);
  EXPECT_NEAR(mesh.materials.at(3).maps->diffuse.texture->at({-3.0, 0.5}).r, 0.5, 1e-9);
  EXPECT_EQ(mesh.unused, (std::map<std::string, std::size_t>{{"map_Ke with options", 1}}));
}

TEST(MtlMaterials, ValuesOfTextureOptionsAreRefusedWhereTheyAreNone) {
  const auto refusal = [](const std::string& option) -> std::string {
    Mesh mesh;
    try {
      parse_mtl("newmtl m\nmap_Kd " + option + " a.png\n", "a.mtl", {}, mesh);
    } catch (const base::Error& error) {
      return error.what();
    }
    return "was not refused";
  };
  EXPECT_TRUE(holds(refusal("-s nan"), {"a.mtl:2:11", "\"nan\""}));
  EXPECT_TRUE(holds(refusal("-s abc"), {"a.mtl:2:11", "\"abc\" is not a number"}));
  EXPECT_TRUE(holds(refusal("-o 1 1e300"), {"a.mtl:2:13", "\"1e300\""}));
  EXPECT_TRUE(holds(refusal("-clamp yes"), {"a.mtl:2:15", "\"yes\"", "on and off"}));
  EXPECT_EQ(refusal("-s"), "was not refused");  // no value, and no file name
}

TEST(MtlMaterials, OfMaterialsOfOneNameTheFirstCounts) {
  Mesh mesh;
  parse_mtl("newmtl m\nKd 0.5\nnewmtl m\nKd 0.1\nmap_Kd\nnewmtl m\n", "a.mtl", {}, mesh);
  ASSERT_EQ(mesh.warnings.size(), 2U);
  EXPECT_TRUE(holds(mesh.warnings[0], {"a.mtl:3: the material \"m\" again, as at a.mtl:1",
                                       "(1 more such)", "the first is taken"}));
  EXPECT_TRUE(holds(mesh.warnings[1], {"\"map_Kd without a file\" (1)"}));
  parse_mtl("newmtl m\n", "b.mtl", {}, mesh);
  EXPECT_TRUE(holds(mesh.warnings.back(), {"b.mtl:1: the material \"m\" again, as at a.mtl:1"}));
  mesh.path = "a.obj";
  EXPECT_EQ(find_mesh_material(mesh, "m", {}), 0U);
}

TEST(MtlMaterials, OneNameInTwoLibrariesIsTwoMaterials) {
  const test::SceneFolder folder;
  for (const std::string name : {"a", "b", "c"}) {
    folder.put(name + ".obj", "mtllib " + name + ".mtl\nv 0 0 0\nv 1 0 0\nv 0 1 " +
                                  std::to_string(name[0]) + "\nusemtl x\nf 1 2 3\n");
    folder.put(name + ".mtl",
               name == "c" ? "newmtl x\nKd 0.1 0.1 0.1\n" : "newmtl x\nKd 0.2 0.2 0.2\n");
  }
  std::string text = "format = 1\n";
  for (const std::string name : {"a", "b", "c"}) {
    text += "[[object]]\nname = \"" + name + "\"\nmesh = \"" + name + ".obj\"\n";
  }
  const Scene scene = folder.read(text);
  ASSERT_EQ(scene.materials.size(), 2U);
  EXPECT_EQ(scene.triangles[0].material, scene.triangles[1].material);
  EXPECT_EQ(scene.materials[scene.triangles[2].material].diffuse, Rgb(0.1));
  EXPECT_NE(scene.materials[0].name, scene.materials[1].name);
}

TEST(MtlMaterials, CornersWithoutCoordinatesAreNamed) {
  const test::SceneFolder folder;
  base::write_png(folder.path() / "a.png", 1, 1, 3, std::vector<std::uint8_t>(3, 255));
  folder.put("a.obj",
             "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 0.5 0.25\nusemtl m\n"
             "f 1/-1 2/1 3/7\nf 3 2 1\nmtllib ./a.mtl\n");  // written with every object
  folder.put("a.mtl", "newmtl m\nKd 0.5\nmap_Kd a.png\n");
  const Scene scene =
      folder.read("format = 1\n[[object]]\nname = \"o\"\nmesh = \"a.obj\"\norient = \"as-is\"\n");
  ASSERT_EQ(scene.warnings.size(), 1U);
  EXPECT_TRUE(holds(scene.warnings[0], {"\"o\"", "4 corners", "the first at ", "a.obj:8;"}));
  const glm::vec2 uv = scene.vertex_uv.at(scene.triangles.at(0).vertex[0]);
  EXPECT_EQ(uv, glm::vec2(0.5F, 0.75F));
  EXPECT_EQ(scene.objects.at(0).unused, "");
}

TEST(MtlMaterials, MoreLightThanArrivesIsScaledAndSaid) {
  const test::SceneFolder folder;
  folder.put("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl bright\nf 1 2 3\n");
  folder.put("a.mtl", "newmtl bright\nKd 1\nKs 1\nNs 10\nnewmtl unworn\nKd 1\nKs 1\nNs 10\n");
  const Scene scene = folder.read("format = 1\n[[object]]\nname = \"o\"\nmesh = \"a.obj\"\n");
  const Material& bright = scene.materials.at(0);
  EXPECT_NEAR(bright.diffuse.g, 6.0 / 7.0, 1e-12);  // 1 + 2 / 12 = 7/6
  EXPECT_NEAR(bright.specular.g, 6.0 / 7.0, 1e-12);
  ASSERT_EQ(scene.warnings.size(), 1U);
  EXPECT_TRUE(holds(scene.warnings[0], {"a.mtl:1", "\"bright\"", "1.167"}));
}

}  // namespace
}  // namespace earthshine::scenes
