// SPDX-License-Identifier: Apache-2.0
#include "scenes/health/crossings.h"

#include <fmt/format.h>

#include <cmath>

#include "tests/scenes/scene_text.h"

namespace earthshine::scenes {
namespace {

const std::string scene_head = "format = 1\n[[material]]\nname = \"w\"\ndiffuse = 0.5\n";

std::string body(const std::string& name, const std::string& low, const std::string& high) {
  return fmt::format(
      "[[object]]\nname = \"{}\"\nshape = \"box\"\nmin = {}\nmax = {}\nmaterial = \"w\"\n", name,
      low, high);
}
std::string ball(const std::string& name, const std::string& center) {
  return fmt::format(
      "[[object]]\nname = \"{}\"\nshape = \"sphere\"\ncenter = {}\nradius = 1\nsegments = 256\n"
      "material = \"w\"\n",
      name, center);
}

Crossings crossings(const std::string& objects) {
  return find_crossings(test::SceneFolder().read(scene_head + objects));
}

const std::string unit_cube = body("a", "[0, 0, 0]", "[1, 1, 1]");

// The face x = 1 of unit_cube cuts the second box along its outline there, 4 x 0.6 m.
TEST(Crossings, OfABoxInACubeAreItsOutline) {
  const Crossings found = crossings(unit_cube + body("b", "[0.5, 0.2, 0.3]", "[1.5, 0.8, 0.9]"));
  ASSERT_EQ(found.pairs.size(), 1U);
  EXPECT_EQ(found.pairs[0].a, 0U);
  EXPECT_EQ(found.pairs[0].b, 1U);
  EXPECT_NEAR(found.pairs[0].line_m, 2.4, 1e-9);
  EXPECT_TRUE(found.complete);
}

// Unit spheres at the distance d intersect in a circle of the radius sqrt(1 - d^2 / 4); 256
// segments omit 1e-4 of the radius.
TEST(Crossings, OfTwoSpheresAreACircle) {
  const Crossings found = crossings(ball("a", "[0, 0, 0]") + ball("b", "[0.5, 0.1, 0.2]"));
  ASSERT_EQ(found.pairs.size(), 1U);
  const double d2 = 0.25 + 0.01 + 0.04;
  EXPECT_NEAR(found.pairs[0].line_m, 2.0 * base::pi * std::sqrt(1.0 - d2 / 4.0), 2e-3);
}

// A plate of 3 m through unit_cube: the cube's outline.
TEST(Crossings, OfAPlateThroughACubeAreTheCubesOutline) {
  const Crossings found =
      crossings(unit_cube +
                "[[object]]\nname = \"q\"\nshape = \"quad\"\nmaterial = \"w\"\n"
                "corners = [[-1, -1, 0.5], [2, -1, 0.5], [2, 2, 0.5], [-1, 2, 0.5]]\n");
  ASSERT_EQ(found.pairs.size(), 1U);
  EXPECT_NEAR(found.pairs[0].line_m, 4.0, 1e-9);
}

TEST(Crossings, OfBodiesWithFacesInTheSamePlanesHaveNoLine) {
  const Crossings found = crossings(unit_cube + body("b", "[0.5, 0, 0]", "[1.5, 1, 1]"));
  ASSERT_EQ(found.pairs.size(), 1U);
  EXPECT_EQ(found.pairs[0].triangles, 0U);
}

TEST(Crossings, ToTouchToStandOnAndToBeInsideIsNoCrossing) {
  for (const std::string& other :
       {body("b", "[1, 0, 0]", "[2, 1, 1]"), body("b", "[0.2, 0.2, 1]", "[0.4, 0.4, 1.4]"),
        body("b", "[0.2, 0.2, 0.2]", "[0.4, 0.4, 0.4]"), body("b", "[1, 1, 1]", "[2, 2, 2]"),
        body("b", "[3, 0, 0]", "[4, 1, 1]")}) {
    EXPECT_TRUE(crossings(unit_cube + other).pairs.empty()) << other;
  }
  // Self-intersections do not count.
  EXPECT_TRUE(crossings(unit_cube).pairs.empty());
}

// Independent of the scene's position and scale.
TEST(Crossings, DoNotDependOnPlaceAndScale) {
  for (const double scale : {0.01, 1.0, 30.0}) {
    const std::string placed = fmt::format("scale = {}\ntranslate = [1000, 0, 0]\n", scale);
    const Crossings through =
        crossings(unit_cube + placed + body("b", "[0.5, 0.2, 0.3]", "[1.5, 0.8, 0.9]") + placed);
    ASSERT_EQ(through.pairs.size(), 1U) << scale;
    EXPECT_NEAR(through.pairs[0].line_m, 2.4 * scale, 1e-6 * scale);
    const Crossings beside =
        crossings(unit_cube + placed + body("b", "[1, 0, 0]", "[2, 1, 1]") + placed);
    EXPECT_TRUE(beside.pairs.empty()) << scale;
  }
}

}  // namespace
}  // namespace earthshine::scenes
