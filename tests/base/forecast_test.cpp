// SPDX-License-Identifier: Apache-2.0
#include "base/forecast.h"

#include <gtest/gtest.h>

namespace earthshine::base {
namespace {

// From a fifth of the stage on. Before, in proportion: at a tenth half of 20 s and half of the 100
// s that were expected.
TEST(Forecast, StepsOfASteadyStageGiveTheRestExactly) {
  Forecast forecast;
  forecast.begin({"solve", 100.0}, 0.0);  // 100 s were expected, and it takes 20 s
  forecast.advance(1, 10);
  EXPECT_NEAR(forecast.at(2.0).seconds_to_go, 60.0 - 2.0, 1e-12);
  forecast.advance(2, 10);
  const Forecast::State state = forecast.at(4.0);
  EXPECT_NEAR(state.share, 0.2, 1e-12);
  EXPECT_NEAR(state.seconds_to_go, 16.0, 1e-12);
}

TEST(Forecast, FinishedStagesCorrectThoseOfTheirKind) {
  Forecast forecast;
  for (int k = 0; k < 5; ++k) forecast.expect({"picture", 10.0});
  forecast.begin({"picture", 10.0}, 0.0);  // one of the five
  forecast.begin({"picture", 10.0}, 2.0);  // the first took 2 s: four of 2 s are left
  EXPECT_NEAR(forecast.at(2.0).seconds_to_go, 8.0, 1e-9);
  EXPECT_NEAR(forecast.at(2.0).share, 0.2, 1e-9);
}

// A picture to an error reports the end of each of its rounds as the end of all that is known.
TEST(Forecast, ReportsOfRoundsDoNotHurryAPicture) {
  Forecast forecast;
  forecast.begin({"picture", 40.0}, 0.0);
  forecast.advance(10, 10);
  EXPECT_NEAR(forecast.at(4.0).seconds_to_go, 36.0, 1e-9);
  EXPECT_NEAR(forecast.at(4.0).share, 0.1, 1e-9);
  EXPECT_NEAR(forecast.at(60.0).seconds_to_go, 60.0, 1e-9);  // late: as long again
}

// Whatever the stages do: a call of stages that take far longer, or shorter, than expected, or that
// come unannounced.
TEST(Forecast, TheShareNeverFalls) {
  Forecast forecast;
  forecast.expect({"short", 1.0});
  double last = 0.0, now = 0.0;
  const auto look = [&] {
    const double share = forecast.at(now).share;
    EXPECT_GE(share, last);
    EXPECT_LE(share, 0.99);
    last = share;
  };
  for (const double seconds : {50.0, 0.1, 300.0}) {
    forecast.begin({seconds > 100.0 ? "unannounced" : "short", 1.0}, now);
    for (int k = 0; k < 50; ++k) {
      now += seconds / 50.0;
      if (seconds < 100.0) forecast.advance(static_cast<std::size_t>(k), 50);
      look();
    }
  }
}

TEST(Forecast, DroppedStagesAndALimitShortenTheRest) {
  Forecast forecast;
  forecast.expect({"solve", 30.0});
  forecast.expect({"picture", 10.0});
  EXPECT_NEAR(forecast.at(1.0).seconds_to_go, 40.0, 1e-9);
  forecast.drop("solve");
  EXPECT_NEAR(forecast.at(1.0).seconds_to_go, 10.0, 1e-9);
  EXPECT_NEAR(forecast.at(1.0, 1.0, 4.0).seconds_to_go, 4.0, 1e-9);
  forecast.drop_all();
  EXPECT_EQ(forecast.at(1.0).seconds_to_go, 0.0);
}

}  // namespace
}  // namespace earthshine::base
