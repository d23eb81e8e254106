// SPDX-License-Identifier: Apache-2.0
#include "degrade/settings/camera_file.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "base/error.h"
#include "degrade/settings/presets.h"

namespace earthshine::degrade {
namespace {

using Value = decltype(scenes::Setting::value);

scenes::SettingTable table(std::string name,
                           const std::vector<std::pair<std::string, Value>>& settings) {
  scenes::SettingTable result{std::move(name), {"bay.toml", 10, 1}, {}};
  int line = 11;
  for (const auto& [key, value] : settings) {
    result.settings.push_back({key, value, {"bay.toml", line++, 1}});
  }
  return result;
}

scenes::Scene scene_with(const std::vector<std::pair<std::string, Value>>& settings,
                         std::string name = "mine") {
  scenes::Scene scene;
  scene.path = "bay.toml";
  scene.cctv.push_back(table(std::move(name), settings));
  return scene;
}

std::string refusal(const scenes::Scene& scene) {
  try {
    check_settings(scene);
  } catch (const base::Error& e) {
    EXPECT_EQ(e.blame(), base::Blame::Input);
    return e.what();
  }
  return "accepted";
}

bool holds(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

TEST(CameraFile, ValuesOfEveryKindArriveInTheirField) {
  const CctvCamera camera = resolve_camera(scene_with({{"colour", true},
                                                       {"iris", std::string("average")},
                                                       {"noise", std::string("spec")},
                                                       {"snr_db", 32.0},
                                                       {"bits", 8.0}}),
                                           "mine");
  EXPECT_TRUE(camera.colour);
  EXPECT_EQ(camera.iris, IrisMode::Average);
  EXPECT_EQ(camera.noise, NoiseMode::Spec);
  EXPECT_EQ(camera.snr_db, 32.0);
  EXPECT_EQ(camera.bits, 8);
}

TEST(CameraFile, TableStartsFromItsPresetOrTheOneOfItsName) {
  const double tube = find_preset("sit-monochrome")->camera.white_lux;
  const auto named = scene_with({{"glare", 0.1}, {"preset", std::string("sit-monochrome")}});
  EXPECT_EQ(resolve_camera(named, "mine").white_lux, tube);
  EXPECT_EQ(resolve_camera(named, "mine").glare, 0.1);
  EXPECT_EQ(resolve_camera(scene_with({}, "sit-monochrome"), "sit-monochrome").white_lux, tube);
  EXPECT_EQ(resolve_camera(scene_with({}), "mine").white_lux, CctvCamera{}.white_lux);
}

TEST(CameraFile, SceneNeedsNoTableForAShippedCamera) {
  EXPECT_EQ(resolve_camera(scenes::Scene{}, "ccd-colour").white_lux, 2.0);
}

TEST(CameraFile, UnknownKeyNamesLineAndNearestKey) {
  const std::string message = refusal(scene_with({{"colour", true}, {"gama", 2.2}}));
  EXPECT_TRUE(holds(message, "bay.toml:12:1: unknown key \"gama\"")) << message;
  EXPECT_TRUE(holds(message, "Did you mean \"gamma\"?")) << message;
}

TEST(CameraFile, ValueOutOfRangeNamesTheRange) {
  for (const double value : {0.0, 5.1, -1.0, std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity()}) {
    const std::string message = refusal(scene_with({{"gamma", value}}));
    EXPECT_TRUE(holds(message, "bay.toml:11:1: \"gamma\" is")) << message;
    EXPECT_TRUE(holds(message, "between 0.2 and 5")) << message;
  }
  EXPECT_TRUE(holds(refusal(scene_with({{"bits", 7.5}})), "whole number"));
}

// A Gaussian of 0.01 MHz blurs over a quarter of a line; one of 1e-6 would have millions of taps.
TEST(CameraFile, BandwidthLeavesSomethingOfALine) {
  EXPECT_EQ(refusal(scene_with({{"bandwidth_mhz", 0.01}})), "accepted");
  for (const double value : {1e-6, 1e-300}) {
    const std::string message = refusal(scene_with({{"colour", true}, {"bandwidth_mhz", value}}));
    EXPECT_TRUE(holds(message, "bay.toml:12:1: bandwidth_mhz = 1e-")) << message;
    EXPECT_TRUE(holds(message, "0 (any), or from 0.01 on")) << message;
  }
}

TEST(CameraFile, WrongKindAndWrongWordAreRefused) {
  EXPECT_TRUE(holds(refusal(scene_with({{"gamma", std::string("2.2")}})), "must be a number"));
  EXPECT_TRUE(holds(refusal(scene_with({{"colour", 1.0}})), "must be true or false"));
  EXPECT_TRUE(holds(refusal(scene_with({{"gamma", std::vector<double>{1, 2, 3}}})), "wrong kind"));
  const std::string message = refusal(scene_with({{"iris", std::string("peek")}}));
  EXPECT_TRUE(holds(message, "\"fixed\", \"peak\", \"normal\" or \"average\"")) << message;
  EXPECT_TRUE(holds(message, "Did you mean \"peak\"?")) << message;
  EXPECT_TRUE(holds(refusal(scene_with({{"preset", std::string("sit-mono")}})), "no preset"));
}

TEST(CameraFile, SettingWithoutEffectIsRefused) {
  EXPECT_TRUE(holds(refusal(scene_with({{"noise_a", 0.01}})), "\"noise_a\" has no effect"));
  EXPECT_TRUE(holds(refusal(scene_with({{"f_number", 4.0}})), "has no effect"));
  EXPECT_TRUE(holds(refusal(scene_with({{"preset", std::string("ccd-colour")}, {"snr_db", 40.0}})),
                    "noise = \"photon\""));
  EXPECT_EQ(refusal(scene_with({{"noise_a", 0.01}, {"noise", std::string("law")}})), "accepted");
}

// Settings of two forms of noise are ambiguous.
TEST(CameraFile, NoiseInTwoFormsIsRefused) {
  const std::string message = refusal(
      scene_with({{"noise", std::string("spec")}, {"snr_db", 40.0}, {"read_electrons", 5.0}}));
  EXPECT_TRUE(holds(message, "bay.toml:13:1: \"read_electrons\" stands beside \"snr_db\""))
      << message;
  EXPECT_TRUE(holds(message, "\"snr_db\" goes with noise = \"report\" or \"spec\"")) << message;
  EXPECT_TRUE(holds(message, "\"read_electrons\" with noise = \"photon\"")) << message;
  EXPECT_TRUE(holds(refusal(scene_with(
                        {{"noise", std::string("law")}, {"noise_b", 1e-3}, {"prnu_percent", 1.0}})),
                    "two forms"));
  EXPECT_TRUE(holds(refusal(scene_with({{"noise", std::string("law")}, {"snr_db", 40.0}})),
                    "it goes with noise = \"report\" or \"spec\""));
}

std::string source_of(const std::vector<SettingSource>& sources, std::string_view key) {
  for (const SettingSource& source : sources) {
    if (source.key == key) return source.source;
  }
  return "none";
}

TEST(CameraFile, EachSettingKnowsWhereItComesFrom) {
  const Preset& tube = *find_preset("sit-monochrome");
  const auto scene = scene_with({{"preset", std::string("sit-monochrome")},
                                 {"noise", std::string("spec")},
                                 {"snr_db", 32.0}});
  const ResolvedCamera camera = resolve(scene, "mine");
  EXPECT_EQ(source_of(camera.sources, "snr_db"), "bay.toml:13:1");
  EXPECT_EQ(source_of(camera.sources, "gamma"), source_of(tube.sources, "gamma"));
  EXPECT_EQ(source_of(camera.sources, "prnu_percent"), "none");  // no longer in use
  EXPECT_EQ(camera.monitor_sources.size(), tube.monitor_sources.size());
  EXPECT_TRUE(holds(camera.about, "starts from sit-monochrome")) << camera.about;
  EXPECT_EQ(source_of(resolve(scene_with({}), "mine").sources, "gamma"), "default");
  EXPECT_EQ(source_of(resolve(scene_with({}), "mine").monitor_sources, "gamma"), "default");
}

TEST(CameraFile, PresetBringsItsMonitorUnlessTheSceneHasOne) {
  const double shipped = find_preset("report-1990")->monitor.black_luminance;
  ASSERT_NE(shipped, Monitor{}.black_luminance);
  EXPECT_EQ(resolve_monitor(scenes::Scene{}, "report-1990").black_luminance, shipped);
  auto scene = scene_with({{"preset", std::string("report-1990")}});
  EXPECT_EQ(resolve_monitor(scene, "mine").black_luminance, shipped);
  EXPECT_EQ(resolve_monitor(scene, "ccd-colour").black_luminance, 1.0);
  EXPECT_EQ(resolve_monitor(scene, "").black_luminance, 1.0);
  scene.monitor = table("", {{"rows", 240.0}});
  EXPECT_EQ(resolve_monitor(scene, "mine").black_luminance, 1.0);
  scene.monitor = table("", {{"rows", 240.0}, {"preset", std::string("report-1990")}});
  EXPECT_EQ(resolve_monitor(scene, "ccd-colour").black_luminance, shipped);
  EXPECT_EQ(resolve_monitor(scene, "ccd-colour").rows, 240);
  EXPECT_EQ(source_of(resolve(scene, "mine").monitor_sources, "rows"), "bay.toml:11:1");
  EXPECT_TRUE(holds(source_of(resolve(scene, "mine").monitor_sources, "columns"), "[1990]"));
  scene.monitor = table("", {{"preset", std::string("report-199")}});
  EXPECT_TRUE(holds(refusal(scene), "Did you mean \"report-1990\"?")) << refusal(scene);
}

TEST(CameraFile, ContradictingLimitsAreRefused) {
  EXPECT_TRUE(holds(refusal(scene_with({{"f_number_min", 8.0}, {"f_number_max", 4.0}})),
                    "above f_number_max"));
}

TEST(CameraFile, CameraWithAnUnknownCctvNamesTheNearest) {
  scenes::Scene scene = scene_with({});
  scene.cameras.resize(1);
  scene.cameras[0].cctv = "sit-monocrome";
  const std::string message = refusal(scene);
  EXPECT_TRUE(holds(message, "no CCTV camera \"sit-monocrome\"")) << message;
  EXPECT_TRUE(holds(message, "Did you mean \"sit-monochrome\"?")) << message;
  EXPECT_TRUE(holds(message, "\"mine\"")) << message;
  scene.cameras[0].cctv = "mine";
  EXPECT_EQ(refusal(scene), "accepted");
  scene.cameras[0].cctv = "";
  EXPECT_EQ(refusal(scene), "accepted");
}

TEST(CameraFile, MonitorIsReadAndCheckedTheSameWay) {
  scenes::Scene scene;
  EXPECT_EQ(resolve_monitor(scene, "mine").rows, 300);
  scene.monitor =
      table("", {{"rows", 485.0}, {"columns", 640.0}, {"spread", std::string("triangle")}});
  EXPECT_EQ(resolve_monitor(scene, "mine").rows, 485);
  EXPECT_EQ(resolve_monitor(scene, "mine").spread, Spread::Triangle);
  scene.monitor = table("", {{"row", 300.0}});
  EXPECT_TRUE(holds(refusal(scene), "Did you mean \"rows\"?")) << refusal(scene);
  scene.monitor = table("", {{"rows", 0.0}});
  EXPECT_TRUE(holds(refusal(scene), "between 1 and 2000"));
  scene.monitor = table("", {{"spread", std::string("none")}, {"spread_width", 1.0}});
  EXPECT_TRUE(holds(refusal(scene), "no effect"));
  scene.monitor = table("", {{"black_luminance", 100.0}});
  EXPECT_TRUE(holds(refusal(scene), "not below white_luminance"));
}

}  // namespace
}  // namespace earthshine::degrade
