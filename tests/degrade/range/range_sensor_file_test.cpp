// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "base/error.h"
#include "degrade/range/range_sensor.h"
#include "degrade/stage/read_setting.h"

namespace earthshine::degrade {
namespace {

using Value = decltype(scenes::Setting::value);

scenes::Scene scene_with(const std::vector<std::pair<std::string, Value>>& settings) {
  scenes::Scene scene;
  scene.path = "bay.toml";
  scenes::SettingTable& table = scene.range_sensors.emplace_back();
  table.name = "lidar";
  table.where = {"bay.toml", 10, 1};
  for (const auto& [key, value] : settings) {
    table.settings.push_back({key, value, {"bay.toml", 11, 1}});
  }
  return scene;
}

std::string refusal(const scenes::Scene& scene) {
  try {
    check_range_sensors(scene);
  } catch (const base::Error& e) {
    EXPECT_EQ(e.blame(), base::Blame::Input);
    return e.what();
  }
  return "accepted";
}

bool holds(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

TEST(RangeSensorFile, ValuesArriveInTheirField) {
  const RangeSensor sensor = resolve_range_sensor(scene_with({{"noise_m", 0.002},
                                                              {"noise_m_per_m2", 0.0019},
                                                              {"max_incidence_deg", 75.0},
                                                              {"min_range_m", 0.5},
                                                              {"max_range_m", 30.0},
                                                              {"quantum_m", 0.001}}),
                                                  "lidar");
  EXPECT_EQ(sensor.noise_m, 0.002);
  EXPECT_EQ(sensor.noise_m_per_m2, 0.0019);
  EXPECT_EQ(sensor.max_incidence_deg, 75.0);
  EXPECT_EQ(sensor.min_range_m, 0.5);
  EXPECT_EQ(sensor.max_range_m, 30.0);
  EXPECT_EQ(sensor.quantum_m, 0.001);
  EXPECT_EQ(sensor.dropout, 0.0);
}

TEST(RangeSensorFile, WhatIsWrongIsNamedWithItsPlaceAndWhatIsAllowed) {
  std::string message = refusal(scene_with({{"noise", 0.1}}));
  EXPECT_TRUE(holds(message, "bay.toml:11:1") &&
              holds(message, "unknown key \"noise\" in [[range_sensor]]; ") &&
              holds(message, "allowed keys: \"name\"") && holds(message, "mean \"noise_m\""))
      << message;
  message = refusal(scene_with({{"dropout", 1.5}}));
  EXPECT_TRUE(holds(message, "\"dropout\" is 1.5") && holds(message, "between 0 and 1")) << message;
  message = refusal(scene_with({{"quantum_m", std::string("1 mm")}}));
  EXPECT_TRUE(holds(message, "wrong kind") && holds(message, "a number")) << message;
  message = refusal(scene_with({{"min_range_m", 4.0}, {"max_range_m", 3.0}}));
  EXPECT_TRUE(holds(message, "min_range_m = 4 is not below max_range_m = 3")) << message;
  EXPECT_EQ(refusal(scene_with({{"min_range_m", 4.0}})), "accepted");  // max_range_m = 0: no limit
}

TEST(RangeSensorFile, CameraThatNamesAnUnknownSensorIsRefused) {
  scenes::Scene scene = scene_with({});
  scene.cameras.emplace_back().range_sensor = "lidr";
  const std::string message = refusal(scene);
  EXPECT_TRUE(holds(message, "\"lidr\"") && holds(message, "Did you mean \"lidar\"")) << message;
  scene.range_sensors.clear();
  EXPECT_TRUE(holds(refusal(scene), "the scene has no [[range_sensor]]"));
}

TEST(RangeSensorFile, DocumentationListsEveryKeyWithItsDefault) {
  std::ifstream file(EARTHSHINE_SOURCE_DIR "/docs/scene-format.md");
  std::stringstream text;
  text << file.rdbuf();
  RangeSensor sensor;
  visit_range_fields(
      sensor, [&](const char* key, double& field, Limits limits, const char* unit, const char*) {
        const std::string row = "| `" + std::string(key) + "` | number, " + unit + " | " +
                                number(limits.least) + " to " + number(limits.most) + " | " +
                                number(field) + " |";
        EXPECT_TRUE(holds(text.str(), row)) << row;
      });
}

}  // namespace
}  // namespace earthshine::degrade
