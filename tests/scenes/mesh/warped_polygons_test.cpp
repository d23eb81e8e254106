// SPDX-License-Identifier: Apache-2.0
// Non-planar polygons of any shape: triangulated with a warning.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "scenes/mesh/triangulate.h"
#include "scenes/ray_query.h"
#include "tests/scenes/scene_text.h"

namespace earthshine::scenes {
namespace {

using test::holds;

constexpr const char* toml =
    "format = 1\n[[material]]\nname = \"w\"\ndiffuse = 0.5\n[[object]]\nname = \"o\"\nmesh = "
    "\"m.obj\"\nmaterial = \"w\"\n";

Scene read(const std::string& obj, const std::string& more = "") {
  const test::SceneFolder folder;
  folder.put("m.obj", obj);
  return folder.read(toml + more);
}

double area_of(const Scene& scene) {
  double area = 0.0;
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) area += triangle_area(scene, t);
  return area;
}

// (0,0,0) (1,0,0) (1,1,h) (0,1,0) divided by the diagonal 1-3: two triangles of sqrt(1 + h^2) / 2
// each. The projection along the normal has sqrt(1 + h^2 / 2).
TEST(WarpedPolygons, AQuadIsCutAlongTheDiagonalOfItsFirstCorner) {
  for (const double h : {0.5, 1.0, 2.0, -0.5}) {
    const Scene scene =
        read("v 0 0 0\nv 1 0 0\nv 1 1 " + std::to_string(h) + "\nv 0 1 0\nf 1 2 3 4\n");
    const double exact = std::sqrt(1.0 + h * h);
    ASSERT_EQ(scene.triangles.size(), 2U);
    EXPECT_NEAR(area_of(scene), exact, 1e-12);  // 1.1180 for h = 0.5
    EXPECT_NEAR(scene.objects.at(0).area_m2, exact, 1e-12);
    ASSERT_EQ(scene.warnings.size(), 1U);
    const double percent = 100.0 * (exact / std::sqrt(1.0 + 0.5 * h * h) - 1.0);
    const std::string text = fmt::format("up to {:.3g} %", percent);
    EXPECT_TRUE(holds(scene.warnings[0], {"\"o\"", "1 of 1", text, "m.obj:5"}));
  }
}

// For any position, unit, winding and first corner.
TEST(WarpedPolygons, TheAreaIsThatOfOneOfTheTwoCuts) {
  const Vec3 corners[] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}, {0, 1, 0}};
  for (const double scale : {1e-3, 1.0, 1e4}) {
    for (std::size_t first = 0; first < 4; ++first) {
      for (const bool back : {false, true}) {
        std::string obj, face = "f";
        for (std::size_t k = 0; k < 4; ++k) {
          const Vec3 at = scale * corners[back ? (first + 4 - k) % 4 : (first + k) % 4];
          // An orthogonal transform preserves areas.
          obj += "v " + std::to_string(0.6 * at.x - 0.8 * at.z + 3 * scale) + " " +
                 std::to_string(at.y) + " " + std::to_string(0.8 * at.x + 0.6 * at.z) + "\n";
          face += " " + std::to_string(k + 1);
        }
        const double area = area_of(read(obj + face + "\n")) / (scale * scale);
        const double by_13 = std::sqrt(1.25), by_24 = 0.5 + 0.5 * std::sqrt(1.5);
        EXPECT_TRUE(std::abs(area - by_13) < 2e-3 || std::abs(area - by_24) < 2e-3) << area;
      }
    }
  }
}

TEST(WarpedPolygons, TheWorstOfManyIsNamed) {
  const Scene scene = read(
      "v 0 0 0\nv 1 0 0\nv 1 1 0.1\nv 0 1 0\nv 5 0 0\nv 6 0 0\nv 6 1 1\nv 5 1 0\nv 9 0 0\nv 10 0 "
      "0\n"
      "v 10 1 0\nv 9 1 0\nf 1 2 3 4\nf 5 6 7 8\nf 9 10 11 12\n");
  ASSERT_EQ(scene.warnings.size(), 1U);
  EXPECT_TRUE(holds(scene.warnings[0], {"2 of 3 polygons", "15.5 %", "the most at", "m.obj:14"}));
  EXPECT_EQ(scene.triangles.size(), 6U);
}

// A saddle of six corners, and a pentagon with one corner bent up.
TEST(WarpedPolygons, PolygonsOfMoreCornersAreCutToo) {
  std::string saddle, face = "f";
  for (int k = 0; k < 6; ++k) {
    const double angle = base::pi * k / 3.0;
    saddle += "v " + std::to_string(std::cos(angle)) + " " + std::to_string(std::sin(angle)) + " " +
              (k % 2 == 0 ? "0.6" : "-0.6") + "\n";
    face += " " + std::to_string(k + 1);
  }
  const Scene scene = read(saddle + face + "\n");
  EXPECT_EQ(scene.triangles.size(), 4U);
  EXPECT_GT(area_of(scene), 1.5 * std::sqrt(3.0));  // more than the flat hexagon's
  EXPECT_EQ(scene.warnings.size(), 1U);
  const Scene bent = read("v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 2 1\nv 0 1 0\nf 1 2 3 4 5\n");
  EXPECT_EQ(bent.triangles.size(), 3U);
  EXPECT_EQ(bent.warnings.size(), 1U);
}

// Folded so far that its projected edges cross, or that it has no normal: the edges do not meet in
// space, and it is divided by the diagonal of smaller area.
TEST(WarpedPolygons, AQuadThatCrossesOnlyInItsProjectionIsCut) {
  const std::vector<Vec3> folded[] = {{{0, 0, 0}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}},
                                      {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, 1, 0.5}}};
  for (const std::vector<Vec3>& corners : folded) {
    Triangulation pieces;
    triangulate(corners, 1e-12, pieces);
    ASSERT_EQ(pieces.kind, PolygonKind::Sound);
    ASSERT_EQ(pieces.triangles.size(), 2U);
    const auto cut = [&](std::size_t k) {
      const auto half = [&](std::size_t a, std::size_t b, std::size_t c) {
        return 0.5 * glm::length(glm::cross(corners[b] - corners[a], corners[c] - corners[a]));
      };
      return half(k, k + 1, (k + 2) % 4) + half(k, (k + 2) % 4, (k + 3) % 4);
    };
    EXPECT_NEAR(pieces.triangle_area, std::min(cut(0), cut(1)), 1e-12);
  }
}

}  // namespace
}  // namespace earthshine::scenes
