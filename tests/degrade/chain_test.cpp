// SPDX-License-Identifier: Apache-2.0
// Laws of the whole chain.
#include "degrade/chain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.h"
#include "base/parallel.h"
#include "base/tone.h"
#include "degrade/settings/presets.h"
#include "tests/degrade/fields.h"

namespace earthshine::degrade {
namespace {

using test::linear_camera;
using test::painted;
using test::slope;

std::vector<std::string> names_run(const CctvCamera& camera, const Monitor& monitor) {
  std::vector<std::string> names;
  for (const StagePlan& row : plan(camera, monitor)) {
    if (row.runs) names.emplace_back(row.stage->name);
  }
  return names;
}

TEST(Chain, StageNamesAreUniqueAndUnitsFitTogether) {
  std::set<std::string_view> names;
  std::string_view unit = "cd/m^2";
  for (const Stage& stage : stages()) {
    EXPECT_TRUE(names.insert(stage.name).second) << stage.name;
    // On the line a linear signal is a line signal with gamma 1.
    EXPECT_TRUE(stage.in == unit || stage.in == "line signal") << stage.name;
    unit = stage.out;
  }
  EXPECT_EQ(unit, "cd/m^2");
}

// `plan` uses these names to say why a stage runs: each is a field of the camera or of the monitor.
// A stage without settings must run for all settings.
TEST(Chain, ARowNamesTheSettingsThatDecide) {
  std::set<std::string, std::less<>> fields;
  degrade::Setup bare{linear_camera(), {}, {}};
  visit_camera_fields(bare.camera, [&](const char* name, auto&&...) { fields.insert(name); });
  visit_monitor_fields(bare.monitor, [&](const char* name, auto&&...) {
    fields.insert(std::string("monitor.") + name);
  });
  bare.camera.black_clamp = false;
  bare.monitor.spread = Spread::None;
  bare.monitor.pixels_per_resel = 1;
  bare.monitor.room_illuminance = 0.0;
  for (const Stage& stage : stages()) {
    for (const std::string_view setting : stage.settings) {
      EXPECT_TRUE(setting.empty() || fields.contains(setting)) << stage.name << ": " << setting;
    }
    EXPECT_EQ(stage.settings.front().empty(), stage.runs(bare, nullptr)) << stage.name;
  }
}

TEST(Chain, OnlyWhatTheSettingsAskForRuns) {
  Monitor bare;
  bare.spread = Spread::None;
  bare.pixels_per_resel = 1;
  bare.room_illuminance = 0.0;
  CctvCamera camera = linear_camera();
  camera.black_clamp = false;
  using Names = std::vector<std::string>;
  EXPECT_EQ(names_run(camera, bare),
            (Names{"sensor-grid", "iris", "lens", "conversion", "levels", "screen"}));
  camera.noise = NoiseMode::Spec;
  camera.bits = 8;
  EXPECT_EQ(names_run(camera, bare), (Names{"sensor-grid", "iris", "lens", "conversion",
                                            "read-noise", "levels", "quantisation", "screen"}));
}

TEST(Chain, WhatRanIsWhatWasPlannedUnlessTheGainIsOne) {
  for (const Preset& preset : presets()) {
    std::vector<std::string> planned = names_run(preset.camera, {});
    const Result result = degrade(painted(60, 45, slope), preset.camera, {});
    if (result.report.exposure.gain == 1.0) std::erase(planned, "gain");
    EXPECT_EQ(result.report.stages, planned) << preset.name;
  }
}

TEST(Chain, EveryStageOffIsTheIdentity) {
  Options options;
  for (const Stage& stage : stages()) options.off.emplace_back(stage.name);
  const base::Image in = painted(31, 17, slope);
  const Result result = degrade(in, find_preset("sit-monochrome")->camera, {}, options);
  EXPECT_EQ(result.signal.channels[0].values, in.channels[0].values);
  EXPECT_EQ(result.viewed.channels[0].values, in.channels[0].values);
  EXPECT_TRUE(result.report.stages.empty());
}

TEST(Chain, FlatSceneStaysFlatFromTheLensToTheScreen) {
  for (const char* name : {"ideal", "ccd-colour"}) {
    Options twin;
    twin.off = {"signal-noise", "read-noise", "shading"};
    const Result result = degrade(test::grey(50, 40, 7.0F), find_preset(name)->camera, {}, twin);
    for (const base::Channel& channel : result.viewed.channels) {
      for (float value : channel.values) ASSERT_NEAR(value, channel.values[0], 1e-4F) << name;
    }
  }
}

TEST(Chain, WithoutNoiseEveryParameterOfTheNoiseIsWithoutEffect) {
  CctvCamera camera = linear_camera();
  camera.noise = NoiseMode::Law;  // a = b = c = 0
  const base::Image in = painted(64, 48, slope);
  Options other;
  other.seed = 77;
  const Result a = degrade(in, camera, {});
  camera.noise = NoiseMode::None;
  const Result b = degrade(in, camera, {}, other);
  EXPECT_EQ(a.signal.channels[0].values, b.signal.channels[0].values);
  EXPECT_EQ(a.pixels, b.pixels);
}

TEST(Chain, NoiseFreeTwinHasTheSameExposure) {
  const base::Image in = painted(64, 48, slope);
  for (const Preset& preset : presets()) {
    Options twin;
    twin.off = {"signal-noise", "read-noise"};
    const Result noisy = degrade(in, preset.camera, {}),
                 clean = degrade(in, preset.camera, {}, twin);
    EXPECT_EQ(noisy.report.exposure.f_number, clean.report.exposure.f_number) << preset.name;
    EXPECT_EQ(noisy.report.exposure.gain, clean.report.exposure.gain) << preset.name;
  }
}

// z = (mean of n frames - twin) / (sigma(S) / sqrt(n)) has mean 0 and variance 1 over the N resels
// if signal and noise law are correct: mean z within 4 / sqrt(N), mean z^2 within 4 sqrt(2 / N) of
// 1.
TEST(Chain, MeanOfManyFramesIsTheTwinWithTheVarianceOfTheLaw) {
  CctvCamera camera = linear_camera();
  camera.noise = NoiseMode::Law;
  camera.noise_a = 4e-4;
  camera.noise_b = 2e-4;
  camera.noise_c = 9e-4;
  Monitor small;
  small.rows = 60;
  small.columns = 80;
  const base::Image in = painted(80, 60, slope);
  Options options;
  options.off = {"signal-noise", "read-noise", "spread"};
  const Plane twin = degrade(in, camera, small, options).signal.channels[0].values;
  options.off = {"spread"};
  constexpr int frames = 64;
  std::vector<double> sum(twin.size(), 0.0);
  for (int f = 0; f < frames; ++f) {
    options.frame = static_cast<std::uint64_t>(f);
    const Result result = degrade(in, camera, small, options);
    for (std::size_t i = 0; i < sum.size(); ++i) {
      sum[i] += static_cast<double>(result.signal.channels[0].values[i]);
    }
  }
  const NoiseLaw law = noise_law(camera);
  double z1 = 0.0, z2 = 0.0;
  const double count = static_cast<double>(twin.size());
  for (std::size_t i = 0; i < sum.size(); ++i) {
    const double s = static_cast<double>(twin[i]);
    const double z = (sum[i] / frames - s) / std::sqrt(law.variance(s) / frames);
    z1 += z / count;
    z2 += z * z / count;
  }
  EXPECT_NEAR(z1, 0.0, 4.0 / std::sqrt(count));
  EXPECT_NEAR(z2, 1.0, 4.0 * std::sqrt(2.0 / count));
}

// Blur follows the noise of the light, which becomes grain with correlated neighbours. The
// amplifier's noise follows the blur.
TEST(Chain, LightNoiseIsBlurredAmplifierNoiseIsNot) {
  CctvCamera camera = linear_camera();
  camera.blur_h = camera.blur_v = 1.0;
  camera.noise = NoiseMode::Law;
  Options options;
  options.off = {"spread"};
  const auto neighbours = [&] {
    const Result result = degrade(test::grey(4, 3, 0.5F), camera, {}, options);
    return test::correlation(result.signal.channels[0].values, result.signal.channels[0].values,
                             400, 300, 1, 0);
  };
  camera.noise_c = 1e-4;
  EXPECT_NEAR(neighbours(), 0.698, 0.02);  // I_1(2) / I_0(2)
  camera.noise_c = 0.0;
  camera.noise_a = 1e-4;
  EXPECT_NEAR(neighbours(), 0.0, 4.0 / std::sqrt(120'000.0));
}

TEST(Chain, ReportModeIsTenPercentOfEachPointAndDarkensNothing) {
  const CctvCamera camera = find_preset("report-1990")->camera;
  const Result result = degrade(test::grey(4, 3, 50.0F), camera, {});
  Plane linear = result.signal.channels[0].values;
  for (float& v : linear) v = static_cast<float>(std::pow(static_cast<double>(v), camera.gamma));
  const test::Moments m = test::moments(linear);
  constexpr double count = 120'000.0;
  EXPECT_NEAR(m.mean, 1.0, 4.0 * 0.1 / std::sqrt(count));
  EXPECT_NEAR(std::sqrt(m.variance), 0.1, 4.0 * 0.1 / std::sqrt(2.0 * count));
}

TEST(Chain, SameBytesForOneAndTwoThreads) {
  base::Image in = base::make_rgb_image(123, 77);
  for (std::size_t i = 0; i < in.pixel_count(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      in.channels[c].values[i] = static_cast<float>((i * 7919 + c * 31) % 503);
    }
  }
  for (const Preset& preset : presets()) {
    const auto run = [&](int threads) {
      const base::ThreadLimit limit(threads);
      return degrade(in, preset.camera, {});
    };
    const Result one = run(1), two = run(2);
    EXPECT_EQ(one.pixels, two.pixels) << preset.name;
    EXPECT_EQ(one.viewed.channels[0].values, two.viewed.channels[0].values) << preset.name;
  }
}

TEST(Chain, SquarePictureIsWrittenSquareAtThreePixelsPerResel) {
  const Result result = degrade(test::grey(512, 512, 1.0F), CctvCamera{}, {});
  EXPECT_EQ(result.report.sensor.columns, 300);
  EXPECT_EQ(result.report.sensor.rows, 300);
  EXPECT_EQ(result.columns, 900);
  EXPECT_EQ(result.rows, 900);
  EXPECT_EQ(result.pixels.size(), 900U * 900U);
}

// White on the screen is white in the file. Black is the screen's black plus room light: (1 +
// 0.796) / (100 + 0.796) = 0.01782, sRGB 0.1422, times 255 = 36.
TEST(Chain, FileShowsTheScreenUnderTheRoomsLight) {
  CctvCamera camera = linear_camera();
  EXPECT_EQ(degrade(test::grey(4, 3, 1.0F), camera, {}).pixels[0], 255);
  EXPECT_EQ(degrade(test::grey(4, 3, 0.0F), camera, {}).pixels[0], 36);
}

TEST(Chain, SinglePointOfLightStaysInItsPlace) {
  base::Image in = test::grey(300, 300, 0.0F);
  in.channels[0].values[100 * 300 + 200] = 1.0F;
  const Result result = degrade(in, linear_camera(), {});
  const auto& viewed = result.viewed.channels[0].values;
  const auto brightest = std::max_element(viewed.begin(), viewed.end()) - viewed.begin();
  EXPECT_EQ(brightest / 900, 301);  // middle pixel of resel row 100
  EXPECT_EQ(brightest % 900, 601);
}

// White and black by turns, 2 channels: a pixel of half the width covers both, one of 2/3 the width
// all of the first and half of the second, or the other way round.
TEST(Chain, AResizedScreenHasMeansOfTheLinearSignal) {
  const auto resized = [](std::vector<std::uint8_t> bytes, int channels, int columns, int rows,
                          int new_columns, int new_rows) {
    Result result;
    result.columns = columns;
    result.rows = rows;
    result.channels = channels;
    result.pixels = std::move(bytes);
    resize_screen(result, new_columns, new_rows);
    EXPECT_EQ(result.columns, new_columns);
    EXPECT_EQ(result.rows, new_rows);
    return result.pixels;
  };
  using Bytes = std::vector<std::uint8_t>;
  const Bytes row = {255, 0, 0, 255, 255, 0, 0, 255, 255, 0, 0, 255};
  EXPECT_EQ(resized(row, 2, 6, 1, 6, 1), row);
  const std::uint8_t half = base::srgb_byte(0.5), third = base::srgb_byte(1.0 / 3.0),
                     most = base::srgb_byte(2.0 / 3.0);
  EXPECT_EQ(resized(row, 2, 6, 1, 3, 1), Bytes(6, half));
  EXPECT_EQ(resized(row, 2, 6, 1, 4, 1),
            (Bytes{most, third, most, third, third, most, third, most}));
  EXPECT_EQ(resized({255, 0}, 1, 1, 2, 2, 4), (Bytes{255, 255, 255, 255, 0, 0, 0, 0}));
  EXPECT_EQ(resized({255, 0}, 1, 2, 1, 1, 3), Bytes(3, half));
}

}  // namespace
}  // namespace earthshine::degrade
