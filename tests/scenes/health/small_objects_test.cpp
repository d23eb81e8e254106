// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "tests/scenes/scene_text.h"

namespace earthshine::scenes {
namespace {

Scene plate_on(double floor_m, double plate_m) {
  const auto quad = [](const char* name, double half, double z) {
    return fmt::format(
        "[[object]]\nname = \"{0}\"\nshape = \"quad\"\nmaterial = \"m\"\ncorners = [[-{1}, -{1}, "
        "{2}], "
        "[{1}, -{1}, {2}], [{1}, {1}, {2}], [-{1}, {1}, {2}]]\n",
        name, half, z);
  };
  return test::SceneFolder().read("format = 1\n[[material]]\nname = \"m\"\ndiffuse = 0.5\n" +
                                  quad("floor", floor_m / 2, 0.0) +
                                  quad("plate", plate_m / 2, 1.0));
}

// A floor of 10 km is 14.14 km across, rays start 4e-6 of that off surfaces, 57 mm, and a plate
// that is less than twenty times as large, 1.13 m across, loses what is near: one of 0.7 m is
// 0.99 m across, one of 0.9 m 1.27 m.
TEST(SmallObjects, AreNamedWithWhatMakesTheSceneWide) {
  const Scene small = plate_on(10000.0, 0.7);
  ASSERT_EQ(small.warnings.size(), 2U);  // the first: that the scene is so wide
  EXPECT_TRUE(test::holds(small.warnings[1], {"\"plate\" is smaller than 1.1 m",
                                              "\"floor\" (1.41e+04 m)", "0.057 m off surfaces"}));
  EXPECT_EQ(plate_on(10000.0, 0.9).warnings.size(), 1U);
  EXPECT_TRUE(plate_on(10.0, 0.7).warnings.empty());
}

}  // namespace
}  // namespace earthshine::scenes
