// SPDX-License-Identifier: Apache-2.0
#include "studies/orbit/wanted_visibility.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace earthshine::studies {
namespace {

TEST(LeastFactor, IsWhereARisingProbabilityPassesWhatIsWanted) {
  // P = x / (x + a) is p at x = a p / (1 - p). The result is at most 1 % above it, and never less
  // than the first trial factor.
  for (const double a : {0.004, 0.02, 0.3, 1.0, 2.5}) {
    for (const double wanted : {0.1, 0.5, 0.7}) {
      const auto found = least_factor([a](double x) { return x / (x + a); }, wanted);
      const double exact = std::max(a * wanted / (1.0 - wanted), least_lamp_factor);
      ASSERT_TRUE(found) << a << ' ' << wanted;
      EXPECT_GE(*found, exact);
      EXPECT_LE(*found, 1.0101 * exact) << a << ' ' << wanted;
    }
  }
}

TEST(LeastFactor, IsNothingWhereNoLightIsNeeded) {
  EXPECT_EQ(least_factor([](double) { return 0.9; }, 0.9), 0.0);
  EXPECT_EQ(least_factor([](double x) { return x > 0.0 ? 0.0 : 1.0; }, 0.5), 0.0);
}

TEST(LeastFactor, IsNotThereWhereNoLightWillDo) {
  int asked = 0;
  double most = 0.0;
  EXPECT_FALSE(least_factor(
      [&](double x) {
        ++asked;
        most = std::max(most, x);
        return 0.3;
      },
      0.5));
  EXPECT_EQ(most, most_lamp_factor);
  EXPECT_EQ(asked, 14);  // 0, and 2^-21 to 2^3 by 2^2
  EXPECT_TRUE(least_factor([](double x) { return x >= 8.0 ? 1.0 : 0.0; }, 0.5));
}

// Any light may suffice, as for an eye that sees a contrast: the result is the first step.
TEST(LeastFactor, IsTheFirstStepWhereAnyLightWillDo) {
  EXPECT_EQ(least_factor([](double x) { return x > 0.0 ? 1.0 : 0.0; }, 0.5), least_lamp_factor);
}

TEST(LeastFactor, OfABandOfLightItsLowerEndIsFound) {
  const auto band = [](double x) { return x >= 0.3 && x <= 1.1 ? 1.0 : 0.0; };
  EXPECT_NEAR(*least_factor(band, 0.5), 0.3, 0.01 * 0.3);
}

using Arcs = std::vector<Arc>;

void expect_arcs(const Arcs& found, const Arcs& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    EXPECT_NEAR(found[k].first, expected[k].first, 1e-9) << k;
    EXPECT_NEAR(found[k].second, expected[k].second, 1e-9) << k;
  }
}

TEST(ArcsAbove, CrossingsLieOnTheStraightLineBetweenNeighbours) {
  // 0.2 to 1 over 90 deg crosses 0.6 half way, 1 to 0.5 over 90 deg crosses it at 4/5.
  expect_arcs(arcs_above({0, 90, 180, 270}, {0.2, 1.0, 0.5, 0.0}, 0.6, false), {{45, 162}});
  expect_arcs(arcs_above({0, 90, 180, 270}, {0.2, 1.0, 0.5, 0.0}, 0.6, true), {{45, 162}});
  // Two arcs, the second up to the last position; a value equal to the wanted one is inside.
  expect_arcs(arcs_above({0, 10, 20, 30, 40}, {0.0, 0.6, 0.0, 0.0, 1.0}, 0.6, false),
              {{10, 10}, {36, 40}});
}

TEST(ArcsAbove, WithoutAnEndTheyGoOnOverTheStart) {
  // Begins at 270, where 0.5 is just reached, and ends at 45, where 0.5 is crossed between 0 (1)
  // and 90 (0).
  expect_arcs(arcs_above({0, 90, 180, 270}, {1.0, 0.0, 0.0, 0.5}, 0.5, true), {{-90, 45}});
  // The last position is outside: the arc begins on the line from 270 (0) to 360 (1).
  expect_arcs(arcs_above({0, 90, 180, 270}, {1.0, 0.0, 0.0, 0.0}, 0.5, true), {{-45, 45}});
  // The first is outside: the arc ends on the line from 270 (1) to 360 (0.2), at 0.5 / 0.8 of it.
  expect_arcs(arcs_above({0, 90, 180, 270}, {0.2, 0.0, 0.0, 1.0}, 0.5, true),
              {{225, 270 + 90 * 0.625}});
  // With another arc in the middle.
  expect_arcs(arcs_above({0, 90, 180, 270}, {1.0, 0.0, 1.0, 0.0}, 0.5, true),
              {{-45, 45}, {135, 225}});
  // Open: the arcs end at the first and last positions.
  expect_arcs(arcs_above({0, 90, 180, 270}, {1.0, 0.0, 0.0, 1.0}, 0.5, false),
              {{0, 45}, {225, 270}});
}

TEST(ArcsAbove, AllNoneAndASinglePosition) {
  expect_arcs(arcs_above({0, 120, 240}, {0.9, 0.5, 1.0}, 0.5, true), {{0, 360}});
  expect_arcs(arcs_above({0, 120, 240}, {0.9, 0.5, 1.0}, 0.5, false), {{0, 240}});
  expect_arcs(arcs_above({0, 120, 240}, {0.4, 0.1, 0.49}, 0.5, true), {});
  expect_arcs(arcs_above({}, {}, 0.5, false), {});
  expect_arcs(arcs_above({30}, {1.0}, 0.5, false), {{30, 30}});
  expect_arcs(arcs_above({30}, {0.0}, 0.5, false), {});
}

TEST(ArcsAbove, TheirLengthsAddUp) {
  EXPECT_EQ(total_deg({}), 0.0);
  EXPECT_EQ(total_deg({{-45, 45}, {135, 225}}), 180.0);
  EXPECT_EQ(total_deg(arcs_above({0, 120, 240}, {1.0, 1.0, 1.0}, 0.5, true)), 360.0);
}

}  // namespace
}  // namespace earthshine::studies
