// SPDX-License-Identifier: Apache-2.0
#include "scenes/read/override.h"

#include <gtest/gtest.h>

#include "tests/scenes/scene_text.h"

namespace earthshine::scenes {
namespace {

using test::holds;

const std::string scene_text =
    "format = 1\nname = \"a\"\n[sun]\ndirection = [0, 0, 1]\n"
    "[[light]]\nname = \"fwd.2\"\ntype = \"point\"\nposition = [0, 0, 0]\nintensity = 5\n"
    "[[camera]]\nname = \"A\"\nposition = [0, 0, 0]\nlook_at = [1, 0, 0]\n";

TEST(Override, SetsKeysOfTheSceneOfTablesAndOfNamedEntries) {
  const test::SceneFolder folder;
  const Scene scene = folder.read(
      scene_text, {"name=two words", "sun.illuminance=[1, 2, 3]", "light.fwd.2.intensity=0",
                   "camera.A.resolution=[64, 32]", "quality.gather_rays=64", "quality.error=0.1",
                   "monitor.spread=sinc", "quality.error=0.2"});
  EXPECT_EQ(scene.name, "two words");
  EXPECT_EQ(scene.sun->illuminance_lx, Rgb(1, 2, 3));
  EXPECT_EQ(scene.lamps.at(0).intensity_cd, Rgb(0.0));
  EXPECT_EQ(scene.cameras.at(0).columns, 64);
  EXPECT_EQ(scene.quality.gather_rays, 64);
  EXPECT_EQ(scene.quality.error, 0.2);  // the last one wins
  EXPECT_EQ(std::get<std::string>(scene.monitor->settings.at(0).value), "sinc");
}

TEST(Override, IsCheckedLikeTheFileAndNamedInTheMessage) {
  const test::SceneFolder folder;
  const std::vector<std::pair<std::string, std::vector<std::string>>> cases{
      {"quality.gather_ray=64", {"unknown key \"gather_ray\" in [quality]", "\"gather_rays\"?"}},
      {"quality.gather_rays=0", {"\"gather_rays\"", "is 0", "from 1"}},
      {"qualty.error=0.1", {"unknown key \"qualty\"", "\"quality\"?"}},
      {"light.fwd.intensity=1", {"no [[light]] is named \"fwd\"", "fwd.2"}},
      {"object.o.scale=2", {"no [[object]] is named \"o\"", "has no [[object]]"}},
      {"light.intensity=1", {"light.NAME.KEY=VALUE"}},
      {"sun=1", {"sun.KEY=VALUE"}},
      {"earth.altitude_km=400", {"[earth] has no \"direction\""}},
      {"sun.illuminance", {"key=value"}},
      {"=1", {"key=value"}},
      {"sun.illuminance=", {"is not TOML"}},
      {"sun.illuminance=[1,", {"is not TOML"}},
      {"name=1\nunit=\"cm\"", {"is not TOML"}},
      {"sun.illuminance=lots", {"\"illuminance\" in [sun] is the string \"lots\""}},
      {"format=2", {"\"format\" is the number 2"}}};
  for (const auto& [setting, message] : cases) {
    const std::string refusal = folder.refusal(scene_text, {setting});
    EXPECT_TRUE(holds(refusal, message));
    EXPECT_TRUE(refusal.starts_with("--set " + setting.substr(0, setting.find('\n')))) << refusal;
  }
}

}  // namespace
}  // namespace earthshine::scenes
