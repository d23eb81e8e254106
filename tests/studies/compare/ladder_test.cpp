// SPDX-License-Identifier: Apache-2.0
// The search on curves whose answer is known.
#include "studies/compare/ladder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace earthshine::studies {
namespace {

// error^2 = floor^2 + noise^2 / 2^rung, seconds = fixed + each * 2^rung.
struct Curve {
  double floor = 0.0, noise = 0.1, fixed = 0.0, each = 1.0;
  [[nodiscard]] LadderPoint at(int rung) const {
    const double work = std::ldexp(1.0, rung);
    return {rung, fixed + each * work, std::sqrt(floor * floor + noise * noise / work)};
  }
};

Ladder climbed(const Curve& curve, const LadderLimits& limits) {
  std::set<int> drawn;
  const Ladder ladder = climb(
      [&](int rung) {
        EXPECT_TRUE(drawn.insert(rung).second) << "twice at " << rung;
        EXPECT_GE(rung, limits.least_rung);
        EXPECT_LE(rung, limits.most_rung);
        return curve.at(rung);
      },
      limits);
  EXPECT_EQ(ladder.points.size(), drawn.size());
  return ladder;
}

int rung_at_time(const Ladder& ladder) { return ladder.points.at(ladder.at_time).rung; }
int rung_at_error(const Ladder& ladder) { return ladder.points.at(ladder.at_error).rung; }

LadderLimits limits(double seconds, std::optional<double> error = {}) {
  LadderLimits result;
  result.seconds = seconds;
  result.wanted_error = error;
  return result;
}

TEST(Ladder, TakesTheHighestRungWithinTheTime) {
  // One second at rung 0: 2^3 = 8 <= 10 < 16; from above 2^-3 = 0.125 <= 0.2 < 0.25.
  EXPECT_EQ(rung_at_time(climbed({}, limits(10.0))), 3);
  EXPECT_EQ(rung_at_time(climbed({}, limits(1.0))), 0);
  EXPECT_EQ(rung_at_time(climbed({}, limits(0.2))), -3);
  // With 0.9 s that every rung takes: 0.9 + 8 <= 10.
  EXPECT_EQ(rung_at_time(climbed({0.0, 0.1, 0.9, 1.0}, limits(10.0))), 3);
  // A tenth over the time is still within it: 1 <= 1.1 * 0.95.
  EXPECT_EQ(rung_at_time(climbed({}, limits(0.95))), 0);
}

TEST(Ladder, WhatTakesLongerEvenAtItsLeastHasNothingAtEqualTime) {
  const Ladder ladder = climbed({0.0, 0.1, 5.0, 1.0}, limits(4.0));
  EXPECT_EQ(ladder.at_time, Ladder::none);
  EXPECT_LE(ladder.points.size(), 4U);  // it gives up where lower rungs save nothing
}

TEST(Ladder, FindsTheCheapestRungThatReachesTheError) {
  // 0.1 / 2^(k/2) <= e at k = 2 log2(0.1 / e): 0.02 at 4.6, so 5; 0.3 at -3.2, so -3.
  const Ladder up = climbed({}, limits(10.0, 0.02));
  EXPECT_EQ(up.end, LadderEnd::Reached);
  EXPECT_EQ(rung_at_error(up), 5);
  EXPECT_EQ(rung_at_time(up), 3);
  const Ladder down = climbed({}, limits(10.0, 0.3));
  EXPECT_EQ(down.end, LadderEnd::Reached);
  EXPECT_EQ(rung_at_error(down), -3);
  // From rung 3 straight to 9, which 64 times the time allow; the rungs between are halved: 6,
  // 4, 5.
  LadderLimits far = limits(10.0, 0.02);
  far.spend = 64.0;
  const Ladder halved = climbed({}, far);
  EXPECT_EQ(rung_at_error(halved), 5);
  // Reached at once and at every rung: the lowest.
  EXPECT_EQ(rung_at_error(climbed({0.0, 0.0, 0.0, 1.0}, limits(1.0, 0.0))),
            LadderLimits().least_rung);
}

TEST(Ladder, SaysThatAnErrorLevelsOutWhereItDoes) {
  const Ladder ladder = climbed({0.3, 0.1, 0.0, 0.1}, limits(10.0, 0.02));
  EXPECT_EQ(ladder.end, LadderEnd::LevelsOut);
  EXPECT_NEAR(ladder.points.at(ladder.at_error).error, 0.3, 0.01);
  // Not if the floor lies below what is wanted, however flat: 0.1 with 0.03 of noise is 0.104, and
  // 0.1011 in four times the seconds.
  const Ladder above = climbed({0.1, 0.03, 0.0, 0.1}, limits(0.1, 0.1005));
  EXPECT_EQ(above.end, LadderEnd::NotWithin);
}

TEST(Ladder, SaysThatAnErrorIsStillFallingWhereItIs) {
  // 40 s allow rung 5, 0.018; 0.001 would take rung 14.
  const Ladder ladder = climbed({}, limits(10.0, 0.001));
  EXPECT_EQ(ladder.end, LadderEnd::NotWithin);
  EXPECT_EQ(rung_at_error(ladder), 5);
  for (const LadderPoint& point : ladder.points) EXPECT_LE(point.seconds, 40.0);
}

TEST(Ladder, RungsThatCostNothingMoreAreNoProofOfAFloor) {
  // The same picture at every rung, as where no more camera samples are asked for.
  const Ladder ladder = climb(
      [](int rung) {
        return LadderPoint{rung, 1.0, 0.2};
      },
      limits(1.0, 0.1));
  EXPECT_EQ(ladder.end, LadderEnd::NotWithin);
}

TEST(Ladder, DrawsNothingForAnErrorThatIsNotWanted) {
  EXPECT_EQ(climbed({}, limits(1.0)).points.size(), 1U);
}

TEST(Ladder, FloorIsWhatIsLeftOfTheErrorWithoutNoise) {
  // 0.3^2 + 0.1^2 at 1 s and 0.3^2 + 0.1^2 / 4 at 4 s.
  EXPECT_NEAR(error_floor({0, 1.0, std::sqrt(0.1)}, {2, 4.0, std::sqrt(0.0925)}), 0.3, 1e-12);
  EXPECT_NEAR(error_floor({0, 1.0, 0.2}, {2, 4.0, 0.1}), 0.0, 1e-9);  // noise alone
  EXPECT_EQ(error_floor({0, 1.0, 0.2}, {1, 1.0, 0.1}), 0.0);
}

}  // namespace
}  // namespace earthshine::studies
