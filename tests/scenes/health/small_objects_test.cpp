// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <string>
#include <vector>

#include "tests/scenes/scene_text.h"

namespace earthshine::scenes {
namespace {

struct Plate {
  const char* name;
  double edge_m, x_m, z_m;
};

Scene with(const std::vector<Plate>& plates) {
  std::string text = "format = 1\n[[material]]\nname = \"m\"\ndiffuse = 0.5\n";
  for (const auto& [name, edge, x, z] : plates) {
    text += fmt::format(
        "[[object]]\nname = \"{0}\"\nshape = \"quad\"\nmaterial = \"m\"\ncorners = [[{1}, -{3}, "
        "{4}], "
        "[{2}, -{3}, {4}], [{2}, {3}, {4}], [{1}, {3}, {4}]]\n",
        name, x - edge / 2, x + edge / 2, edge / 2, z);
  }
  return test::SceneFolder().read(text);
}

// A floor of 10 km is 14.14 km across, rays start 4e-6 of that off surfaces, 57 mm, and a plate
// that is less than twenty times as large, 1.13 m across, loses what is near: one of 0.7 m is
// 0.99 m across, one of 0.9 m 1.27 m. A warning before it says that the scene is so wide.
TEST(SmallObjects, AreNamedWithWhatMakesTheSceneWide) {
  const Scene small = with({{"floor", 1e4, 0.0, 0.0}, {"plate", 0.7, 0.0, 1.0}});
  ASSERT_EQ(small.warnings.size(), 2U);
  EXPECT_TRUE(
      test::holds(small.warnings[1], {"\"plate\" is smaller than 1.1 m",
                                      "1.41e+04 m across, 0.99 m without "
                                      "\"floor\"",
                                      "0.057 m off surfaces", "that object's place and scale"}));
  EXPECT_EQ(with({{"floor", 1e4, 0.0, 0.0}, {"plate", 0.9, 0.0, 1.0}}).warnings.size(), 1U);
  EXPECT_TRUE(with({{"floor", 10.0, 0.0, 0.0}, {"plate", 0.7, 0.0, 1.0}}).warnings.empty());
}

// Not what is large, what stands far away: without it the bay and the box on it are 10 sqrt(2) m
// across. Of two on either side neither makes the scene half as wide alone, and of two objects each
// does.
TEST(SmallObjects, AreNamedWithWhatStandsFarAway) {
  const Plate bay{"bay", 10.0, 0.0, 0.0}, east{"east", 3.0, 1e5, 0.0}, west{"west", 3.0, -1e5, 0.0};
  const Scene one = with({bay, {"box", 1.0, 0.0, 0.0}, east}), pair = with({bay, east}),
              two = with({bay, east, west});
  ASSERT_EQ(one.warnings.size(), 2U);
  EXPECT_TRUE(
      test::holds(one.warnings[1], {"\"box\", \"east\" are smaller", "14.1 m without \"east\""}));
  ASSERT_EQ(pair.warnings.size(), 2U);
  EXPECT_TRUE(test::holds(pair.warnings[1], {"1e+05 m across, so that", "the objects' places"}));
  ASSERT_EQ(two.warnings.size(), 2U);
  EXPECT_TRUE(test::holds(two.warnings[1], {"\"bay\", \"east\", \"west\" are smaller",
                                            "2e+05 m across, so that", "the objects' places"}));
}

}  // namespace
}  // namespace earthshine::scenes
