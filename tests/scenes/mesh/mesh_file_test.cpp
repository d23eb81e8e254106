// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh/mesh_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "tests/scenes/scene_text.h"

namespace earthshine::scenes {
namespace {

using test::holds;

const std::string head = "format = 1\n[[material]]\nname = \"m\"\ndiffuse = 0.5\n";

std::string object(const std::string& mesh, const std::string& more = "material = \"m\"\n") {
  return head + "[[object]]\nname = \"o\"\nmesh = \"" + mesh + "\"\n" + more;
}

// A square pyramid: a quad and four triangles, with area 4 + 4 sqrt(2).
const std::vector<Vec3> pyramid{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 1}};
const std::vector<std::vector<int>> faces{{3, 2, 1, 0}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
const double pyramid_area = 4 + 4 * std::sqrt(2.0);

template <class T>
std::string raw(T value, bool big_endian = false) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  if (big_endian) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

std::string obj_pyramid() {
  std::string text;
  for (const Vec3& v : pyramid) {
    text +=
        "v " + std::to_string(v.x) + " " + std::to_string(v.y) + " " + std::to_string(v.z) + "\n";
  }
  for (const auto& face : faces) {
    text += "f";
    for (const int i : face) text += " " + std::to_string(i + 1);
    text += "\n";
  }
  return text;
}

std::string ply_pyramid(const std::string& format) {
  std::string bytes = "ply\nformat " + format +
                      " 1.0\ncomment end_header is below\nelement vertex 5\nproperty float x\n"
                      "property float y\nproperty float z\nproperty uchar red\nelement face 5\n"
                      "property list uchar int vertex_indices\nend_header\n";
  if (format == "ascii") {
    for (const Vec3& v : pyramid) {
      bytes +=
          std::to_string(v.x) + " " + std::to_string(v.y) + " " + std::to_string(v.z) + " 255\n";
    }
    for (const auto& face : faces) {
      bytes += std::to_string(face.size());
      for (const int i : face) bytes += " " + std::to_string(i);
      bytes += "\n";
    }
    return bytes;
  }
  const bool big = format == "binary_big_endian";
  for (const Vec3& v : pyramid) {
    for (int c = 0; c < 3; ++c) bytes += raw(static_cast<float>(v[c]), big);
    bytes += '\x7f';
  }
  for (const auto& face : faces) {
    bytes += static_cast<char>(face.size());
    for (const int i : face) bytes += raw(static_cast<std::int32_t>(i), big);
  }
  return bytes;
}

std::string stl_pyramid(bool ascii) {
  const std::vector<std::vector<int>> triangles{{3, 2, 1}, {3, 1, 0}, {0, 1, 4},
                                                {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  std::string bytes =
      ascii ? "solid pyramid\n" : "solid in name only" + std::string(62, ' ') + raw(6U);
  for (const auto& t : triangles) {
    bytes += ascii ? "facet normal 0 0 0\nouter loop\n" : std::string(12, '\0');
    for (const int i : t) {
      const Vec3& v = pyramid[static_cast<std::size_t>(i)];
      if (ascii) bytes += "vertex";
      for (int c = 0; c < 3; ++c)
        bytes += ascii ? " " + std::to_string(v[c]) : raw(static_cast<float>(v[c]));
      if (ascii) bytes += "\n";
    }
    bytes += ascii ? std::string("endloop\nendfacet\n") : std::string(2, '\0');
  }
  return bytes + (ascii ? "endsolid pyramid\n" : "");
}

TEST(MeshFile, EveryFormatGivesTheSamePyramid) {
  const test::SceneFolder folder;
  folder.put("a.obj", obj_pyramid());
  folder.put("b.ply", ply_pyramid("ascii") + "\n\x1a");  // end of text in old programs
  folder.put("c.ply", ply_pyramid("binary_little_endian"));
  folder.put("d.ply", ply_pyramid("binary_big_endian"));
  folder.put("e.STL", stl_pyramid(true));
  folder.put("f.stl", stl_pyramid(false));
  for (const std::string name : {"a.obj", "b.ply", "c.ply", "d.ply", "e.STL", "f.stl"}) {
    const Scene scene = folder.read(object(name));
    EXPECT_NEAR(scene.objects.at(0).area_m2, pyramid_area, 1e-6) << name;
    EXPECT_EQ(scene.objects.at(0).triangle_count, 6U) << name;
    EXPECT_EQ(scene.objects.at(0).source, name);
    EXPECT_EQ(scene.objects.at(0).unused, name.ends_with(".ply") ? "5 red" : "");
    double volume = 0.0;
    for (const Triangle& t : scene.triangles) {
      const auto& v = scene.vertices;
      volume += glm::dot(v[t.vertex[0]], glm::cross(v[t.vertex[1]], v[t.vertex[2]])) / 6.0;
    }
    EXPECT_NEAR(volume, 4.0 / 3.0, 1e-6) << name;
  }
}

TEST(MeshFile, UnitScaleRotateAndTranslateApplyToMeshes) {
  const test::SceneFolder folder;
  folder.put("a.obj", obj_pyramid());
  const Scene scene =
      folder.read("unit = \"ft\"\n" + object("a.obj",
                                             "material = \"m\"\nscale = [1, 1, 2]\n"
                                             "rotate = [180, 0, 0]\ntranslate = [0, 0, 5]\n"));
  double low = 1e9;
  for (const Vec3& v : scene.vertices) low = std::min(low, v.z);
  EXPECT_NEAR(low, 3 * 0.3048, 1e-12);  // the tip, 2 ft below 5 ft
}

TEST(ObjFile, PartsAreGroupsAndObjects) {
  const test::SceneFolder folder;
  folder.put("a.obj",
             "o thing\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\ng left common\nf 1 2 3\ng right "
             "common\nf 1 2 4\n"
             "f 1 3 4\no other\ng\nf 2 3 4\n");
  const auto triangles = [&](const std::string& part) {
    return folder.read(object("a.obj", "material = \"m\"\npart = \"" + part + "\"\n"))
        .triangles.size();
  };
  EXPECT_EQ(triangles("left"), 1U);
  EXPECT_EQ(triangles("right"), 2U);
  EXPECT_EQ(triangles("common"), 3U);
  EXPECT_EQ(triangles("thing"), 3U);
  EXPECT_EQ(triangles("other"), 1U);
  EXPECT_TRUE(holds(folder.refusal(object("a.obj", "material = \"m\"\npart = \"rigth\"\n")),
                    {"scene.toml:9:1", "no part \"rigth\"", "left", "Did you mean \"right\"?"}));
}

TEST(ObjFile, MaterialsComeFromTheSceneThenFromTheLibrary) {
  const test::SceneFolder folder;
  folder.put("a.obj",
             "mtllib lib/a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\nusemtl red paint\nf "
             "1 2 3\n");
  folder.put(
      "lib/a.mtl",
      "newmtl m\nKd 0 0 0\nnewmtl red paint\nKa 20 20 20\nKd 0.5 0.1 0.1\nKs 0.2 0.2 0.2\nNs 30\n"
      "Ke 3 2 1\nTf 1 1 1\nd 1.0\n");
  const Scene scene = folder.read(object("a.obj", ""));
  EXPECT_EQ(scene.materials.at(scene.triangles[0].material).diffuse, Rgb(0.5));
  const Material& red = scene.materials.at(scene.triangles[1].material);
  EXPECT_EQ(red.name, "red paint");
  EXPECT_EQ(red.diffuse, Rgb(0.5, 0.1, 0.1));
  EXPECT_EQ(red.specular, Rgb(0.2));
  EXPECT_EQ(red.shininess, 30.0);
  EXPECT_EQ(red.emit, Rgb(3, 2, 1));
  EXPECT_EQ(red.light_group, "red paint");
  // The object's `material` has priority.
  for (const Triangle& t : folder.read(object("a.obj")).triangles) EXPECT_EQ(t.material, 0U);
}

TEST(ObjFile, ReadsWhatExportersWrite) {
  const test::SceneFolder folder;
  folder.put("a.obj",
             "# comment\r\ng a#1\r\nv 0 0 0 1.0\r\nv +1 0 0 0.5 0.5 0.5\r\nv 0 1e0 0\r\nvn 0 0 "
             "1\r\nvt 0 0\r\n"
             "s off\r\nl 1 2\r\nf 1/1/1 2//1 \\\r\n  -1/1 # rest\r\nfancy 1\r\nfancy 2\r\n");
  const Scene scene = folder.read(object("a.obj", "material = \"m\"\npart = \"a#1\"\n"));
  EXPECT_DOUBLE_EQ(scene.objects.at(0).area_m2, 0.5);
  ASSERT_EQ(scene.warnings.size(), 1U);
  EXPECT_TRUE(holds(scene.warnings[0], {"a.obj:12:1", "\"fancy\""}));
}

TEST(ObjFile, DegenerateFacesAreLeftOutAndCountedOnce) {
  const test::SceneFolder folder;
  folder.put("a.obj",
             "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 1 2\nf 1 2 2 1\nf "
             "1 5 5 2\n");
  const Scene scene = folder.read(object("a.obj"));
  EXPECT_EQ(scene.objects.at(0).degenerate_count, 3U);
  EXPECT_EQ(scene.objects.at(0).polygon_count, 2U);
  ASSERT_EQ(scene.warnings.size(), 1U);
  EXPECT_TRUE(holds(scene.warnings[0], {"\"o\"", "3 of 5", "a.obj:7"}));
  EXPECT_TRUE(holds(folder.refusal(object("a.obj", "material = \"m\"\npart = \"p\"\n")),
                    {"no named parts"}));
}

struct Broken {
  std::string file, bytes;
  std::vector<std::string> message;
};

TEST(MeshFile, BrokenMeshesAreRefusedWithTheirPlace) {
  const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  const std::string mtl = "mtllib a.mtl\n" + three + "usemtl x\nf 1 2 3\n";
  std::string short_stl = stl_pyramid(false);
  short_stl.pop_back();
  std::string nan_stl = stl_pyramid(false);
  nan_stl.replace(96, 4, raw(std::nanf("")));
  std::string bad_ply = ply_pyramid("binary_little_endian");
  bad_ply[bad_ply.size() - 3] = '\x01';
  const std::vector<Broken> all{
      {"a.obj", three + "f 1 2 4\n", {"a.obj:4:7", "index 4 is out of range", "1 to 3"}},
      {"a.obj", three + "f 1 2 0\n", {"a.obj:4:7", "index 0"}},
      {"a.obj", three + "f 1 2 -4\n", {"a.obj:4:7", "index -4"}},
      {"a.obj", three + "f 1 2 99999999999999999999\n", {"a.obj:4:7"}},
      {"a.obj", three + "f 1 2 3/1/1/1\n", {"a.obj:4:7", "v/vt/vn"}},
      {"a.obj", three + "f 1 2 x\n", {"a.obj:4:7", "\"x\""}},
      {"a.obj", three + "f 1 2\n", {"a.obj:4:1", "a face of 2 corners"}},
      {"a.obj", "v 0 nan 0\n", {"a.obj:1:5", "nan"}},
      {"a.obj", "v 0 0 inf\n", {"a.obj:1:7", "inf"}},
      {"a.obj", "v 0 0 1e300\n", {"a.obj:1:7", "1e300"}},
      {"a.obj", "v 0 0 1e999\n", {"a.obj:1:7", "1e999"}},
      {"a.obj", "v 0 0\n", {"a.obj:1", "2 numbers"}},
      {"a.obj", "v 0 0 1x\n", {"a.obj:1:7", "not a number"}},
      {"a.obj", std::string("v 0 \0 0\n", 8), {"a.obj:1:5", "NUL"}},
      {"a.obj", three, {"a.obj", "no faces"}},
      {"a.obj",
       "mtllib ../../x.mtl\n" + three + "f 1 2 3\n",
       {"a.obj:1:8", "leads out of the scene's folder"}},
      {"a.obj", "mtllib /etc/passwd\n", {"a.obj:1:8", "not relative"}},
      {"a.obj", "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 4\n", {"a.obj:5", "crosses itself"}},
      {"a.obj",
       "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n",
       {"scene.toml:5:1", "no surface", "without area"}},
      {"b.ply", "not ply\n", {"b.ply", "not a PLY file"}},
      {"b.ply",
       ply_pyramid("ascii").substr(0, ply_pyramid("ascii").size() - 3),
       {"b.ply:21", "the file ends"}},
      {"b.ply", bad_ply, {"b.ply", "index", "out of range"}},
      {"b.ply",
       "ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nend_header\n1\n",
       {"b.ply", "4000000000"}},
      {"b.ply",
       ply_pyramid("ascii") + "\n3 0 1 2\n",
       {"b.ply:23", "goes on behind its last number", "5 of \"face\""}},
      {"b.ply", ply_pyramid("binary_big_endian") + "\x03", {"b.ply", "goes on behind"}},
      {"b.ply", "ply\nformat ascii 2.0\nend_header\n", {"b.ply:2", "and 1.0"}},
      {"c.stl",
       stl_pyramid(true).substr(0, stl_pyramid(true).find("endsolid")),
       {"c.stl:43", "ends within a solid", "\"endsolid\" is wanted", "cut off"}},
      {"c.stl",
       "solid x\nfacet normal 0 0 1\nouter loop\nvertex 1\n",
       {"c.stl:4", "\"vertex\" has 1 numbers", "at least 3"}},
      {"c.stl", short_stl, {"c.stl", "6 triangles", "84 + 50 n"}},
      {"c.stl", nan_stl, {"c.stl, triangle 1", "nan"}},
      {"c.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 1 2 nan\n", {"c.stl:4:12", "nan"}},
      {"c.stl", "solid x\nfacet normal 0 0 1\nvertex 1 2 3\n", {"c.stl:3:1", "outer"}}};
  const test::SceneFolder folder;
  for (const Broken& broken : all) {
    folder.put(broken.file, broken.bytes);
    const std::string refusal = folder.refusal(object(broken.file));
    EXPECT_TRUE(holds(refusal, broken.message));
    EXPECT_EQ(refusal == "was not refused", broken.message.empty())
        << broken.file << " " << refusal;
  }
  folder.put("a.obj", mtl);
  EXPECT_TRUE(holds(folder.refusal(object("a.obj", "")), {"a.obj:1:8", "a.mtl", "No such file"}));
  folder.put("a.mtl", "newmtl y\n");
  EXPECT_TRUE(holds(folder.refusal(object("a.obj", "")),
                    {"a.obj:6", "\"x\"", "is not defined", "m, y", "Add [[material]]"}));
  folder.put("a.mtl", "newmtl x\nKd 0.9 2 0.9\n");
  EXPECT_TRUE(holds(folder.refusal(object("a.obj", "")), {"a.mtl:2:4", "is 2", "from 0 to 1"}));
  folder.put("a.obj", three + "f 1 2 3\n");
  EXPECT_TRUE(
      holds(folder.refusal(object("a.obj", "")), {"scene.toml:5:1", "a.obj:4", "Add material"}));
}

TEST(ObjFile, ALinkDoesNotLeadOutOfTheFolder) {
  const test::SceneFolder folder;
  std::filesystem::create_directory_symlink("/etc", folder.path() / "link");
  folder.put("a.obj", "mtllib link/passwd\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl x\nf 1 2 3\n");
  EXPECT_TRUE(holds(folder.refusal(object("a.obj", "")), {"a.obj:1:8", "leads out"}));
}

}  // namespace
}  // namespace earthshine::scenes
