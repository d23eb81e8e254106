// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "scenes/health/mend.h"
#include "tests/scenes/scene_text.h"

namespace earthshine::scenes {
namespace {

Scene with_lamp_at(const std::string& height, const std::string& kind = "point",
                   const std::string& normal = "[0, 0, 1]") {
  const test::SceneFolder folder;
  const std::string place = " = [0.3, 0.4, " + height + "]\n";
  std::string size = "position" + place;
  if (kind == "disk") size = "center" + place + "normal = " + normal + "\nradius = 0.1\n";
  if (kind == "rectangle") {  // emits up along edge_u x edge_v, or down
    const std::string edge_v = normal == "[0, 0, 1]" ? "[0, 0.1, 0]" : "[0, -0.1, 0]";
    size = "center" + place + "edge_u = [0.1, 0, 0]\nedge_v = " + edge_v + "\n";
  }
  return folder.read(
      "format = 1\n[[material]]\nname = \"m\"\ndiffuse = 0.5\n[[light]]\nname = \"lamp\"\ntype = "
      "\"" +
      kind + "\"\n" + size +
      "flux = 1\n[[object]]\nname = \"floor\"\nshape = \"quad\"\ncorners = [[-3, -4, 0], [3, -4, "
      "0], "
      "[3, 4, 0], [-3, 4, 0]]\nmaterial = \"m\"\n");
}

// For faces of 2 m and more the minimum distance is 0.16 mm, independent of other objects.
TEST(LiftLamps, MovesWhatIsTooNearOnItsOwnSide) {
  const Scene above = with_lamp_at("1e-6"), below = with_lamp_at("-1e-6"), on = with_lamp_at("0");
  EXPECT_NEAR(above.lamps[0].position.z, 1.6e-4, 1e-10);
  EXPECT_NEAR(below.lamps[0].position.z, -1.6e-4, 1e-10);
  EXPECT_NEAR(on.lamps[0].position.z, 1.6e-4, 1e-10);
  ASSERT_EQ(above.warnings.size(), 1U);
  EXPECT_TRUE(test::holds(above.warnings[0],
                          {"\"lamp\"", "0.001 mm from", "\"floor\"", "0.16 mm farther off"}));
  ASSERT_EQ(on.warnings.size(), 1U);
  EXPECT_TRUE(test::holds(on.warnings[0], {"is on the object", "in front of it"}));
}

// At a corner of three walls, the distance to all three is the same.
TEST(LiftLamps, LeavesEveryWallOfACorner) {
  const test::SceneFolder folder;
  const Scene scene = folder.read(
      "format = 1\n[[material]]\nname = \"m\"\ndiffuse = 0.5\n[[light]]\nname = \"lamp\"\ntype = "
      "\"point\"\nposition = [0, 0, 0]\nflux = 1\n[[object]]\nname = \"room\"\nshape = "
      "\"box\"\nmin = [0, 0, 0]\nmax = [1, 2, 2]\ninward = true\nmaterial = \"m\"\n");
  const double least = 1.6e-4;
  EXPECT_LT(glm::length(scene.lamps[0].position - Vec3(least)), 1e-10);
}

TEST(LiftLamps, NamesWhatStandsBetweenSheets) {
  const test::SceneFolder folder;
  const std::string sheet = "[[object]]\nshape = \"quad\"\nmaterial = \"m\"\n";
  const Scene scene = folder.read(
      "format = 1\n[[material]]\nname = \"m\"\ndiffuse = 0.5\n[[light]]\nname = \"lamp\"\ntype = "
      "\"point\"\nposition = [0.1, 0.2, 1e-5]\nflux = 1\n" +
      sheet + "name = \"low\"\ncorners = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]\n" +
      sheet +
      "name = \"high\"\ncorners = [[-1, -1, 2e-5], [-1, 1, 2e-5], [1, 1, 2e-5], [1, -1, 2e-5]]\n");
  EXPECT_EQ(scene.lamps[0].position.z, 1e-5);
  ASSERT_FALSE(scene.warnings.empty());
  EXPECT_TRUE(test::holds(scene.warnings.back(), {"\"lamp\"", "between", "move it"}));
}

// A flat lamp flush with the floor may emit upward: no warning, but rays hit the lamp before the
// floor. A lamp that emits downward is lifted with a warning.
TEST(LiftLamps, FlatLampsStandInFrontOfWhatTheyAreFlushWith) {
  for (const std::string kind : {"disk", "rectangle"}) {
    for (const std::string height : {"0", "1e-5"}) {
      const Scene down = with_lamp_at(height, kind, "[0, 0, -1]");
      EXPECT_NEAR(down.lamps[0].position.z, 1.6e-4, 1e-10);
      EXPECT_EQ(down.warnings.size(), 1U);
      const Scene up = with_lamp_at(height, kind);
      EXPECT_NEAR(up.lamps[0].position.z, 1.6e-4, 1e-10);
      EXPECT_TRUE(up.warnings.empty());
    }
  }
}

TEST(LiftLamps, LeavesOthersWhereTheyAre) {
  for (const Scene& scene :
       {with_lamp_at("0.0002"), with_lamp_at("0.0002", "disk", "[0, 0, -1]")}) {
    EXPECT_TRUE(scene.warnings.empty());
  }
  EXPECT_EQ(with_lamp_at("0.0002").lamps[0].position.z, 0.0002);
}

}  // namespace
}  // namespace earthshine::scenes
