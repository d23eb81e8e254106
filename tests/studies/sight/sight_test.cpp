// SPDX-License-Identifier: Apache-2.0
#include "studies/sight/sight.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "degrade/settings/presets.h"
#include "degrade/twin.h"
#include "tests/studies/discs.h"

namespace earthshine::studies {
namespace {

using tests::bright_disc;
using tests::disc_edge;
using tests::discs_on;
using tests::plain_cctv;
using tests::sight_of;
using tests::with_noise;

double noise_at(double s, double a, double b, double c) { return a + b * s + c * s * s; }

TEST(Sight, ContrastsOfADiscAreThoseOfItsRadiances) {
  const Sight sight = sight_of(bright_disc(), plain_cctv(disc_edge, disc_edge, 100.0));
  EXPECT_NEAR(*sight.luminance, 60.0, 1e-4);
  EXPECT_NEAR(*sight.surround, 40.0, 1e-4);
  EXPECT_NEAR(*sight.weber, 0.5, 1e-5);
  EXPECT_NEAR(sight.signal->mean, 0.6, 1e-6);
  EXPECT_NEAR(*sight.signal->surround, 0.4, 1e-6);
  EXPECT_NEAR(*sight.signal->weber, 0.5, 1e-5);
  EXPECT_NEAR(sight.monitor->luminance, 60.0, 1e-4);
  EXPECT_NEAR(*sight.monitor->weber, 0.5, 1e-5);
  EXPECT_EQ(sight.visible_fraction, 1.0);
  EXPECT_EQ(sight.verdict, Verdict::Identified);
}

TEST(Sight, RoomLightAndBlackLevelTakeContrastFromTheMonitor) {
  degrade::Setup setup = plain_cctv(disc_edge, disc_edge, 100.0);
  setup.monitor.black_luminance = 2.0;
  setup.monitor.room_illuminance = 100.0 * base::pi;  // at 5 %: 5 cd/m^2
  const Sight sight = sight_of(bright_disc(), setup);
  EXPECT_NEAR(sight.monitor->luminance, 5.0 + 2.0 + 98.0 * 0.6, 1e-3);
  EXPECT_NEAR(*sight.monitor->weber, 98.0 * 0.2 / (7.0 + 98.0 * 0.4), 1e-5);
}

TEST(Sight, PixelsAndLinesOfADisc) {
  // 240 rows of picture on 120 lines: 40 pixels across are 20 lines.
  const auto picture = discs_on(40.0, {{120.0, 120.0, 20.0, 60.0}}, 240, 240);
  const Sight sight = sight_of(picture, plain_cctv(disc_edge, disc_edge, 100.0));
  EXPECT_NEAR(static_cast<double>(sight.pixels), base::pi * 400.0, 10.0);
  EXPECT_NEAR(*sight.tv_lines, 20.0, 0.25);
  EXPECT_NEAR(*sight_of(picture, {}).tv_lines, 40.0, 0.5);  // rows of the picture
}

// Without filters noise is white, and samples are independent over resels and frames.
TEST(Sight, NoiseFiguresOfADiscAreTheirClosedForms) {
  const double a = 4e-4, b = 3e-4, c = 5e-4;
  const auto picture = bright_disc();
  const Sight sight =
      sight_of(picture, with_noise(plain_cctv(disc_edge, disc_edge, 100.0), a, b, c));
  const double t = noise_at(0.6, a, b, c), s = noise_at(0.4, a, b, c), frames = 6.0;
  const auto n = static_cast<double>(picture.plan.targets[0].seen.size());
  const auto n_b = static_cast<double>(picture.plan.targets[0].view.surround.size());
  const double cnr = 0.2 / std::sqrt(0.5 * (t + s));
  EXPECT_NEAR(sight.signal->snr, 0.6 / std::sqrt(t), 1e-4 * sight.signal->snr);
  EXPECT_NEAR(*sight.signal->cnr, cnr, 1e-4 * cnr);
  const double rose = cnr * std::sqrt(n * frames);
  EXPECT_NEAR(*sight.signal->rose, rose, 1e-4 * rose);
  const double d = 0.2 * std::sqrt(n * frames / t);
  EXPECT_NEAR(*sight.signal->dprime, d, 1e-4 * d);
  const double snr_d = 0.2 / std::sqrt((t / n + s / n_b) / frames);
  EXPECT_NEAR(*sight.signal->snr_d, snr_d, 1e-4 * snr_d);
}

TEST(Sight, LongerLooksAverageGrainButNoFixedPattern) {
  degrade::Setup grain = with_noise(plain_cctv(disc_edge, disc_edge, 100.0), 1e-3), pattern = grain;
  pattern.camera.noise = degrade::NoiseMode::Photon;
  pattern.camera.electrons_at_white = 1e9;
  pattern.camera.prnu_percent = 5.0;
  SightOptions longer;
  longer.eye_integration_s = 0.8;
  const auto picture = bright_disc();
  const auto gain = [&](const degrade::Setup& setup) {
    return *sight_of(picture, setup, longer).signal->rose / *sight_of(picture, setup).signal->rose;
  };
  EXPECT_NEAR(gain(grain), 2.0, 1e-6);  // 24 frames for 6
  EXPECT_NEAR(gain(pattern), 1.0, 1e-4);
}

TEST(Sight, NothingIsDetectedWithoutContrastInNoiseOrInWhite) {
  const degrade::Setup quiet = plain_cctv(disc_edge, disc_edge, 100.0);
  const auto same = discs_on(40.0, {{60.0, 60.0, 20.0, 40.0}}, disc_edge, disc_edge);
  EXPECT_LT(sight_of(same, quiet).probability->detect, 0.01);
  EXPECT_LT(sight_of(same, {}).probability->detect, 0.01);  // to the eye
  EXPECT_EQ(sight_of(same, quiet).verdict, Verdict::NotSeen);
  EXPECT_LT(sight_of(bright_disc(3.0), with_noise(quiet, 25.0)).probability->detect, 0.05);
  degrade::Setup blown = plain_cctv(disc_edge, disc_edge, 10.0);
  blown.camera.white_clip = 1.1;
  const Sight white = sight_of(bright_disc(), blown);
  EXPECT_LT(white.probability->detect, 0.01);
  EXPECT_EQ(white.saturated, 1.0);
}

TEST(Sight, SaturatedFromWhiteAndCrushedWithinTheNoiseOfBlack) {
  const degrade::Setup setup =
      with_noise(plain_cctv(disc_edge, disc_edge, 100.0), 1e-4);  // black: S <= 0.01
  const auto shares = [&](double luminance) {
    const Sight s =
        sight_of(discs_on(40.0, {{60.0, 60.0, 20.0, luminance}}, disc_edge, disc_edge), setup);
    EXPECT_NEAR(*s.shown_from, 1.0, 1e-9);
    EXPECT_NEAR(*s.shown_to, 99.5, 1e-9);
    return std::pair{*s.saturated, *s.crushed};
  };
  EXPECT_EQ(shares(99.6), (std::pair{1.0, 0.0}));
  EXPECT_EQ(shares(99.4), (std::pair{0.0, 0.0}));
  EXPECT_EQ(shares(0.99), (std::pair{0.0, 1.0}));
  EXPECT_EQ(shares(1.01), (std::pair{0.0, 0.0}));
}

TEST(Sight, EyeAtTheWindowComparesWithItsThreshold) {
  const auto picture =
      discs_on(100.0, {{60.0, 60.0, 1.5, 100.0 + std::pow(10.0, 0.745)}}, disc_edge, disc_edge);
  const Sight sight = sight_of(picture, {});
  EXPECT_FALSE(sight.signal || sight.monitor || sight.saturated || sight.johnson_cycles);
  EXPECT_NEAR(*sight.eye->threshold, std::pow(10.0, 0.745) / 100.0, 1e-3);
  EXPECT_NEAR(sight.eye->probability->detect, 0.5, 0.01);  // at threshold
  EXPECT_NEAR(sight.eye->cycles, *sight.angle_deg * acuity_cycles_per_deg(100.0), 0.01);
  EXPECT_NEAR(sight.eye->probability->identify, 0.5, 0.01);  // a degree is many cycles
  const auto brighter = discs_on(100.0, {{60.0, 60.0, 1.5, 100.0 + 2.0 * std::pow(10.0, 0.745)}},
                                 disc_edge, disc_edge);
  EXPECT_EQ(sight_of(brighter, {}).verdict, Verdict::Identified);
}

TEST(Sight, VerdictGoesByVisibleFractionAndProbability) {
  EXPECT_EQ(sight_of(bright_disc(2.0), plain_cctv(disc_edge, disc_edge, 100.0)).verdict,
            Verdict::Detected);
  const auto behind = discs_on(40.0, {{60.0, 60.0, 20.0, 60.0}, {60.0, 60.0, 19.6, 40.0, false}},
                               disc_edge, disc_edge);
  EXPECT_LT(*sight_of(behind, {}).visible_fraction, 0.1);
  EXPECT_EQ(sight_of(behind, {}).verdict, Verdict::Hidden);
  const auto away = discs_on(40.0, {{-60.0, 60.0, 20.0, 60.0}}, disc_edge, disc_edge);
  const Sight out = sight_of(away, plain_cctv(disc_edge, disc_edge, 100.0));
  EXPECT_EQ(out.verdict, Verdict::OutOfView);
  EXPECT_FALSE(out.probability || out.visible_fraction || out.luminance || out.angle_deg ||
               out.eye || out.signal || out.tv_lines);
  EXPECT_TRUE(out.shown_from && out.shown_to);
  EXPECT_EQ(word_of(out.verdict), "out-of-view");
  EXPECT_EQ(word_of(Verdict::NotSeen), "not-seen");
}

void expect_finite(const Sight& sight, const std::string& what) {
  const auto finite = [&](double value) { EXPECT_TRUE(std::isfinite(value)) << what; };
  const auto maybe = [&](const std::optional<double>& value) {
    if (value) finite(*value);
  };
  const auto likely = [&](const std::optional<Probability>& p) {
    if (!p) return;
    for (const double value : {p->detect, p->recognise, p->identify}) {
      EXPECT_TRUE(value >= 0.0 && value <= 1.0) << what;
    }
  };
  likely(sight.probability);
  for (const auto& value : {sight.visible_fraction, sight.angle_deg, sight.tv_lines,
                            sight.luminance, sight.surround, sight.weber, sight.johnson_cycles,
                            sight.saturated, sight.crushed, sight.shown_from, sight.shown_to}) {
    maybe(value);
  }
  if (sight.signal) {
    finite(sight.signal->mean);
    finite(sight.signal->snr);
    for (const auto& value :
         {sight.signal->surround, sight.signal->weber, sight.signal->cnr, sight.signal->rose,
          sight.signal->snr_d, sight.signal->dprime, sight.signal->limiting_frequency}) {
      maybe(value);
    }
  }
  if (sight.monitor) {
    finite(sight.monitor->luminance);
    for (const auto& v :
         {sight.monitor->surround, sight.monitor->weber, sight.monitor->threshold}) {
      maybe(v);
    }
  }
  if (!sight.eye) return;
  for (const double v : {sight.eye->adaptation, sight.eye->acuity, sight.eye->cycles}) finite(v);
  maybe(sight.eye->threshold);
  maybe(sight.eye->weber);
  likely(sight.eye->probability);
}

TEST(Sight, WhatDoesNotExistIsEmptyAndAllElseFinite) {
  struct Case {
    const char* name;
    tests::DiscPicture picture;
  };
  const std::vector<Case> cases = {
      {"no pixels", discs_on(40.0, {{-60.0, 60.0, 20.0, 60.0}}, disc_edge, disc_edge)},
      {"one pixel", discs_on(40.0, {{60.5, 60.5, 0.6, 60.0}}, disc_edge, disc_edge)},
      {"one pixel in the corner", discs_on(40.0, {{0.5, 0.5, 0.6, 60.0}}, disc_edge, disc_edge)},
      {"black surround", discs_on(0.0, {{60.0, 60.0, 20.0, 60.0}}, disc_edge, disc_edge)},
      {"fills the picture", discs_on(0.0, {{60.0, 60.0, 500.0, 60.0}}, disc_edge, disc_edge)},
      {"all black", discs_on(0.0, {{60.0, 60.0, 20.0, 0.0}}, disc_edge, disc_edge)},
      {"very bright", discs_on(1e9, {{60.0, 60.0, 20.0, 1e9}}, disc_edge, disc_edge)}};
  for (const auto& [name, picture] : cases) {
    std::vector<std::optional<degrade::Setup>> setups = {std::nullopt,
                                                         plain_cctv(disc_edge, disc_edge, 100.0)};
    for (const degrade::Preset& preset : degrade::presets()) {
      setups.push_back(degrade::Setup{preset.camera, preset.monitor, {}});
    }
    for (const auto& setup : setups) expect_finite(sight_of(picture, setup), name);
  }
  const Sight filled = sight_of(cases[4].picture, plain_cctv(disc_edge, disc_edge, 100.0));
  EXPECT_FALSE(filled.probability || filled.surround || filled.weber || filled.signal->surround ||
               filled.signal->cnr || filled.monitor->weber || filled.eye->threshold);
  EXPECT_NEAR(filled.signal->mean, 0.6, 1e-6);
  EXPECT_EQ(filled.verdict, Verdict::Doubtful);
  const Sight on_black = sight_of(cases[3].picture, plain_cctv(disc_edge, disc_edge, 100.0));
  EXPECT_FALSE(on_black.weber || on_black.signal->weber || on_black.monitor->weber);
  EXPECT_EQ(on_black.verdict, Verdict::Identified);
  EXPECT_EQ(on_black.signal->snr, degrade::most_snr);
}

TEST(Sight, PicturesOfAnotherSizeAreRefused) {
  const auto picture = bright_disc();
  EXPECT_THROW((void)measure_sight(picture.plan, base::make_rgb_image(8, 8), {}), base::Error);
}

// Standard errors of 5 and of 0 for the difference from the surround, 20 cd/m^2. By eye and by
// CCTV, the verdicts at the bounds equal the verdicts of pictures with the difference times
// 1 -+ 1.96 / 4; without an error both equal the verdict itself.
TEST(Sight, BoundsOfAVerdictAreVerdictsAtTheEndsOfTheDifferencesInterval) {
  const auto disc = [](double contrast) {
    return discs_on(40.0, {{60.0, 60.0, 3.0, 40.0 + 20.0 * contrast}}, disc_edge, disc_edge);
  };
  const std::array<double, 1> deviation{5.0}, none{0.0};
  const double low = 1.0 - 1.96 / 4.0, high = 1.0 + 1.96 / 4.0;
  int moved = 0;
  for (const double noise : {1e-4, 1e-2, 0.05, 0.1, 0.2, 0.4, 0.8, 1.6}) {
    const auto cctv = with_noise(plain_cctv(disc_edge, disc_edge, 100.0), noise, 0.0, 0.0);
    const auto picture = disc(1.0);
    ASSERT_TRUE(picture.plan.targets[0].parts.empty());
    const auto verdict_at = [&](double contrast) {
      const auto other = disc(contrast);
      return measure_sight(other.plan, other.image, cctv).targets[0].verdict;
    };
    const Sight sure = measure_sight(picture.plan, picture.image, cctv, {}, none).targets[0];
    EXPECT_EQ(sure.verdict_low, sure.verdict);
    EXPECT_EQ(sure.verdict_high, sure.verdict);
    const Sight sight = measure_sight(picture.plan, picture.image, cctv, {}, deviation).targets[0];
    EXPECT_EQ(sight.verdict, sure.verdict);
    EXPECT_EQ(sight.verdict_low, verdict_at(low)) << noise;
    EXPECT_EQ(sight.verdict_high, verdict_at(high)) << noise;
    moved += sight.verdict_low != sight.verdict_high ? 1 : 0;
  }
  EXPECT_GT(moved, 0);
}

}  // namespace
}  // namespace earthshine::studies
