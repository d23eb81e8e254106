// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <limits>

#include "base/error.h"
#include "studies/accuracy/findings.h"

namespace earthshine::studies {
namespace {

using Indices = std::vector<std::size_t>;

TEST(Pareto, FrontHoldsWhatNoPointBeats) {
  // 2 is dominated by 1 (faster and as accurate), 4 by 3.
  const std::vector<Trade> points = {
      {"a", 1, 0.5}, {"a", 2, 0.2}, {"b", 3, 0.2}, {"b", 4, 0.1}, {"a", 5, 0.3}};
  EXPECT_EQ(pareto_front(points), (Indices{0, 1, 3}));
}

TEST(Pareto, FrontOfNoneOneAndEquals) {
  EXPECT_TRUE(pareto_front({}).empty());
  EXPECT_EQ(pareto_front({{"a", 1, 0.0}}), (Indices{0}));
  // Equal seconds: the more accurate one. Equal in both: the first.
  EXPECT_EQ(pareto_front({{"a", 1, 0.5}, {"b", 1, 0.2}, {"c", 1, 0.2}}), (Indices{1}));
}

TEST(Pareto, CheapestWithinIsTheFastestThatIsExactEnough) {
  const std::vector<Trade> points = {{"a", 4, 0.01}, {"a", 1, 0.1}, {"b", 2, 0.05}, {"b", 2, 0.04}};
  EXPECT_EQ(cheapest_within(points, 0.2), 1U);
  EXPECT_EQ(cheapest_within(points, 0.1), 1U);  // the bound itself is within
  EXPECT_EQ(cheapest_within(points, 0.05), 3U);
  EXPECT_EQ(cheapest_within(points, 0.02), 0U);
  EXPECT_FALSE(cheapest_within(points, 0.001));
  EXPECT_FALSE(cheapest_within({}, 1.0));
}

TEST(Pareto, MethodsAreWorthItWhereTheyAreTheCheapest) {
  // Below 10 % b is cheaper than a; c is slower than both at any error.
  const std::vector<Trade> points = {{"a", 1, 0.3},  {"a", 2, 0.1},  {"a", 50, 0.01},
                                     {"b", 3, 0.05}, {"b", 9, 0.02}, {"c", 4, 0.2}};
  const std::vector<Worth> worth = worth_of_methods(points);
  ASSERT_EQ(worth.size(), 3U);
  EXPECT_EQ(worth[0].method, "a");
  // The most accurate point belongs to a, which is the cheapest there.
  EXPECT_TRUE(worth[0].ever);
  EXPECT_EQ(worth[0].down_to, 0.01);
  EXPECT_EQ(worth[0].then, "");
  EXPECT_EQ(worth[1].down_to, 0.02);
  EXPECT_EQ(worth[1].then, "a");
  EXPECT_FALSE(worth[2].ever);
}

TEST(Pareto, AMethodEndsWhereAnotherTakesOver) {
  const std::vector<Worth> worth =
      worth_of_methods({{"quick", 1, 0.3}, {"exact", 2, 0.05}, {"quick", 3, 0.25}});
  EXPECT_EQ(worth[0].down_to, 0.3);
  EXPECT_EQ(worth[0].then, "exact");
  EXPECT_EQ(worth[1].then, "");
}

TEST(Pareto, WhatIsNoNumberIsRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)pareto_front({{"a", nan, 0.1}}), base::Error);
  EXPECT_THROW((void)pareto_front({{"a", 1, nan}}), base::Error);
  EXPECT_THROW((void)worth_of_methods({{"a", 1, -0.1}}), base::Error);
  EXPECT_THROW((void)cheapest_within({{"a", -1, 0.1}}, 0.1), base::Error);
}

}  // namespace
}  // namespace earthshine::studies
