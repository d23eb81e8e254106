// SPDX-License-Identifier: Apache-2.0
// Limits of a sight: the limiting frequency, and the least of size, noise and the eye.
#include <gtest/gtest.h>

#include <cmath>

#include "degrade/settings/presets.h"
#include "studies/sight/cctv_signal.h"
#include "studies/sight/target_signal.h"
#include "tests/studies/discs.h"

namespace earthshine::studies {
namespace {

using tests::bright_disc;
using tests::disc_edge;
using tests::discs_on;
using tests::plain_cctv;
using tests::sight_of;
using tests::with_noise;

// C0 MTF(u) = 3 / SNR: at the limiting frequency the difference after the chain is three times the
// noise of a bar, half a period wide and as long as the target: the noise of the target's mean
// times the square root of the number of bars, 2 u lines.
TEST(SightLimits, LimitingFrequencyLeavesThreeTimesTheNoiseOfABar) {
  degrade::Setup setup = with_noise(plain_cctv(disc_edge, disc_edge, 100.0), 0.25);
  setup.camera.lens_blur = 1.0;
  const auto picture = bright_disc();
  const Sight sight = sight_of(picture, setup);
  const double u = *sight.signal->limiting_frequency, lines = *sight.tv_lines;
  const auto n = static_cast<double>(picture.plan.targets[0].seen.size());
  const double delta = sight.signal->mean - *sight.signal->surround;
  const double expected = 3.0 * std::sqrt(0.25 / (6.0 * n) * 2.0 * u * lines) / delta;
  EXPECT_GT(2.0 * u * lines, 4.0);
  EXPECT_LT(u, 0.3);
  EXPECT_NEAR(chain_modulation(setup, picture.plan.targets[0].extent.direction_rad, u), expected,
              1e-3 * expected);
  EXPECT_NEAR(*sight.johnson_cycles, lines * u, 1e-9);
}

// Noise blurred with the picture is as wide as this target: the variance of a bar equals the
// variance of a resel. C0 / (3 / SNR) is then CNR sqrt(6 frames) / 3.
TEST(SightLimits, ABarIsNoNoisierThanAResel) {
  degrade::Setup setup = with_noise(plain_cctv(disc_edge, disc_edge, 100.0), 0.0, 0.03);
  setup.camera.blur_h = setup.camera.blur_v = 2.0;
  const auto picture = discs_on(50.0, {{60.0, 60.0, 3.0, 90.0}}, disc_edge, disc_edge);
  SightOptions any_contrast;
  any_contrast.eye.threshold_factor = 0.0;
  const Sight sight = sight_of(picture, setup, any_contrast);
  const double u = *sight.signal->limiting_frequency;
  EXPECT_GT(2.0 * u * *sight.tv_lines, 1.5);
  const double expected = 3.0 / (*sight.signal->cnr * std::sqrt(6.0));
  EXPECT_NEAR(chain_modulation(setup, picture.plan.targets[0].extent.direction_rad, u), expected,
              1e-2 * expected);
}

// A grating through the whole chain: its amplitude on the screen, by projection.
TEST(SightLimits, ModulationIsThatOfAGratingOnTheScreen) {
  constexpr int resels = 96, fine = 8;
  degrade::Setup setup = plain_cctv(resels, resels, 100.0);
  setup.camera.lens_blur = 0.3;
  setup.camera.blur_h = 0.5;
  setup.camera.blur_v = 0.2;
  setup.camera.bandwidth_mhz = 0.6;
  setup.camera.aperture_correction = 0.3;
  setup.monitor.pixels_per_resel = 3;
  setup.monitor.spread_width = 0.9;
  for (const degrade::Spread spread : {degrade::Spread::Gaussian, degrade::Spread::Triangle}) {
    setup.monitor.spread = spread;
    for (const bool upright : {true, false}) {
      for (const int periods : {12, 36}) {
        base::Image image = base::make_rgb_image(resels * fine, resels * fine);
        for (std::size_t i = 0; i < image.pixel_count(); ++i) {
          const std::size_t x = i % (resels * fine), y = i / (resels * fine);
          const double phase = 2.0 * base::pi * periods *
                               (static_cast<double>(upright ? x : y) + 0.5) / (resels * fine);
          for (base::Channel& c : image.channels) {
            c.values[i] = static_cast<float>(50.0 + 20.0 * std::cos(phase));
          }
        }
        const degrade::Result shown = degrade::degrade(image, setup.camera, setup.monitor);
        const std::size_t wide = resels * 3;
        double c = 0.0, s = 0.0;  // of a line in the middle; the mirrored border ends half periods
        for (std::size_t k = 0; k < wide; ++k) {
          const double phase =
              2.0 * base::pi * periods * (static_cast<double>(k) + 0.5) / static_cast<double>(wide);
          const double v = static_cast<double>(
              shown.viewed.channels[0].values[upright ? wide / 2 * wide + k : k * wide + wide / 2]);
          c += v * std::cos(phase) * 2.0 / static_cast<double>(wide);
          s += v * std::sin(phase) * 2.0 / static_cast<double>(wide);
        }
        EXPECT_NEAR(std::hypot(c, s) / 20.0,
                    chain_modulation(setup, upright ? 0.0 : 0.5 * base::pi,
                                     static_cast<double>(periods) / resels),
                    0.004)
            << static_cast<int>(spread) << upright << periods;
      }
    }
  }
}

TEST(SightLimits, ProbabilityIsTheLeastOfSizeNoiseAndTheEye) {
  const degrade::Setup setup = with_noise(plain_cctv(disc_edge, disc_edge, 100.0), 0.01);
  const auto picture = bright_disc();
  const Sight sight = sight_of(picture, setup);
  EXPECT_GT(sight.probability->identify, 0.9);
  SightOptions noise, eye;
  noise.even_chance_snr = *sight.signal->snr_d;
  eye.eye.threshold_factor = *sight.monitor->weber / *sight.monitor->threshold;
  eye.cycles = {1e-9, 1e-9, 1e-9};
  const Probability by_noise = *sight_of(picture, setup, noise).probability;
  for (const double p : {by_noise.detect, by_noise.recognise, by_noise.identify}) {
    EXPECT_NEAR(p, 0.5, 1e-6);
  }
  // Below the eye's threshold no frequency is resolved; at 1.02 times it P = 1 - 2^-(1.02^3.5).
  const double at_threshold = eye.eye.threshold_factor;
  eye.eye.threshold_factor = 1.02 * at_threshold;
  EXPECT_EQ(sight_of(picture, setup, eye).probability->detect, 0.0);
  eye.eye.threshold_factor = at_threshold / 1.02;
  EXPECT_NEAR(sight_of(picture, setup, eye).probability->detect,
              1.0 - std::exp2(-std::pow(1.02, 3.5)), 0.01);
}

// Left of the middle brighter than the ground by 20, right of it darker by 20: no difference on
// average, but 20 everywhere.
TEST(SightLimits, TargetLitFromOneSideStandsOutOnBoth) {
  auto picture = discs_on(40.0, {{60.0, 60.0, 20.0, 40.0}}, disc_edge, disc_edge);
  for (const std::uint32_t pixel : picture.plan.targets[0].seen) {
    for (base::Channel& c : picture.image.channels) {
      c.values[pixel] = pixel % disc_edge < 60 ? 60.0F : 20.0F;
    }
  }
  ASSERT_EQ(picture.plan.targets[0].parts.size(), 8U);
  const Sight sight = sight_of(picture, plain_cctv(disc_edge, disc_edge, 100.0));
  EXPECT_NEAR(*sight.weber, 0.0, 1e-3);
  EXPECT_NEAR(*sight.signal->difference, 0.2, 0.01);  // sectors may share the middle
  EXPECT_GT(sight.probability->identify, 0.9);
  EXPECT_GT(sight.eye->probability->identify, 0.9);
}

TEST(SightLimits, PartsAreThoseOfLargeTargets) {
  EXPECT_TRUE(bright_disc(3.0).plan.targets[0].parts.empty());
  double share = 0.0;
  std::size_t pixels = 0;
  const auto picture = bright_disc();
  for (const SightTarget::Part& part : picture.plan.targets[0].parts) {
    share += part.share;
    pixels += part.target.size();
    EXPECT_GE(part.surround.size(), 16U);
  }
  EXPECT_NEAR(share, 1.0, 1e-12);
  EXPECT_EQ(pixels, picture.plan.targets[0].view.measured.size());
}

TEST(SightLimits, JohnsonDecidesWhereContrastIsAmple) {
  // Without noise the Nyquist frequency of the resels is the limit: n = lines / 2.
  for (const double radius : {1.0, 4.0, 8.0}) {
    const Sight sight = sight_of(bright_disc(radius), plain_cctv(disc_edge, disc_edge, 100.0));
    EXPECT_EQ(*sight.signal->limiting_frequency, 0.5);
    const Probability p = johnson_probability(0.5 * *sight.tv_lines, CyclesNeeded{});
    EXPECT_NEAR(sight.probability->detect, p.detect, 1e-9);
    EXPECT_NEAR(sight.probability->identify, p.identify, 1e-9);
  }
}

// Simulates the fields of a bar of `extent` resels that moves by `speed` per field through a tube
// with lag: the signal at the bar's position in the steady state.
TEST(SightLimits, TrailIsThatOfALaggingTube) {
  constexpr int extent = 12, speed = 5, fields = 400, width = extent + speed * fields;
  constexpr double lag = 0.7;
  std::vector<double> charge(width, 0.0);
  for (int k = 0; k <= fields - 1; ++k) {
    for (int x = 0; x < width; ++x) {
      const double light = x >= k * speed && x < k * speed + extent ? 1.0 : 0.0;
      charge[static_cast<std::size_t>(x)] =
          (1.0 - lag) * light + lag * charge[static_cast<std::size_t>(x)];
    }
  }
  double mean = 0.0;
  for (int x = 0; x < extent; ++x) {
    mean += charge[static_cast<std::size_t>((fields - 1) * speed + x)] / extent;
  }
  EXPECT_NEAR((Trail{lag, speed, 0.0}.share(extent)), mean, 1e-8);
  EXPECT_EQ((Trail{lag, 0.0, 0.0}.share(extent)), 1.0);
  EXPECT_EQ((Trail{0.0, speed, 0.0}.share(extent)), 1.0);
  EXPECT_NEAR((Trail{lag, extent, 0.0}.share(extent)), 1.0 - lag, 1e-12);
}

// Half a period per field: successive fields have opposite phases, (1 - lag) / (1 + lag). Across
// the motion nothing is lost.
TEST(SightLimits, TrailTakesFineStructureAlongItsWayOnly) {
  const Trail trail{0.6, 2.0, 0.0};
  EXPECT_NEAR(trail.modulation(0.0, 0.25), 0.4 / 1.6, 1e-12);
  EXPECT_NEAR(trail.modulation(0.5 * base::pi, 0.25), 1.0, 1e-12);
  EXPECT_NEAR(trail.modulation(0.0, 0.0), 1.0, 1e-12);
}

TEST(SightLimits, BlackBackIsDoubtfulAtBest) {
  auto picture = tests::discs_on(40.0, {{60.0, 60.0, 20.0, 0.0}}, 120, 120);
  EXPECT_EQ(tests::sight_of(picture, {}).verdict, Verdict::Identified);
  EXPECT_EQ(*tests::sight_of(picture, {}).black_back, 0.0);
  SightTarget& target = picture.plan.targets[0];
  target.view.black_back.assign(
      target.seen.begin(),
      target.seen.begin() + static_cast<std::ptrdiff_t>(target.seen.size() / 2));
  target.view.black_back.pop_back();  // less than half of it
  EXPECT_EQ(tests::sight_of(picture, {}).verdict, Verdict::Identified);
  target.view.black_back = target.seen;
  EXPECT_EQ(tests::sight_of(picture, {}).verdict, Verdict::Doubtful);
}

// The chain's levels, counted in the signal, equal the counts by the range traced back to the
// scene: pixel by pixel in a picture of one pixel per resel, without stages that mix pixels or vary
// over the picture.
TEST(SightLimits, ShownRangeAgreesWithTheChainsLevels) {
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

// Shares of the pixels of a disc, a quarter white and the rest black, also if the camera has a
// resel for four pixels: the resel at its centre decides about a pixel.
TEST(SightLimits, ClippedSharesAreOfPixelsByTheReselOfTheirCentre) {
  constexpr int width = 180, height = 120;
  auto picture = discs_on(0.0, {{90.0, 60.0, 20.0, 0.0}}, width, height);
  for (base::Channel& channel : picture.image.channels) {
    for (std::size_t i = 0; i < channel.values.size(); ++i) {
      if (i % width < width / 2 && i / width < height / 2) channel.values[i] = 100.0F;
    }
  }
  for (const int pixels : {1, 2}) {
    const degrade::Setup setup =
        with_noise(plain_cctv(width / pixels, height / pixels, 100.0), 1e-4);
    const Sight sight = sight_of(picture, setup);
    EXPECT_EQ(*sight.saturated, 0.25) << pixels;
    EXPECT_EQ(*sight.crushed, 0.75) << pixels;
  }
}

}  // namespace
}  // namespace earthshine::studies
