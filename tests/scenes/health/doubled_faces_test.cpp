// SPDX-License-Identifier: Apache-2.0
// Duplicate faces at one place.
#include <fmt/format.h>

#include "scenes/health/mend.h"
#include "tests/scenes/cube_scenes.h"

namespace earthshine::scenes {
namespace {

using test::all;
using test::corners;
using test::cube;
using test::cube_obj;
using test::face;
using test::holds;
using test::none;
using test::read;
using test::scene_of;
using test::volume;
using test::warnings;

TEST(DoubledFaces, FacesThatStandTwiceAreKeptOnce) {
  // The same corners from another starting corner; as a quadrilateral, and the same again.
  const std::string quad = std::string(corners) + face(cube[0]);
  for (const int start : {0, 1, 2, 3}) {
    const Scene scene = read(quad + face(cube[0], false, start));
    EXPECT_EQ(scene.triangles.size(), 2U);
    EXPECT_EQ(scene.objects.front().polygon_count, 1U);
    EXPECT_NEAR(scene.objects.front().area_m2, 1.0, 1e-15);
    EXPECT_TRUE(holds(warnings(scene), {"\"body\"", "stood twice"})) << warnings(scene);
  }
}

TEST(DoubledFaces, BackToBackFacesAreOneSheet) {
  for (const int start : {0, 1, 2, 3}) {
    const Scene scene =
        read(std::string(corners) + face(cube[0]) + face(cube[0], true, start) + face(cube[1]));
    ASSERT_EQ(scene.triangles.size(), 4U);
    EXPECT_NEAR(scene.objects.front().area_m2, 2.0, 1e-15);
    EXPECT_TRUE(scene.materials[scene.triangles[0].material].two_sided);
    EXPECT_TRUE(scene.materials[scene.triangles[1].material].two_sided);
    EXPECT_FALSE(scene.materials[scene.triangles[2].material].two_sided);
    EXPECT_EQ(scene.materials[scene.triangles[0].material].diffuse, Rgb(0.5));
    EXPECT_TRUE(holds(warnings(scene), {"back to back", "two-sided"})) << warnings(scene);
  }
}

TEST(DoubledFaces, FacesOfOtherMaterialsOnEachOtherAreNamedAndLeft) {
  const std::string red = "[[object]]\nname = \"paint\"\nmesh = \"b.obj\"\nmaterial = \"red\"\n";
  const std::string quad = std::string(corners) + face(cube[0]);
  const Scene scene = read(quad, scene_of(red), quad);
  EXPECT_EQ(scene.triangles.size(), 4U);
  EXPECT_TRUE(
      holds(warnings(scene), {"\"body\"", "\"paint\"", "1 m2", "those of \"paint\" are seen"}))
      << warnings(scene);
}

// Two adjacent cubes have opposite faces at x = 1: total volume 2, no warning.
TEST(DoubledFaces, BodiesMayTouch) {
  for (const char* material : {"white", "red"}) {
    const std::string beside = fmt::format(
        "[[object]]\nname = \"beside\"\nmesh = \"b.obj\"\ntranslate = [1, 0, 0]\n"
        "material = \"{}\"\n",
        material);
    const Scene scene = read(cube_obj(none), scene_of(beside), cube_obj(none));
    EXPECT_EQ(warnings(scene), "");
    EXPECT_EQ(scene.triangles.size(), 24U);
    EXPECT_NEAR(volume(scene), 2.0, 1e-15);
  }
}

// A body whose faces all exist with both windings has no inside: six sheets.
TEST(DoubledFaces, ABodyWithBothWindingsIsOfSheets) {
  std::string obj = cube_obj(none);
  for (const auto& f : cube) obj += face(f, true, 1);
  const Scene scene = read(obj);
  EXPECT_EQ(scene.triangles.size(), 12U);
  for (const Triangle& triangle : scene.triangles) {
    EXPECT_TRUE(scene.materials[triangle.material].two_sided);
  }
  EXPECT_TRUE(holds(warnings(scene), {"6 faces stood back to back"})) << warnings(scene);
}

// Two sides of a panel may be two objects; each is visible from its front, with a warning.
TEST(DoubledFaces, BackToBackObjectsStayTwo) {
  const std::string quad = std::string(corners) + face(cube[0]);
  const std::string back = std::string(corners) + face(cube[0], true);
  const std::string two = "[[object]]\nname = \"back\"\nmesh = \"b.obj\"\nmaterial = \"red\"\n";
  const Scene scene = read(quad, scene_of(two), back);
  EXPECT_EQ(scene.triangles.size(), 4U);
  EXPECT_TRUE(holds(warnings(scene), {"\"body\"", "\"back\"", "1 m2", "back to back"}))
      << warnings(scene);
  const std::string meant = two + "orient = \"as-is\"\n";
  EXPECT_EQ(warnings(read(quad, scene_of("orient = \"as-is\"\n" + meant), back)), "");
}

// The neighbour's face at x = 1 duplicates its own while the body is inside out.
TEST(DoubledFaces, ABodyInsideOutThatTouchesAnotherIsTurned) {
  const std::string beside =
      "[[object]]\nname = \"beside\"\nmesh = \"b.obj\"\ntranslate = [1, 0, 0]\nmaterial = "
      "\"white\"\n";
  const Scene scene = read(cube_obj(none), scene_of(beside), cube_obj(all));
  EXPECT_EQ(scene.triangles.size(), 24U);
  EXPECT_NEAR(volume(scene), 2.0, 1e-15);
  EXPECT_EQ(scene.warnings.size(), 1U) << warnings(scene);
}

// A front and a back with different diagonals enclose no volume except rounding: neither is inside
// out.
TEST(DoubledFaces, ASheetOfTwoColoursKeepsItsSides) {
  const std::string sheet = std::string(corners) + "f 1 3 4 2\nf 1 2 3\nf 3 2 4\n";
  for (const char* turn : {"[10, 20, 30]", "[71, 12, 55]", "[33, 0, 7]"}) {
    const Scene scene = read(sheet, scene_of(std::string("rotate = ") + turn + "\n"));
    EXPECT_EQ(scene.triangles.size(), 4U);
    EXPECT_EQ(warnings(scene), "") << turn;
    EXPECT_EQ(scene.objects.front().surface.inward_parts, 0U);
  }
}

TEST(DoubledFaces, AnObjectThatStandsTwiceIsRefused) {
  const std::string again =
      "[[object]]\nname = \"again\"\nmesh = \"b.obj\"\nmaterial = \"white\"\n";
  const test::SceneFolder folder;
  folder.put("a.obj", cube_obj(none));
  folder.put("b.obj", cube_obj(none));
  EXPECT_TRUE(holds(folder.refusal(scene_of(again)), {"\"again\"", "same place", "Remove"}));
}

// Four corners in another order enclose another area: the halves of a bow tie are not the
// quadrilateral.
TEST(DoubledFaces, TheSameCornersAreNotYetTheSameFace) {
  const std::string fan = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 1 0.5 0\n";
  const Scene scene = read(fan + "f 1 2 3 4 5\nf 1 5 2 3 4\n");
  EXPECT_EQ(scene.objects.front().polygon_count, 2U);
  EXPECT_EQ(warnings(scene).find("stood"), std::string::npos) << warnings(scene);
}

}  // namespace
}  // namespace earthshine::scenes
