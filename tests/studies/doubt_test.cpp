// SPDX-License-Identifier: Apache-2.0
#include "studies/doubt.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/studies/normal.h"

namespace earthshine::studies {
namespace {

constexpr std::size_t tries = 4;

// Tries of as many values as there are modes, or of `values` that all follow one.
std::vector<std::vector<double>> draw(tests::Normal& normal, std::size_t count, std::size_t modes) {
  std::vector<std::vector<double>> drawn(count);
  for (auto& one : drawn) {
    if (modes == 1) one.assign(5, normal.next());
    for (std::size_t i = 0; modes > 1 && i < modes; ++i) one.push_back(normal.next());
  }
  return drawn;
}

TEST(FQuantile, IsWithinFourPercentOfTheTables) {
  // By the incomplete beta function; what four tries ask for has n = 3 m.
  struct Row {
    double m, n, f;
  };
  for (const Row& row : {Row{1, 3, 10.128},
                         {1.5, 4.5, 6.5788},
                         {2, 6, 5.1433},
                         {3, 9, 3.8625},
                         {5, 15, 2.9013},
                         {10, 30, 2.1646},
                         {20, 60, 1.7480},
                         {30, 90, 1.5859},
                         {100, 300, 1.2958},
                         {4, 12, 3.2592},
                         {1, 10, 4.9646},
                         {1, 60, 4.0012}}) {
    EXPECT_NEAR(f_quantile_95(row.m, row.n) / row.f, 1.0, 0.04) << row.m << " " << row.n;
  }
}

TEST(Spread, VarianceIsUnbiasedAndModesAreCounted) {
  constexpr int times = 2000;
  for (const std::size_t modes : {1U, 3U, 30U}) {
    tests::Normal normal(7 + modes);
    double variance = 0.0, found = 0.0;
    for (int k = 0; k < times; ++k) {
      const Spread spread = spread_of(draw(normal, tries, modes));
      variance += spread.variance / times;
      found += spread.modes / times;
    }
    // The mean square of m modes in n = 3 degrees of freedom has variance 2 / (m n).
    EXPECT_NEAR(variance, 1.0, 4.0 * std::sqrt(2.0 / (3.0 * double(modes) * times))) << modes;
    EXPECT_GT(found, 0.8 * double(modes));
    EXPECT_LT(found, 1.02 * double(modes));
  }
}

TEST(Spread, OfUnequalModesCountsTheLargeOnes) {
  // Variances 100 and 48 times 1: (148)^2 / (100^2 + 48) = 2.2 of 49. Four tries overrate that, as
  // the large one is often small in all of them, but do not take the small ones for all.
  tests::Normal normal(5);
  double found = 0.0;
  for (int k = 0; k < 500; ++k) {
    auto drawn = draw(normal, tries, 49);
    for (auto& one : drawn) one.front() *= 10.0;
    found += spread_of(drawn).modes / 500.0;
  }
  EXPECT_GT(found, 2.2);
  EXPECT_LT(found, 49.0 / 4.0);
}

TEST(Spread, TwoTriesTellNothingOfModes) {
  // Both lie on one line, whatever they are: (tr G)^2 / tr G^2 = 1 to the last bit or so.
  tests::Normal normal(6);
  for (int k = 0; k < 50; ++k) EXPECT_EQ(spread_of(draw(normal, 2, 30)).modes, 1.0);
}

TEST(Spread, OfNothingAndOfNoSpread) {
  EXPECT_EQ(spread_of({{}, {}, {}}).variance, 0.0);
  const Spread none = spread_of({{1, 2}, {1, 2}, {1, 2}});
  EXPECT_EQ(none.variance, 0.0);
  EXPECT_EQ(none.modes, 1.0);
}

// How often the bound holds for errors of `modes` values, a share of whose variance goes up and
// down together. What is estimated has a quarter of the variance of a try.
double held(std::size_t modes, double together, int times, std::uint64_t seed) {
  tests::Normal normal(seed);
  const auto draw_one = [&] {
    const double common = std::sqrt(together) * normal.next();
    std::vector<double> one(std::max<std::size_t>(modes, 5), common);
    for (std::size_t i = 0; i < one.size() && together < 1.0; ++i) {
      one[i] += std::sqrt(1.0 - together) * normal.next();
    }
    return one;
  };
  int holds = 0;
  for (int k = 0; k < times; ++k) {
    const std::vector<std::vector<double>> looks{draw_one(), draw_one(), draw_one(), draw_one()};
    const Doubt doubt = doubt_of(spread_of(looks), tries, 0.25, 10.0);
    double square = 0.0;
    const std::vector<double> error = draw_one();
    for (const double e : error) square += 0.25 * e * e / double(error.size());
    if (std::sqrt(square) / 10.0 <= doubt.bound_95) ++holds;
    EXPECT_LT(doubt.bound_95, 3.3 * doubt.estimate);  // root of F(1, 3)
  }
  return holds / double(times);
}

TEST(Doubt, BoundHoldsNineteenTimesOfTwenty) {
  constexpr int times = 3000;
  const double chance = 4.0 * std::sqrt(0.95 * 0.05 / times);
  EXPECT_NEAR(held(1, 1.0, times, 11), 0.95, chance);
  for (const std::size_t modes : {5U, 10U, 30U}) {
    EXPECT_GT(held(modes, 0.0, times, 12 + modes), 0.95 - chance) << modes;
  }
}

TEST(Doubt, BoundHoldsForALargeModeAmongMany) {
  // 93 of 100 where four tries cannot tell better.
  constexpr int times = 2000;
  const double chance = 4.0 * std::sqrt(0.93 * 0.07 / times);
  for (const double together : {0.1, 0.35, 0.5, 0.65, 0.8, 0.95}) {
    EXPECT_GT(held(60, together, times, 91), 0.93 - chance) << together;
  }
}

TEST(Doubt, EstimateIsTheSharesRoot) {
  const Spread spread{9.0, 1.0};
  EXPECT_DOUBLE_EQ(doubt_of(spread, 4, 0.25, 3.0).estimate, 0.5);
  EXPECT_EQ(doubt_of(spread, 4, 0.25, 0.0).estimate, 0.0);
  EXPECT_EQ(doubt_of(spread, 4, 0.25, 0.0).bound_95, 0.0);
}

TEST(Doubt, CausesAddInSquares) {
  const Doubt sum = Doubt{3.0, 6.0} + Doubt{4.0, 8.0};
  EXPECT_DOUBLE_EQ(sum.estimate, 5.0);
  EXPECT_DOUBLE_EQ(sum.bound_95, 10.0);
}

}  // namespace
}  // namespace earthshine::studies
