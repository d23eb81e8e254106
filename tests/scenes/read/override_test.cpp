// SPDX-License-Identifier: Apache-2.0
#include "scenes/read/override.h"

#include <gtest/gtest.h>

#include "scenes/light/lamp_light.h"
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

// For any definition of its strength. 0 is the one value of `intensity` that lights with other keys
// accept.
TEST(Override, AnIntensityOfZeroTurnsOffALightOfAnyType) {
  const std::string at = "position = [0, 0, 1]\n", aim = at + "aim = [0, 0, 0]\n",
                    cone = aim + "beam_deg = 20\nfield_deg = 40\n",
                    side = "center = [0, 0, 1]\nedge_u = [1, 0, 0]\nedge_v = [0, 1, 0]\n",
                    disk = "center = [0, 0, 1]\nnormal = [0, 0, 1]\nradius = 1\n";
  const test::SceneFolder folder;
  folder.put("l.ies",
             "IESNA:LM-63-1995\nTILT=NONE\n1 1000 1 2 1 1 2 0 0 0\n1 1 10\n0 90\n0\n100 100\n");
  for (const std::string& light :
       {"type = \"point\"\nintensity = 5\n" + at, "type = \"point\"\nflux = [5, 1, 2]\n" + at,
        "type = \"spot\"\nintensity = 5\n" + cone, "type = \"spot\"\nflux = 5\n" + cone,
        "type = \"rectangle\"\nexitance = 5\n" + side, "type = \"rectangle\"\nflux = 5\n" + side,
        "type = \"disk\"\nexitance = 5\n" + disk, "type = \"disk\"\nflux = 5\n" + disk,
        "type = \"ies\"\nfile = \"l.ies\"\n" + aim,
        "type = \"ies\"\nfile = \"l.ies\"\ncolor = [1, 0, 0]\n" + aim}) {
    const std::string text = "format = 1\n[[light]]\nname = \"l\"\n" + light;
    EXPECT_GT(base::max_component(lamp_flux_lm(folder.read(text).lamps.at(0))), 0.0) << light;
    for (const char* off :
         {"intensity=0", "intensity=0.0", "intensity=[0, 0, 0]", "flux=0", "exitance=0"}) {
      const Scene scene = folder.read(text, {std::string("light.l.") + off});
      EXPECT_EQ(lamp_flux_lm(scene.lamps.at(0)), Rgb(0.0)) << light << off;
    }
  }
  // Any other strength must use the type's own key.
  EXPECT_TRUE(holds(folder.refusal("format = 1\n[[light]]\nname = \"l\"\ntype = \"disk\"\n"
                                   "exitance = 5\n" +
                                       disk,
                                   {"light.l.intensity=1"}),
                    {"\"intensity\"", "does not belong"}));
}

// A lamp of a glTF file has no [[light]].
TEST(Override, AnIntensityOfZeroTurnsOffALightOfAMesh) {
  const test::SceneFolder folder;
  folder.put("m.gltf", R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
    "extensionsUsed": ["KHR_lights_punctual"],
    "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "name": "bulb", "intensity": 7}]}},
    "nodes": [{"mesh": 0}, {"extensions": {"KHR_lights_punctual": {"light": 0}}}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                   "min": [0, 0, 0], "max": [1, 1, 0]}]})");
  const std::string text =
      "format = 1\n[[material]]\nname = \"w\"\n[[object]]\nname = \"o\"\nmesh = \"m.gltf\"\n"
      "material = \"w\"\nlights = true\n";
  EXPECT_EQ(folder.read(text).lamps.at(0).intensity_cd, Rgb(7.0));
  EXPECT_EQ(folder.read(text, {"light.o.bulb.intensity=0"}).lamps.at(0).intensity_cd, Rgb(0.0));
  EXPECT_TRUE(holds(folder.refusal(text, {"light.o.bulp.intensity=0"}),
                    {"no light is named \"o.bulp\"", "\"o.bulb\"?"}));
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
