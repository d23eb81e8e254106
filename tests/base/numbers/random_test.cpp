// SPDX-License-Identifier: Apache-2.0
#include "base/numbers/random.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "base/numbers/sobol_set.h"

namespace earthshine::base {
namespace {

constexpr int draws = 1 << 16;

TEST(Random, SameKeySameNumbersOtherKeyOthers) {
  const Key key(7, Stream::Test, 3);
  EXPECT_EQ(uniform(key, 5), uniform(Key(7, Stream::Test, 3), 5));
  std::set<double> first;
  for (const Key& other : {key, Key(8, Stream::Test, 3), Key(7, Stream::Pixel, 3),
                           Key(7, Stream::Test, 4), key.with(0), key.with(1)}) {
    first.insert(uniform(other, 0));
  }
  EXPECT_EQ(first.size(), 6U);
}

TEST(Random, SequenceIsTheCounterCounted) {
  const Key key(1, Stream::Test, 2);
  Rng rng(key);
  for (std::uint64_t n = 0; n < 10; ++n) EXPECT_EQ(rng.next(), uniform(key, n));
}

TEST(Random, UniformHasMeanHalfAndVarianceTwelfthWithinFourStandardErrors) {
  double sum = 0.0, sum2 = 0.0;
  for (std::uint64_t n = 0; n < draws; ++n) {
    const double u = uniform(Key(11, Stream::Test, 0), n);
    ASSERT_GE(u, 0.0);
    ASSERT_LT(u, 1.0);
    sum += u - 0.5;
    sum2 += (u - 0.5) * (u - 0.5);
  }
  // Var u = 1/12; Var (u - 1/2)^2 = 1/80 - 1/144 = 1/180.
  EXPECT_NEAR(sum / draws, 0.0, 4.0 * std::sqrt(1.0 / 12.0 / draws));
  EXPECT_NEAR(sum2 / draws, 1.0 / 12.0, 4.0 * std::sqrt(1.0 / 180.0 / draws));
}

TEST(Random, NeighbouringItemsAreUncorrelated) {
  double product = 0.0;
  for (std::uint64_t n = 0; n < draws; ++n) {
    product += (uniform(Key(1, Stream::Test, n), 0) - 0.5) *
               (uniform(Key(1, Stream::Test, n + 1), 0) - 0.5);
  }
  // The variance of a product of independent uniform numbers about 1/2 is 1/144.
  EXPECT_NEAR(product / draws, 0.0, 4.0 / 12.0 / std::sqrt(draws));
}

// A (0, m, s)-net in base 2: each of the 2^m boxes of any shape contains exactly one of 2^m points.
// The first two dimensions of Sobol form such a net, and Owen scrambling preserves it.
TEST(Random, FirstTwoSobolDimensionsFillEveryElementaryBoxOnce) {
  constexpr int m = 8;
  const SobolOwen4 sobol(Key(5, Stream::Test, 9));
  for (int split = 0; split <= m; ++split) {
    std::set<int> boxes;
    for (std::uint32_t i = 0; i < (1U << m); ++i) {
      const auto p = sobol.point(i);
      const int x = static_cast<int>(std::ldexp(p[0], split));
      const int y = static_cast<int>(std::ldexp(p[1], m - split));
      boxes.insert((x << (m - split)) | y);
    }
    EXPECT_EQ(boxes.size(), 1U << m) << "split " << split;
  }
}

TEST(Random, TheSobolSetIsANetInEachPairOfItsDimensionsThatSobolMakesOne) {
  // Elementary boxes of the first two dimensions, as above, and the strata of each dimension.
  constexpr int m = 8;
  const SobolSet4 set(1U << m);
  const SobolSet4::Scramble scramble(Key(5, Stream::Test, 9));
  std::vector<std::set<int>> boxes(m + 1), strata(4);
  SobolSet4::Points p;
  for (std::uint32_t first = 0; first < set.count(); first += SobolSet4::width) {
    set.points(first, scramble, p);
    for (std::size_t k = 0; k < SobolSet4::width; ++k) {
      for (int split = 0; split <= m; ++split) {
        const int x = static_cast<int>(std::ldexp(p.x[0][k], split));
        const int y = static_cast<int>(std::ldexp(p.x[1][k], m - split));
        boxes[static_cast<std::size_t>(split)].insert((x << (m - split)) | y);
      }
      for (std::size_t d = 0; d < 4; ++d) {
        strata[d].insert(static_cast<int>(std::ldexp(p.x[d][k], m)));
      }
    }
  }
  for (const auto& seen : boxes) EXPECT_EQ(seen.size(), 1U << m);
  for (const auto& seen : strata) EXPECT_EQ(seen.size(), 1U << m);
}

TEST(Random, ASobolSetOfFewIsANetThatComesAgain) {
  const SobolSet4 set(4);
  SobolSet4::Points p;
  set.points(0, SobolSet4::Scramble(Key(5, Stream::Test, 9)), p);
  std::set<int> quarters;
  for (std::size_t k = 0; k < 4; ++k) {
    quarters.insert(2 * static_cast<int>(2.0F * p.x[0][k]) + static_cast<int>(2.0F * p.x[1][k]));
    for (std::size_t d = 0; d < 4; ++d) EXPECT_EQ(p.x[d][k], p.x[d][k + 4]);
  }
  EXPECT_EQ(set.count(), 4U);
  EXPECT_EQ(quarters.size(), 4U);
}

TEST(Random, TheRunsOfASobolSetAreTogetherTheLargerSet) {
  const Key key(7, Stream::Test, 3);
  using Point = std::array<float, 4>;
  const auto add = [](const SobolSet4& set, const SobolSet4::Scramble& scramble,
                      std::multiset<Point>& found) {
    SobolSet4::Points p;
    for (std::uint32_t first = 0; first < set.count(); first += SobolSet4::width) {
      set.points(first, scramble, p);
      for (std::size_t k = 0; k < SobolSet4::width; ++k) {
        found.insert({p.x[0][k], p.x[1][k], p.x[2][k], p.x[3][k]});
      }
    }
  };
  std::multiset<Point> whole, in_runs;
  add(SobolSet4(256), SobolSet4::Scramble(key), whole);
  const SobolSet4 part(32);
  SobolSet4::Scramble scramble(key);
  for (std::uint32_t run = 0; run < 8; ++run) {
    part.go_to_run(run, scramble);
    add(part, scramble, in_runs);
  }
  EXPECT_EQ(in_runs, whole);
}

TEST(Random, SobolValuesStayInsideTheOpenUnitIntervalAndStratifyEachAxis) {
  const SobolOwen4 sobol(Key(6, Stream::Test, 1));
  for (std::size_t d = 0; d < 4; ++d) {
    std::vector<int> hits(256, 0);
    for (std::uint32_t i = 0; i < 256; ++i) {
      const float x = sobol.point(i)[d];
      ASSERT_GT(x, 0.0F);
      ASSERT_LT(x, 1.0F);
      ++hits[static_cast<std::size_t>(x * 256.0F)];
    }
    EXPECT_EQ(hits, std::vector<int>(256, 1)) << "dimension " << d;
  }
}

}  // namespace
}  // namespace earthshine::base
