// SPDX-License-Identifier: Apache-2.0
#include "studies/targets/visibility.h"

#include <gtest/gtest.h>

#include <cmath>

#include "degrade/settings/presets.h"
#include "tests/studies/plates.h"

namespace earthshine::studies {
namespace {

TargetMetrics only_metrics(const scenes::Scene& scene, const scenes::Camera& camera, int size,
                           const std::optional<ShownRange>& range = {}) {
  const auto frame = tests::direct_picture(scene, camera, size);
  std::optional<ClippedResels> cctv;
  if (range) {  // a resel for each pixel
    cctv = ClippedResels{size, size, {}, {}};
    for (const float y : base::luminance_of(frame.image)) {
      cctv->saturated.push_back(double(y) >= range->white ? 1.0F : 0.0F);
      cctv->crushed.push_back(double(y) <= range->black ? 1.0F : 0.0F);
    }
  }
  const auto metrics = target_metrics(scene, camera, frame.image, cctv);
  EXPECT_EQ(metrics.size(), 1U);
  return metrics.front();
}

// Under one Sun the luminances are rho E / pi, so that C = rho_t / rho_b - 1, whatever part of a
// pixel the plate's edge cuts off: 37 pixels on 1.7 m put it anywhere.
TEST(Visibility, WeberContrastOfAPlateOnGroundIsExact) {
  for (const auto& [ground, plate] : {std::pair{0.4, 0.6}, {0.8, 0.2}, {0.5, 0.5}, {0.5, 0.0}}) {
    auto builder = tests::plate_on_ground(ground, plate);
    builder.scene.sun = tests::overhead_sun(1000.0);
    const TargetMetrics target = only_metrics(builder.scene, tests::above(2.0, 1.7), 37);
    ASSERT_TRUE(target.light && target.light->contrast);
    EXPECT_NEAR(target.light->luminance, plate * 1000.0 / base::pi, 1e-3);
    EXPECT_NEAR(*target.light->surround, ground * 1000.0 / base::pi, 1e-3);
    EXPECT_NEAR(*target.light->contrast, plate / ground - 1.0, 1e-5);
    EXPECT_EQ(target.visible_fraction, 1.0);
    EXPECT_FALSE(target.saturated_share || target.crushed_share);
  }
}

TEST(Visibility, NothingIsSaidWhereThereIsNothingToCompareWith) {
  auto builder = tests::plate_on_ground(0.0, 0.5);
  builder.scene.sun = tests::overhead_sun(1000.0);
  const TargetMetrics on_black = only_metrics(builder.scene, tests::above(2.0, 2.0), 32);
  EXPECT_EQ(on_black.light->surround, 0.0);
  EXPECT_FALSE(on_black.light->contrast);
  const TargetMetrics alone = only_metrics(builder.scene, tests::above(2.0, 0.5), 16);
  EXPECT_NEAR(alone.light->luminance, 500.0 / base::pi, 1e-3);
  EXPECT_FALSE(alone.light->surround || alone.light->contrast);
}

TEST(Visibility, TargetOutOfTheFrameHasNoMetrics) {
  auto builder = tests::plate_on_ground(0.4, 0.6);
  scenes::Camera away = tests::above(2.0, 1.0);
  away.look_at = Vec3(9, 0, 9);
  const TargetMetrics target = only_metrics(builder.scene, away, 16, ShownRange{1.0, 2.0});
  EXPECT_FALSE(target.visible_fraction || target.light || target.saturated_share ||
               target.crushed_share);
}

TEST(Visibility, SharesBeyondTheShownRangeCountTheTargetsPixels) {
  // Sun on the half x > 0 of the plate only: a screen far above, out of the camera's sight.
  auto builder = tests::plate_on_ground(0.4, 0.6);
  builder.quad(0, {-3, -3, 9}, {0, -3, 9}, {0, 3, 9}, {-3, 3, 9});
  builder.scene.sun = tests::overhead_sun(1000.0);
  const double lit = 0.6 * 1000.0 / base::pi;
  const auto shares = [&](double black, double white) {
    const TargetMetrics target =
        only_metrics(builder.scene, tests::above(2.0, 2.0), 32, ShownRange{black, white});
    return std::pair{*target.saturated_share, *target.crushed_share};
  };
  EXPECT_EQ(shares(0.01 * lit, 0.99 * lit), (std::pair{0.5, 0.5}));
  EXPECT_EQ(shares(0.01 * lit, 1.01 * lit), (std::pair{0.0, 0.5}));
  EXPECT_EQ(shares(-1.0, 0.99 * lit), (std::pair{0.5, 0.0}));
}

// The chain's own counts, taken from the signal, are those of the range carried back to the scene:
// on a picture of one pixel per resel, pixel by pixel, with all off that is not the same everywhere
// or that mixes them.
TEST(Visibility, ShownRangeAgreesWithTheChainsLevels) {
  constexpr int edge = 300;
  base::Image image = base::make_rgb_image(edge, edge);
  std::vector<float> luminance(image.pixel_count());
  double sum = 0.0;
  for (std::size_t i = 0; i < luminance.size(); ++i) {
    const double t = std::fmod(static_cast<double>(i) * 0.6180339887498949, 1.0);
    luminance[i] = static_cast<float>(100.0 * std::pow(10.0, 7.0 * t - 5.0));  // 1e-3 to 1e4
    sum += double(luminance[i]);
  }
  for (base::Channel& channel : image.channels) channel.values = luminance;
  const double mean = sum / static_cast<double>(luminance.size());
  for (const degrade::Preset& preset : degrade::presets()) {
    for (const double glare : {0.0, preset.camera.glare}) {
      degrade::CctvCamera camera = preset.camera;
      camera.glare = glare;
      degrade::Options options;
      options.off = {"signal-noise", "read-noise", "shading",  "blur",
                     "smear",        "bloom",      "bandwidth"};
      const degrade::Result result = degrade::degrade(image, camera, {}, options);
      const ShownRange shown = shown_range(camera, result.report, mean);
      double saturated = 0.0, crushed = 0.0;
      for (const float y : luminance) {
        if (double(y) >= shown.white) saturated += 1.0;
        if (double(y) <= shown.black) crushed += 1.0;
      }
      // Single precision may move a pixel or two over a threshold.
      const auto count = static_cast<double>(luminance.size());
      EXPECT_NEAR(saturated / count, result.report.levels.saturated_share, 3.0 / count)
          << preset.name;
      EXPECT_NEAR(crushed / count, result.report.levels.crushed_share, 3.0 / count) << preset.name;
    }
  }
}

// Pixels are judged by the resel in which their centre lies, here four by four pixels to one: only
// the resels of the lower half are white.
TEST(Visibility, PixelsBelongToTheReselOfTheirCentre) {
  auto builder = tests::plate_on_ground(0.4, 0.6);
  builder.scene.sun = tests::overhead_sun(1000.0);
  const scenes::Camera camera = tests::above(2.0, 2.0);
  const auto frame = tests::direct_picture(builder.scene, camera, 32);
  ClippedResels resels{8, 8, degrade::Plane(64, 0.0F), degrade::Plane(64, 1.0F)};
  for (std::size_t i = 32; i < 64; ++i) resels.saturated[i] = 1.0F;
  const auto metrics = target_metrics(builder.scene, camera, frame.image, resels);
  EXPECT_EQ(metrics.front().saturated_share, 0.5);
  EXPECT_EQ(metrics.front().crushed_share, 1.0);
}

}  // namespace
}  // namespace earthshine::studies
