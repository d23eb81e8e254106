// SPDX-License-Identifier: Apache-2.0
// Each picture has one fault, which must be named.
#include "studies/why/why_not.h"

#include <gtest/gtest.h>

#include "tests/studies/discs.h"
#include "tests/studies/why/situations.h"

namespace earthshine::studies {
namespace {

using tests::Answer;
using tests::discs_on;
using tests::plain_cctv;
using tests::with_noise;

constexpr int edge = 120;

Answer ask_why(const tests::DiscPicture& picture, const std::optional<degrade::Setup>& cctv,
               const std::vector<SourceOnTarget>& sources = {},
               const std::optional<scenes::Earth>& earth = {}) {
  Answer answer;
  answer.sight = measure_sight(picture.plan, picture.image, cctv);
  const WhyNotInputs inputs{picture.scene, picture.camera, picture.plan, picture.image,
                            cctv,          answer.sight,   {},           earth};
  answer.why = why_not(inputs, 0, sources);
  return answer;
}

// One reason, which alone suffices.
void expect_only(const Answer& answer, Cause cause, const std::string& by) {
  ASSERT_EQ(answer.why.reasons.size(), 1U) << answer.why.text;
  const Reason& reason = answer.why.reasons.front();
  EXPECT_EQ(word_of(reason.cause), word_of(cause)) << answer.why.text;
  EXPECT_EQ(reason.by, by) << answer.why.text;
  ASSERT_TRUE(reason.probability_without) << answer.why.text;
  EXPECT_LT(answer.sight.targets.front().probability->detect, 0.5);
  EXPECT_GT(*reason.probability_without, 0.5) << answer.why.text;
}

TEST(WhyNot, NothingIsSaidOfATargetThatIsIdentified) {
  const Answer answer = ask_why(discs_on(40.0, {{60.0, 60.0, 20.0, 60.0}}, edge, edge),
                                plain_cctv(edge, edge, 100.0));
  EXPECT_TRUE(answer.why.reasons.empty());
  EXPECT_EQ(answer.why.text, "");
}

TEST(WhyNot, NamesWhatStandsInFront) {
  // A sliver of 2 pixels of a disc 4 pixels wide is visible behind another disc, as dark as the
  // ground: 0.8 cycles of 2.
  auto picture =
      discs_on(40.0, {{60.0, 60.0, 2.1, 80.0}, {61.0, 60.0, 2.3, 40.0, false}}, edge, edge);
  picture.scene.objects[1].name = "pallet";
  const Answer answer = ask_why(picture, plain_cctv(edge, edge, 100.0));
  expect_only(answer, Cause::Hidden, "pallet");
  const TargetView& view = picture.plan.targets[0].view;
  EXPECT_NEAR(*answer.why.reasons[0].share,
              static_cast<double>(view.hidden.size()) / static_cast<double>(view.pixels_alone),
              1e-12);
  EXPECT_EQ(answer.why.text.find("hidden by pallet ("), 0U);
}

TEST(WhyNot, NamesWhatHidesAllOfIt) {
  const Answer answer = ask_why(
      discs_on(40.0, {{60.0, 60.0, 10.0, 60.0}, {60.0, 60.0, 12.0, 40.0, false}}, edge, edge),
      plain_cctv(edge, edge, 100.0));
  ASSERT_EQ(answer.why.reasons.size(), 1U);
  EXPECT_EQ(answer.why.text, "hidden by disc-1 (100 % of it)");
  EXPECT_FALSE(answer.why.reasons[0].probability_without);
  EXPECT_EQ(answer.sight.targets.front().verdict, Verdict::Hidden);
}

TEST(WhyNot, SaysSoOutOfView) {
  const Answer answer = ask_why(discs_on(40.0, {{-60.0, 60.0, 10.0, 60.0}}, edge, edge),
                                plain_cctv(edge, edge, 100.0));
  ASSERT_EQ(answer.why.reasons.size(), 1U);
  EXPECT_EQ(answer.why.reasons[0].cause, Cause::OutOfView);
}

TEST(WhyNot, NamesTheSourceThatDoesNotReachIt) {
  // As black as the ground, because the lamp's light is blocked; the Sun is behind it.
  SourceOnTarget sun{"sun"}, lamp{"bay-lamps"};
  lamp.facing = 1.0;
  lamp.unshadowed = 50.0;
  lamp.shadow_of = {"radiator"};
  const Answer answer = ask_why(discs_on(1.0, {{60.0, 60.0, 10.0, 1.0}}, edge, edge),
                                with_noise(plain_cctv(edge, edge, 100.0), 1e-4), {sun, lamp});
  expect_only(answer, Cause::Unlit, "bay-lamps");
  EXPECT_EQ(*answer.why.reasons[0].share, 1.0);
  EXPECT_EQ(answer.why.text.find("unlit: bay-lamps does not reach it (shadow of radiator)"), 0U)
      << answer.why.text;
}

TEST(WhyNot, LampThatIsOffLightsThePictureItIsGiven) {
  const auto dark = discs_on(0.0, {{60.0, 60.0, 10.0, 0.0}}, edge, edge);
  const auto lit = discs_on(40.0, {{60.0, 60.0, 10.0, 60.0}}, edge, edge);
  SourceOnTarget lamp{"bay-lamps"};
  lamp.off = "switched off";
  lamp.when_on = &lit.image;
  const Answer answer = ask_why(dark, plain_cctv(edge, edge, 100.0), {lamp});
  expect_only(answer, Cause::Unlit, "bay-lamps");
  EXPECT_EQ(answer.why.text, "unlit: bay-lamps switched off; with it 1.00");
  // Without that picture, nor any other data, the darkness is still reported.
  lamp.when_on = nullptr;
  const Answer blind = ask_why(dark, plain_cctv(edge, edge, 100.0), {lamp});
  EXPECT_EQ(blind.why.text, "unlit: bay-lamps switched off");
}

degrade::Setup automatic(double noise) {
  degrade::Setup setup = with_noise(plain_cctv(edge, edge, 100.0), noise);
  setup.camera.iris = degrade::IrisMode::Average;
  setup.camera.iris_target = 0.5;
  return setup;
}

TEST(WhyNot, NamesTheBrightThingTheIrisClosesFor) {
  // Disc 1 is bright, too, but disc 2 raises the mean from 45 to 1e4 cd/m^2, 7.8 stops, and lowers
  // the target to S = 0.003, with noise of 0.03.
  const auto picture = discs_on(40.0,
                                {{40.0, 40.0, 8.0, 60.0},
                                 {90.0, 40.0, 10.0, 250.0, false},
                                 {80.0, 90.0, 20.0, 115000.0, false}},
                                edge, edge);
  const Answer answer = ask_why(picture, automatic(1e-3));
  ASSERT_FALSE(answer.why.reasons.empty());
  const Reason& reason = answer.why.reasons.front();
  EXPECT_EQ(reason.cause, Cause::Iris) << answer.why.text;
  EXPECT_EQ(reason.by, "disc-2") << answer.why.text;
  EXPECT_GT(*reason.probability_without, 0.9);
  EXPECT_EQ(answer.why.text.find("iris closed by 7.8 stops for disc-2: without it "), 0U)
      << answer.why.text;
}

TEST(WhyNot, NamesAllTheIrisClosesForWhereOneWouldNotDo) {
  const auto picture = discs_on(
      40.0,
      {{40.0, 40.0, 8.0, 60.0}, {90.0, 40.0, 15.0, 2e5, false}, {80.0, 90.0, 15.0, 2e5, false}},
      edge, edge);
  const Answer answer = ask_why(picture, automatic(1e-3));
  ASSERT_FALSE(answer.why.reasons.empty());
  EXPECT_EQ(answer.why.reasons.front().cause, Cause::Iris) << answer.why.text;
  EXPECT_EQ(answer.why.reasons.front().by, "disc-1, disc-2") << answer.why.text;
}

TEST(WhyNot, NamesTheEarthThatTheIrisClosesFor) {
  auto picture = discs_on(40.0, {{30.0, 30.0, 8.0, 60.0}}, edge, edge);
  // The camera looks along x; the Earth fills 10 degrees around this direction.
  scenes::Earth earth;
  earth.direction = Vec3(1, 0, 0);
  earth.half_angle_deg = 5.0;
  for (int y = 50; y < 70; ++y) {
    for (int x = 50; x < 70; ++x) {
      const double dx = x + 0.5 - 60.0, dy = y + 0.5 - 60.0;
      if (dx * dx + dy * dy > 100.0) continue;
      for (base::Channel& c : picture.image.channels) {
        c.values[static_cast<std::size_t>(y * edge + x)] = 3e5F;
      }
    }
  }
  const Answer answer = ask_why(picture, automatic(1e-3), {}, earth);
  ASSERT_FALSE(answer.why.reasons.empty());
  EXPECT_EQ(answer.why.reasons.front().cause, Cause::Iris) << answer.why.text;
  EXPECT_EQ(answer.why.reasons.front().by, "the Earth") << answer.why.text;
}

TEST(WhyNot, SaturatedTargetIsSaturated) {
  degrade::Setup setup = plain_cctv(edge, edge, 100.0);
  setup.camera.white_clip = 1.1;
  const Answer answer = ask_why(discs_on(1000.0, {{60.0, 60.0, 10.0, 1500.0}}, edge, edge), setup);
  expect_only(answer, Cause::Saturated, "");
  EXPECT_EQ(answer.why.text.find("saturated (100 % of it): without it "), 0U) << answer.why.text;
}

TEST(WhyNot, TinyTargetIsBlurredAway) {
  degrade::Setup setup = with_noise(plain_cctv(edge, edge, 100.0), 1e-5);
  setup.camera.blur_h = setup.camera.blur_v = 4.0;
  const Answer answer = ask_why(discs_on(40.0, {{60.0, 60.0, 3.0, 60.0}}, edge, edge), setup);
  expect_only(answer, Cause::Blur, "tube");
  EXPECT_EQ(answer.why.text.find("blurred by the sensor: without it "), 0U) << answer.why.text;
}

TEST(WhyNot, DarkTargetIsLostInNoise) {
  const Answer answer = ask_why(discs_on(0.4, {{60.0, 60.0, 10.0, 0.6}}, edge, edge),
                                with_noise(plain_cctv(edge, edge, 100.0), 1e-2));
  expect_only(answer, Cause::Noise, "");
  EXPECT_EQ(answer.why.text.find("lost in noise: without it "), 0U) << answer.why.text;
}

TEST(WhyNot, FaintTargetLacksContrastAndSmallOneSize) {
  const degrade::Setup setup = plain_cctv(edge, edge, 100.0);
  expect_only(ask_why(discs_on(40.0, {{60.0, 60.0, 10.0, 41.0}}, edge, edge), setup),
              Cause::Contrast, "");
  expect_only(ask_why(discs_on(40.0, {{60.0, 60.0, 10.0, 41.0}}, edge, edge), {}), Cause::Contrast,
              "");
  expect_only(ask_why(discs_on(40.0, {{60.5, 60.5, 0.6, 80.0}}, edge, edge), setup), Cause::Small,
              "");
}

TEST(WhyNot, TargetAsBrightAsItsSurroundIsToldSo) {
  const Answer answer = ask_why(discs_on(40.0, {{60.0, 60.0, 10.0, 40.0}}, edge, edge),
                                plain_cctv(edge, edge, 100.0));
  ASSERT_EQ(answer.why.reasons.size(), 1U);
  EXPECT_EQ(answer.why.text,
            "as bright as what is round it (contrast 0.0 %): on a black ground 1.00");
}

TEST(WhyNot, NeedsSeveralWhereNoOneIsEnough) {
  // One pixel, S = 0.45 on 0.4, in noise of 0.05: too small without noise, too faint if large.
  const Answer answer = ask_why(discs_on(40.0, {{60.5, 60.5, 0.6, 45.0}}, edge, edge),
                                with_noise(plain_cctv(edge, edge, 100.0), 2.5e-3));
  ASSERT_EQ(answer.why.reasons.size(), 2U) << answer.why.text;
  EXPECT_EQ(answer.why.reasons[0].cause, Cause::Noise);
  EXPECT_EQ(answer.why.reasons[1].cause, Cause::Small);
  for (const Reason& reason : answer.why.reasons) EXPECT_LT(*reason.probability_without, 0.5);
  EXPECT_GT(*answer.why.probability_without_all, 0.5);
}

TEST(WhyNot, WhatIsNotNeededIsNotAmongTheSeveral) {
  // Large, 2.5 % of contrast with an eye's threshold of 6 %, in noise of 0.3: no single cause
  // changes anything, and blur, which is tried first, is no cause.
  const Answer answer = ask_why(discs_on(40.0, {{60.0, 60.0, 10.0, 41.0}}, edge, edge),
                                with_noise(plain_cctv(edge, edge, 100.0), 0.09));
  ASSERT_EQ(answer.why.reasons.size(), 2U) << answer.why.text;
  EXPECT_EQ(answer.why.reasons[0].cause, Cause::Noise);
  EXPECT_EQ(answer.why.reasons[1].cause, Cause::Contrast);
}

TEST(WhyNot, SaysWhichTaskFails) {
  const Answer answer =
      ask_why(discs_on(40.0, {{60.0, 60.0, 2.0, 80.0}}, edge, edge), plain_cctv(edge, edge, 100.0));
  EXPECT_EQ(answer.sight.targets.front().verdict, Verdict::Detected);
  EXPECT_EQ(answer.why.text.find("not recognised: too small ("), 0U) << answer.why.text;
}

TEST(WhyNot, TargetThatFillsThePictureHasNothingRoundIt) {
  const Answer answer = ask_why(discs_on(40.0, {{60.0, 60.0, 500.0, 60.0}}, edge, edge),
                                plain_cctv(edge, edge, 100.0));
  EXPECT_EQ(answer.why.text, "fills the picture: nothing to tell it from");
}

}  // namespace
}  // namespace earthshine::studies
