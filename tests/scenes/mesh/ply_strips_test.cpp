// SPDX-License-Identifier: Apache-2.0
// PLY files with triangle strips, as used by Stanford's scans.
#include <gtest/gtest.h>

#include "scenes/mesh/ply_file.h"
#include "tests/scenes/scene_text.h"

namespace earthshine::scenes {
namespace {

using Strip = std::vector<std::int64_t>;

struct Format {
  const char* encoding = "ascii";
  const char* count = "int";
  const char* index = "int";
};

std::size_t bytes_of(const std::string& type) {
  if (type.find("8") != std::string::npos || type.ends_with("char")) return 1;
  return type.find("16") != std::string::npos || type.ends_with("short") ? 2 : 4;
}

void put(std::string& out, const Format& format, const std::string& type, std::int64_t value) {
  if (std::string(format.encoding) == "ascii") {
    out += std::to_string(value) + " ";
    return;
  }
  std::string raw;
  for (std::size_t k = 0; k < bytes_of(type); ++k) raw += static_cast<char>(value >> (8 * k));
  if (std::string(format.encoding) == "binary_big_endian") raw = {raw.rbegin(), raw.rend()};
  out += raw;
}

// Vertices (x, y, 0) at integer x and y, two per column: 0 (0,0), 1 (0,1), 2 (1,0), 3 (1,1), 4
// (2,0) ...
std::string ply(const Format& format, const std::vector<Strip>& strips, int vertices = 8,
                const std::string& faces = "") {
  std::string text = std::string("ply\nformat ") + format.encoding + " 1.0\nelement vertex " +
                     std::to_string(vertices) +
                     "\nproperty short x\nproperty short y\nproperty short z\n" + faces +
                     "element tristrips " + std::to_string(strips.size()) + "\nproperty list " +
                     format.count + " " + format.index + " vertex_indices\nend_header\n";
  for (int k = 0; k < vertices; ++k) {
    for (const int x : {k / 2, k % 2, 0}) put(text, format, "short", x);
  }
  if (!faces.empty()) text += "3 0 2 1\n";
  for (const Strip& strip : strips) {
    put(text, format, format.count, static_cast<std::int64_t>(strip.size()));
    for (const std::int64_t index : strip) put(text, format, format.index, index);
    if (std::string(format.encoding) == "ascii") text += "\n";
  }
  return text;
}

// Total area, if every triangle faces up; triangles in z = 0 are counter-clockwise from above.
double area_facing_up(const Mesh& mesh) {
  double area = 0.0;
  for (const MeshPolygon& polygon : mesh.polygons) {
    EXPECT_EQ(polygon.count, 3U);
    const auto corner = [&](std::uint32_t k) {
      return mesh.vertices[mesh.indices[polygon.first + k]];
    };
    const double twice = glm::cross(corner(1) - corner(0), corner(2) - corner(0)).z;
    EXPECT_GT(twice, 0.0);
    area += 0.5 * twice;
  }
  return area;
}

const Format formats[] = {{"ascii", "int", "int"},
                          {"ascii", "uchar", "int"},
                          {"binary_little_endian", "int", "int"},
                          {"binary_little_endian", "uint8", "int16"},
                          {"binary_little_endian", "uint8", "int8"},
                          {"binary_little_endian", "ushort", "uint"},
                          {"binary_big_endian", "int", "int"},
                          {"binary_big_endian", "uint8", "uint16"}};

// Two separate unit squares in one list with -1 between them: 2 m2 in four triangles.
TEST(PlyStrips, MinusOneBeginsANewStrip) {
  for (const Format& format : formats) {
    const Mesh mesh = parse_ply(ply(format, {{0, 2, 1, 3, -1, 4, 6, 5, 7}}), "a.ply");
    EXPECT_EQ(mesh.polygons.size(), 4U) << format.encoding << format.index;
    EXPECT_DOUBLE_EQ(area_facing_up(mesh), 2.0) << format.encoding << format.index;
    EXPECT_TRUE(mesh.unused.empty());
  }
}

// A strip of n corners has n - 2 triangles; the winding alternates and restarts with each strip.
TEST(PlyStrips, EveryTriangleHasTheWindingOfTheFirst) {
  const Mesh band = parse_ply(ply({}, {{0, 2, 1, 3, -1, 2, 4, 3, 5}, {4, 6, 5, 7}}), "a.ply");
  EXPECT_EQ(band.polygons.size(), 6U);
  EXPECT_DOUBLE_EQ(area_facing_up(band), 3.0);
  const Mesh odd = parse_ply(ply({}, {{0, 2, 1, -1, 2, 4, 3, 5}}), "a.ply");
  EXPECT_DOUBLE_EQ(area_facing_up(odd), 1.5);
  const Mesh whole = parse_ply(ply({}, {{0, 2, 1, 3}, {3, 2, 5, 4}}), "a.ply");
  EXPECT_EQ(whole.polygons.size(), 4U);
  EXPECT_DOUBLE_EQ(area_facing_up(whole), 2.0);
}

// Repeated corners also join strips: their triangles have no area, and the parity continues.
TEST(PlyStrips, TrianglesWithACornerTwiceJoinStrips) {
  const Mesh mesh = parse_ply(ply({}, {{0, 2, 1, 3, 3, 4, 4, 6, 5, 7}}), "a.ply");
  EXPECT_EQ(mesh.polygons.size(), 4U);
  EXPECT_DOUBLE_EQ(area_facing_up(mesh), 2.0);
}

TEST(PlyStrips, EmptyAndShortStripsHaveNoTriangles) {
  const Mesh mesh = parse_ply(ply({}, {{}, {-1}, {0, 2}, {-1, -1, 0, 2, 1, -1}, {5}}), "a.ply");
  EXPECT_EQ(mesh.polygons.size(), 1U);
  EXPECT_DOUBLE_EQ(area_facing_up(mesh), 0.5);
}

TEST(PlyStrips, FacesAndStripsAddUp) {
  const Mesh mesh = parse_ply(
      ply({}, {{1, 2, 3}}, 8, "element face 1\nproperty list uchar int vertex_indices\n"), "a.ply");
  EXPECT_EQ(mesh.polygons.size(), 2U);
  EXPECT_DOUBLE_EQ(area_facing_up(mesh), 1.0);
}

// In an unsigned type 255 is a vertex if there are so many.
TEST(PlyStrips, TheLargestNumberIsAVertexIfThereIsOne) {
  const Format format{"binary_little_endian", "int", "uint8"};
  EXPECT_EQ(parse_ply(ply(format, {{0, 2, 1, 255, 0, 2, 1}}), "a.ply").polygons.size(), 2U);
  EXPECT_EQ(parse_ply(ply(format, {{253, 255, 254}}, 256), "a.ply").polygons.size(), 1U);
}

TEST(PlyStrips, BrokenStripsAreRefusedWithTheirPlace) {
  const auto refusal = [](const std::string& text) {
    return test::error_of(base::Blame::Input, [&] { static_cast<void>(parse_ply(text, "a.ply")); });
  };
  EXPECT_TRUE(test::holds(refusal(ply({}, {{0, 2, 8}})), {"a.ply:10", "index 8", "out of range"}));
  EXPECT_TRUE(test::holds(refusal(ply({}, {{0, 2, -2}})), {"a.ply:10", "index -2"}));
  const std::string whole = ply({"binary_little_endian", "int", "int"}, {{0, 2, 1, 3}});
  EXPECT_TRUE(test::holds(refusal(whole.substr(0, whole.size() - 3)), {"ends before its last"}));
}

// 2 m2 in the scene of the case; for a mesh without faces the error names its contents.
TEST(PlyStrips, SceneReadsThem) {
  const test::SceneFolder folder;
  const std::string toml =
      "format = 1\n[[material]]\nname = \"w\"\ndiffuse = 0.5\n[[object]]\nname = \"o\"\nmesh = "
      "\"m.ply\"\nmaterial = \"w\"\n";
  folder.put("m.ply", ply({"binary_little_endian", "int", "int"}, {{0, 2, 1, 3, -1, 4, 6, 5, 7}}));
  EXPECT_DOUBLE_EQ(folder.read(toml).objects.at(0).area_m2, 2.0);
  folder.put(
      "m.ply",
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty "
      "float z\nelement edge 2\nproperty int vertex1\nend_header\n0 0 0\n0\n0\n");
  EXPECT_TRUE(test::holds(folder.refusal(toml), {"m.ply", "no faces", "it holds 2 edge"}));
}

}  // namespace
}  // namespace earthshine::scenes
