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

// For a plate across z, 1000 km away along z, the ray offset is 2 * 2^-24 * 2 * 1e6 m = 0.24 m (the
// terms of its 0.7 m are below 1 um); 20 offsets are 4.8 m: a plate of 0.7 m is too small, one of 7
// m is not.
TEST(SmallObjects, AreNamedWhereSinglePrecisionLosesThem) {
  const Plate bay{"bay", 1.0, 0.0, 0.0}, box{"box", 1.0, 0.0, 1.0};
  const Scene small = with({bay, box, {"plate", 0.7, 0.0, 1e6}});
  ASSERT_FALSE(small.warnings.empty());
  EXPECT_TRUE(test::holds(small.warnings.back(),
                          {"\"plate\" is too small for single precision 1e+06 m from",
                           "0.24 m off surfaces", "place and scale of that object"}));
  for (const std::string& warning : with({bay, box, {"plate", 7.0, 0.0, 1e6}}).warnings) {
    EXPECT_EQ(warning.find("too small"), std::string::npos) << warning;
  }
}

// Independent of other objects: a plate of 0.7 m on a floor of 10 km, or with one of 3 m at 100 km.
TEST(SmallObjects, DoNotDependOnTheRestOfTheScene) {
  for (const Plate& other : {Plate{"floor", 1e4, 0.0, 0.0}, Plate{"east", 3.0, 1e5, 0.0}}) {
    for (const std::string& warning :
         with({{"plate", 0.7, 0.0, 1.0}, {"box", 0.7, 0.0, 2.0}, other}).warnings) {
      EXPECT_EQ(warning.find("too small"), std::string::npos) << warning;
    }
  }
}

}  // namespace
}  // namespace earthshine::scenes
