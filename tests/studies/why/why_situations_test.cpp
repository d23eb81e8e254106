// SPDX-License-Identifier: Apache-2.0
// Twenty causes, each added alone: it must be named; of two added together, both.
#include <gtest/gtest.h>

#include <algorithm>

#include "studies/why/sight_changes.h"
#include "tests/studies/why/situations.h"

namespace earthshine::studies {
namespace {

using namespace tests;

struct Case {
  const char* name;
  void (*put_in)(Situation&);
  const char* cause;
  const char* text;  // part of the reason's text
};

constexpr Case hidden{"hidden", put_hidden, "hidden", "hidden by pallet ("};
constexpr Case lamp_off{"lamp_off", put_lamp_off, "unlit", "bay-6 switched off"};
constexpr Case too_far{"lamp_too_far", put_lamp_too_far, "unlit", "bay-6 is too far (45 m)"};
constexpr Case shadow{"shadow", put_shadow, "unlit", "sun does not reach it (shadow of tail)"};
constexpr Case eclipse{"eclipse", put_eclipse, "unlit", "sun in the Earth's shadow"};
constexpr Case night{"night_side", put_night_side, "unlit", "earth has its night side below"};
constexpr Case iris{"iris_closed", put_iris_closed, "iris", "stops for pallet"};
constexpr Case sun{"sun_in_frame", put_sun_in_frame, "iris",
                   "the Sun is in the picture: iris closed by "};
constexpr Case saturated{"saturated", put_saturated, "saturated", "saturated (100 % of it)"};
constexpr Case lens{"lens", put_lens_blur, "blur", "blurred by the lens"};
constexpr Case line{"line", put_line_blur, "blur", "blurred by the video line"};
constexpr Case monitor{"monitor", put_monitor_blur, "blur", "blurred by the monitor"};
constexpr Case noise{"noise", put_noise, "noise", "lost in noise"};
constexpr Case outside{"out_of_view", put_out_of_view, "out-of-view", "out of the camera's view"};
constexpr Case tiny{"small", put_small, "small", "too small (1.0 TV lines across it)"};
constexpr Case back{"black_back", put_black_back, "black-back", "black back seen (100 % of it)"};
constexpr Case plain{"no_contrast", put_no_contrast, "contrast", "as bright as what is round it"};
constexpr Case glare{"glare", put_glare, "glare", "stray light of pallet"};
constexpr Case lag{"lag", put_lag, "lag", "smeared by the tube's lag (it moves "};
constexpr Case room{"room_light", put_room_light, "room-light",
                    "washed out by the room's light on the monitor (1.6e+03 cd/m^2)"};

bool names(const WhyNot& why, const Case& wanted) {
  return why.text.find(wanted.text) != std::string::npos &&
         std::any_of(why.reasons.begin(), why.reasons.end(),
                     [&](const Reason& r) { return word_of(r.cause) == wanted.cause; });
}

// A picture with a lamp on replaces the present one; other changes must apply to the new one: 10,
// then 5 more.
TEST(WhySituations, LightIsSwitchedOnBeforeWhatElseIsTakenAway) {
  Scenario start;
  start.radiance = base::make_rgb_image(1, 1);
  Change light, hiding;
  light.cause = Cause::Unlit;
  light.apply = [](Scenario& s) {
    for_light(s.radiance, [](std::vector<float>& values) { values[0] = 10.0F; });
  };
  hiding.cause = Cause::Hidden;
  hiding.apply = [](Scenario& s) {
    for_light(s.radiance, [](std::vector<float>& values) { values[0] += 5.0F; });
  };
  EXPECT_EQ(without_all(start, {hiding, light}).radiance.channels[0].values[0], 15.0F);
  EXPECT_EQ(without_all(start, {light, hiding}).radiance.channels[0].values[0], 15.0F);
}

class OneCause : public testing::TestWithParam<Case> {};

TEST(WhySituations, WithoutACauseTheTargetIsIdentified) {
  const Answer answer = ask({});
  EXPECT_EQ(answer.sight.targets.front().verdict, Verdict::Identified);
  EXPECT_EQ(answer.why.text, "");
}

TEST_P(OneCause, IsNamedFirst) {
  const Answer answer = ask({GetParam().put_in});
  EXPECT_NE(answer.sight.targets.front().verdict, Verdict::Identified);
  ASSERT_FALSE(answer.why.reasons.empty());
  EXPECT_EQ(word_of(answer.why.reasons.front().cause), GetParam().cause) << answer.why.text;
  EXPECT_TRUE(names(answer.why, GetParam())) << answer.why.text;
  // If the picture has a fault, neither the eye nor the target's size is named.
  for (const Reason& reason : answer.why.reasons) {
    if (answer.why.reasons.front().cause >= Cause::Contrast) break;
    EXPECT_LT(reason.cause, Cause::Contrast) << answer.why.text;
  }
}

INSTANTIATE_TEST_SUITE_P(WhySituations, OneCause,
                         testing::Values(hidden, lamp_off, too_far, shadow, eclipse, night, iris,
                                         sun, saturated, lens, line, monitor, noise, outside, tiny,
                                         back, plain, glare, lag, room),
                         [](const auto& tested) { return std::string(tested.param.name); });

struct Pair {
  Case one, other;
};
class TwoCauses : public testing::TestWithParam<Pair> {};

TEST_P(TwoCauses, AreBothNamed) {
  const auto& [one, other] = GetParam();
  const Answer answer = ask({one.put_in, other.put_in});
  EXPECT_TRUE(names(answer.why, one)) << answer.why.text;
  EXPECT_TRUE(names(answer.why, other)) << answer.why.text;
}

// Pairs of causes that do not exclude each other: a target out of view has no other reason, and an
// unlit one is not saturated.
INSTANTIATE_TEST_SUITE_P(
    WhySituations, TwoCauses,
    testing::Values(Pair{hidden, lamp_off}, Pair{hidden, noise}, Pair{hidden, sun},
                    Pair{hidden, room}, Pair{hidden, back}, Pair{lamp_off, room},
                    Pair{lamp_off, noise}, Pair{lamp_off, lens}, Pair{shadow, room},
                    Pair{shadow, noise}, Pair{shadow, monitor}, Pair{eclipse, noise},
                    Pair{eclipse, room}, Pair{night, room}, Pair{night, lens}, Pair{iris, lens},
                    Pair{iris, room}, Pair{iris, tiny}, Pair{sun, noise}, Pair{sun, room},
                    Pair{saturated, lens}, Pair{lens, monitor}, Pair{lens, noise},
                    Pair{line, noise}, Pair{monitor, room}, Pair{noise, tiny}, Pair{noise, room},
                    Pair{glare, noise}, Pair{glare, lens}, Pair{lag, noise}, Pair{lag, room},
                    Pair{back, noise}, Pair{too_far, room}, Pair{plain, noise}),
    [](const auto& tested) {
      return std::string(tested.param.one.name) + "_and_" + tested.param.other.name;
    });

}  // namespace
}  // namespace earthshine::studies
