// SPDX-License-Identifier: Apache-2.0
#include "degrade/settings/presets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <type_traits>

#include "degrade/chain.h"
#include "degrade/parts/monitor.h"
#include "degrade/parts/sensor.h"
#include "degrade/stage/read_setting.h"
#include "tests/degrade/fields.h"

namespace earthshine::degrade {
namespace {

TEST(Presets, NamesAreUniqueAndFound) {
  std::set<std::string_view> names;
  for (const Preset& preset : presets()) {
    EXPECT_TRUE(names.insert(preset.name).second);
    EXPECT_EQ(find_preset(preset.name), &preset);
    EXPECT_FALSE(preset.about.empty());
  }
  EXPECT_EQ(find_preset("none-such"), nullptr);
}

struct WithinLimits {
  std::string_view owner;
  template <class T>
  void operator()(const char* key, const T& value, Limits limits, const char*, const char*) const {
    if constexpr (std::is_arithmetic_v<T> && !std::is_same_v<T, bool>) {
      EXPECT_GE(static_cast<double>(value), limits.least) << owner << " " << key;
      EXPECT_LE(static_cast<double>(value), limits.most) << owner << " " << key;
    }
  }
};

TEST(Presets, EveryValueLiesInTheRangeThatTheReaderAllows) {
  for (const Preset& preset : presets())
    visit_camera_fields(preset.camera, WithinLimits{preset.name});
  for (const Preset& preset : presets())
    visit_monitor_fields(preset.monitor, WithinLimits{preset.name});
}

std::vector<std::string> keys_of(const std::vector<SettingSource>& sources) {
  std::vector<std::string> keys;
  for (const SettingSource& source : sources) keys.push_back(source.key);
  return keys;
}

// Each setting in use has one source, in the order of the fields; other settings have none.
TEST(Presets, EverySettingInUseHasItsSourceAndNoOther) {
  for (const Preset& preset : presets()) {
    std::vector<std::string> camera, monitor;
    visit_camera_fields(preset.camera, [&](const char* key, auto&&...) {
      if (is_used(preset.camera, key)) camera.emplace_back(key);
    });
    visit_monitor_fields(preset.monitor, [&](const char* key, auto&&...) {
      if (is_used(preset.monitor, key)) monitor.emplace_back(key);
    });
    EXPECT_EQ(keys_of(preset.sources), camera) << preset.name;
    EXPECT_EQ(keys_of(preset.monitor_sources), monitor) << preset.name;
  }
}

// A reader must be able to distinguish measurements from estimates.
TEST(Presets, EverySourceSaysWhatKindItIs) {
  const auto known = [](const std::string& source) {
    for (const std::string_view kind : {"[1990] ", "[GCTA] ", "[IUCr] ", "[SCOM] ", "[shutref] ",
                                        "computed: ", "estimate: ", "none: "}) {
      if (source.starts_with(kind)) return source.size() > kind.size();
    }
    return false;
  };
  for (const Preset& preset : presets()) {
    for (const SettingSource& s : preset.sources) {
      EXPECT_TRUE(known(s.source)) << preset.name << " " << s.key << ": " << s.source;
    }
    for (const SettingSource& s : preset.monitor_sources) {
      EXPECT_TRUE(known(s.source)) << preset.name << " " << s.key << ": " << s.source;
    }
  }
}

// The report mentions neither a black level nor room light: only the picture's light counts, on 300
// x 400 points with a Gaussian spread.
TEST(Presets, ReportOf1990HasItsOwnMonitor) {
  const Monitor& monitor = find_preset("report-1990")->monitor;
  EXPECT_EQ(monitor.rows, 300);
  EXPECT_EQ(monitor.columns, 400);
  EXPECT_EQ(monitor.spread, Spread::Gaussian);
  EXPECT_EQ(monitor.black_luminance, 0.0);
  EXPECT_EQ(room_luminance(monitor), 0.0);
}

// 20 lg(1 / 0.10) = 20 dB.
TEST(Presets, ReportOf1990IsTenPercentOfEachPoint) {
  const NoiseFigures figures = noise_figures(find_preset("report-1990")->camera);
  EXPECT_NEAR(figures.percent_of_signal, 10.0, 1e-9);
  EXPECT_EQ(figures.law.a, 0.0);
  EXPECT_EQ(figures.law.b, 0.0);
}

// 640 electrons: 10 lg 640 = 28.06 dB; with 2.3 e- of the amplifier and 1 % pattern 27.77 dB.
TEST(Presets, TubeHas28DecibelsAtWhiteAndTheChip40) {
  EXPECT_NEAR(noise_figures(find_preset("sit-monochrome")->camera).snr_db, 28.0, 0.4);
  EXPECT_NEAR(noise_figures(find_preset("ccd-colour")->camera).snr_db, 40.0, 1.5);
  EXPECT_NEAR(noise_figures(find_preset("ccd-colour")->camera).floor_db, 50.0, 0.6);
}

// 3 x 3 resels of 1000 times white spread 9 (1000 - 4) as a Gaussian of 15 resels:
// 8964 / (2 pi 15^2) = 6.34 in its middle, and white at 15 sqrt(2 ln 6.34) = 28.8 resels, a tenth
// of the picture's height.
TEST(Presets, TubeBloomsToATenthOfTheHeight) {
  const CctvCamera camera = find_preset("sit-monochrome")->camera;
  Picture point = test::flat(201, 201, 0.0F);
  for (std::size_t y = 99; y <= 101; ++y) {
    for (std::size_t x = 99; x <= 101; ++x) point.planes[0][y * 201 + x] = 1000.0F;
  }
  const Plane after =
      bloom_over(point, camera.saturation, camera.bloom, camera.bloom_radius).planes[0];
  int reach = 0;
  while (after[100U * 201U + 100U + static_cast<std::size_t>(reach)] >= 1.0F) ++reach;
  EXPECT_NEAR(reach, 29, 1);
}

// 0.42^3 = 0.074: 7 % after three fields. (1 - 0.1)^30 = 0.042: share of the iris' distance that
// remains after a second.
TEST(Presets, TubeLagsAndItsIrisTravels) {
  const CctvCamera camera = find_preset("sit-monochrome")->camera;
  EXPECT_NEAR(std::pow(camera.lag, 3), 0.07, 0.005);
  EXPECT_LT(std::pow(1.0 - camera.iris_rate, 30), 0.05);
}

// Measured in the bay: 31 cd/m^2 under the lamps needs f/31, a sunlit grey of 21 200 cd/m^2 needs
// f/815 for white.
TEST(Presets, TubeStopsDownForTheBayAsComputed) {
  CctvCamera camera = find_preset("sit-monochrome")->camera;
  camera.iris_target = 1.0;
  EXPECT_NEAR(expose(camera, 31.0).f_number, 31.0, 0.5);
  EXPECT_NEAR(expose(camera, 133100.0 * 0.5 / 3.14159265).f_number, 815.0, 5.0);
}

TEST(Presets, TubeGrainGrowsRelativeToTheSignalInTheShadows) {
  const NoiseLaw law = noise_law(find_preset("sit-monochrome")->camera);
  double last = 0.0;
  for (const double s : {1.0, 0.3, 0.1, 0.03, 0.01}) {
    const double relative = std::sqrt(law.variance(s)) / s;
    EXPECT_GT(relative, last);
    last = relative;
  }
}

std::string document() {
  std::string text;
  for (const char* name : {EARTHSHINE_SOURCE_DIR "/docs/cctv.md",
                           EARTHSHINE_SOURCE_DIR "/docs/data/cctv-cameras.md"}) {
    std::ifstream file(name);
    text.append(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  return text;
}

struct InTheDocument {
  const std::string& text;
  template <class T>
  void operator()(const char* key, const T&, Limits, const char*, const char* help) const {
    EXPECT_NE(text.find("`" + std::string(key) + "`"), std::string::npos) << key;
    EXPECT_NE(text.find(help), std::string::npos) << key << ": " << help;
  }
};

// "0.8 e": the value and the kind of its source: its tag, c for computed, e for estimate.
std::string cell(const std::string& value, const std::string& source) {
  if (source.starts_with("none: ")) return value;
  if (source.starts_with("computed: ")) return value + " c";
  if (source.starts_with("estimate: ")) return value + " e";
  return value + " " + source.substr(0, source.find(']') + 1);
}

template <class Value>
std::string value_text(const Value& value) {
  if constexpr (std::is_enum_v<Value>) {
    return in_quotes(word_of(value));
  } else if constexpr (std::is_same_v<Value, bool>) {
    return value ? "true" : "false";
  } else {
    return number(static_cast<double>(value));
  }
}

// Rows of `key | cells`, keys in the order of the fields, without keys that no preset uses.
class Table {
 public:
  template <class Settings, class Visit>
  void add_column(const Settings& settings, const std::vector<SettingSource>& sources,
                  Visit visit) {
    ++columns_;
    visit(settings, [&](const char* key, const auto& value, auto&&...) {
      if (columns_ == 1) keys_.emplace_back(key);
      std::string text;
      for (const SettingSource& s : sources) {
        if (s.key == key) text = cell(value_text(value), s.source);
      }
      cells_[key].push_back(text);
    });
  }
  [[nodiscard]] std::string text() const {
    std::string all;
    for (const std::string& key : keys_) {
      std::string row = "| `" + key + "` |", used;
      for (const std::string& c : cells_.at(key)) {
        row += c.empty() ? " |" : " " + c + " |";
        used += c;
      }
      if (!used.empty()) all += row + "\n";
    }
    return all;
  }

 private:
  int columns_ = 0;
  std::vector<std::string> keys_;
  std::map<std::string, std::vector<std::string>> cells_;
};

TEST(Presets, DocumentListsEveryFieldStageAndPreset) {
  const std::string text = document();
  ASSERT_FALSE(text.empty());
  const CctvCamera camera;
  const Monitor monitor;
  visit_camera_fields(camera, InTheDocument{text});
  visit_monitor_fields(monitor, InTheDocument{text});
  for (const Preset& preset : presets()) {
    EXPECT_NE(text.find("`" + std::string(preset.name) + "`"), std::string::npos) << preset.name;
  }
  for (const Stage& stage : stages()) {
    EXPECT_NE(text.find(std::string(stage.name)), std::string::npos) << stage.name;
  }
}

// The document must contain the text that the message prints.
TEST(Presets, DocumentHasEveryValueAndItsKindOfSource) {
  const std::string text = document();
  Table camera, monitor;
  for (const Preset& preset : presets()) {
    camera.add_column(preset.camera, preset.sources,
                      [](const auto& c, auto&& field) { visit_camera_fields(c, field); });
    monitor.add_column(preset.monitor, preset.monitor_sources,
                       [](const auto& m, auto&& field) { visit_monitor_fields(m, field); });
    const std::string noise = describe_noise(preset.camera);
    EXPECT_NE(text.find(noise), std::string::npos) << preset.name << ": " << noise;
  }
  EXPECT_NE(text.find(camera.text()), std::string::npos) << camera.text();
  EXPECT_NE(text.find(monitor.text()), std::string::npos) << monitor.text();
}

}  // namespace
}  // namespace earthshine::degrade
