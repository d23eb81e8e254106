// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/scenes/scene_text.h"

namespace earthshine::scenes {
namespace {

using test::holds;

class CameraTables : public ::testing::Test {
 protected:
  [[nodiscard]] Scene read(const std::string& toml) const {
    folder_.put("cameras.toml", toml);
    return read_camera_file(folder_.path() / "cameras.toml");
  }
  [[nodiscard]] std::string refusal(const std::string& toml) const {
    try {
      static_cast<void>(read(toml));
    } catch (const base::Error& error) {
      EXPECT_EQ(error.blame(), base::Blame::Input);
      return error.what();
    }
    return "was not refused";
  }

 private:
  test::SceneFolder folder_;
};

TEST_F(CameraTables, NothingElseIsNeeded) {
  const Scene scene = read(R"([[cctv]]
name = "one"
gamma = 1.0
[[cctv]]
name = "two"
[monitor]
rows = 240
)");
  ASSERT_EQ(scene.cctv.size(), 2U);
  EXPECT_EQ(scene.cctv[0].name, "one");
  EXPECT_EQ(std::get<double>(scene.cctv[0].settings.at(0).value), 1.0);
  EXPECT_EQ(scene.cctv[0].settings[0].where.line, 3);
  EXPECT_EQ(scene.monitor->settings.at(0).key, "rows");
  EXPECT_TRUE(read("").cctv.empty());
}

// The scene's meshes need not exist.
TEST_F(CameraTables, OfAWholeSceneOnlyTheseTablesAreRead) {
  const Scene scene = read(R"(format = 1
[[object]]
name = "bay"
mesh = "not-there.obj"
[[cctv]]
name = "one"
[quality]
nonsense = true
)");
  EXPECT_EQ(scene.cctv.at(0).name, "one");
  EXPECT_TRUE(scene.objects.empty());
}

TEST_F(CameraTables, WhatIsWrongIsSaidAtItsPlace) {
  EXPECT_TRUE(holds(refusal("[[cctv]]\nname = \"a\"\n[moniter]\nrows = 3\n"),
                    {"cameras.toml:3:", "unknown key \"moniter\" in a camera file",
                     "Did you mean \"monitor\"?"}));
  EXPECT_TRUE(holds(refusal("format = 1\n[ligth]\n"), {"cameras.toml:2:", "\"light\""}));
  EXPECT_TRUE(holds(refusal("format = 2\n"), {"cameras.toml:1:", "format = 1"}));
  EXPECT_TRUE(holds(refusal("[cctv]\nname = \"a\"\n"), {"cameras.toml:1:", "[[cctv]]"}));
  EXPECT_TRUE(holds(refusal("[[cctv]]\ngamma = 1\n"), {"cameras.toml:1:", "name"}));
  EXPECT_TRUE(holds(refusal("[[cctv]]\nname = \"a\"\n[[cctv]]\nname = \"a\"\n"), {"\"a\""}));
  EXPECT_TRUE(holds(refusal("[[cctv]\n"), {"cameras.toml:1:", "not TOML"}));
  EXPECT_TRUE(holds(refusal("cctv = 3\n"), {"cameras.toml:1:"}));
}

}  // namespace
}  // namespace earthshine::scenes
