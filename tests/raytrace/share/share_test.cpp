// SPDX-License-Identifier: Apache-2.0
// Denoising between neighbouring gather points, with synthetic estimates.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "base/numbers/random.h"
#include "base/parallel.h"
#include "tests/raytrace/share/flat_estimate.h"

namespace earthshine::raytrace::flat_estimate {
namespace {

TEST(Share, WhatBothHalvesAgreeOnIsKept) {
  // Without noise every detail is signal, however fine, and the error is 0.
  const auto fine = [](int x, int y, std::size_t) {
    return 10.0 + ((x / 3 + y / 5) % 2) + 0.1 * x;
  };
  const Shared shared = share(Neighbours(window, flat()), estimate_of(fine));
  for (int y = 0; y < edge_px; ++y) {
    for (int x = 0; x < edge_px; ++x) {
      EXPECT_NEAR(double(shared.radiance[pixel(x, y)].g), fine(x, y, 0), 1e-4);
      EXPECT_EQ(shared.squared_error[pixel(x, y)], 0.0F);
    }
  }
}

TEST(Share, NoiseFallsAndNoLessIsStated) {
  // Independent noise of variance 1 per sample, mean 10; the mean of two has 1/2. Over 200 fields,
  // at one point each: squared errors have a relative standard error of sqrt(2 / 200). Chance
  // signals may increase the stated error.
  constexpr int fields = 200;
  const Neighbours neighbours(window, flat());
  double found = 0.0, stated = 0.0;
  for (std::uint64_t seed = 1; seed <= fields; ++seed) {
    base::Rng rng(base::Key(seed, base::Stream::Test, 4));
    const Shared shared = share(neighbours, estimate_of([&](int, int, std::size_t) {
                                  return 10.0 + std::sqrt(12.0) * (rng.next() - 0.5);
                                }));
    const double off = double(shared.radiance[pixel(24, 24)].g) - 10.0;
    found += off * off / fields;
    stated += double(shared.squared_error[pixel(24, 24)]) / fields;
  }
  EXPECT_LT(found / stated, 1.0 + 4.0 * std::sqrt(2.0 / fields));
  EXPECT_LT(stated, 0.5 / 8.0);
}

// A detail of signal s and noise q with the gain c = s' / (s' + q), s' = s - 0.3 q, leaves
// (1 - c)^2 s + c^2 q; here s = 2 q, c = 17 / 27. The signal of a finer detail with gain 0 is
// limited to the range from 0 to that signal. An off-grid point has no coarser details, and a
// detail with a positive gain keeps its signal: s = 200, q = 100.
TEST(Share, WhatNoiseHidesIsNoMoreThanCoarserDetailsHold) {
  Shared shared;
  shared.resize(4);
  shared.signal[1] = {2.0F, 2.0F, 0.0F, 2.0F};
  shared.noise[1] = {1.0F, 1.0F, 0.0F, 1.0F};
  shared.signal[0] = {5.0F, -5.0F, 5.0F, 200.0F};
  shared.noise[0] = {100.0F, 100.0F, 100.0F, 100.0F};
  constexpr double c = 17.0 / 27.0, coarser = (1.0 - c) * (1.0 - c) * 2.0 + c * c;
  EXPECT_NEAR(shared.squared_error_with(0, 1.0), coarser + 2.0, 1e-5);
  EXPECT_NEAR(shared.squared_error_with(1, 1.0), coarser, 1e-5);
  EXPECT_NEAR(shared.squared_error_with(2, 1.0), 5.0, 1e-5);
  EXPECT_NEAR(shared.squared_error_with(3, 1.0), 101.0 * coarser, 1e-4);
}

// A signal from N = 8 details has the standard error sqrt(2 / 8) q; 0.7 times it is subtracted:
// s' = 2 - 0.3 - 0.35 = 1.35 and c = 1.35 / 2.35 for s = 2, q = 1. Stein's term,
// 4 (s + q) (1 - c)^2 / N, is added to the remaining error.
TEST(Share, WhatFewDetailsSayIsDoubtedMore) {
  Shared shared;
  shared.resize(1);
  shared.signal[0] = {2.0F};
  shared.noise[0] = {1.0F};
  shared.inverse_dof[0] = {0.125F};
  constexpr double c = 1.35 / 2.35, lost = (1.0 - c) * (1.0 - c);
  EXPECT_NEAR(shared.squared_error_with(0, 1.0), 2.0 * lost + c * c + 12.0 * lost / 8.0, 1e-5);
}

TEST(Share, NothingIsSharedAcrossAnEdgeOrAStep) {
  // Two planes that meet at x = 20, turned by 90 degrees or half a metre apart, with different
  // light and equal noise: the means stay separate.
  for (const bool step : {false, true}) {
    std::vector<GatherPoint> points = flat();
    for (int y = 0; y < edge_px; ++y) {
      for (int x = 20; x < edge_px; ++x) {
        GatherPoint& point = points[pixel(x, y)];
        if (step) point.position.z -= 0.5F;
        if (!step) point.normal = glm::vec3(1.0F, 0.0F, 0.0F);
      }
    }
    const auto noisy = [](int x, int y, std::size_t half) {
      const double sign = (x + y + static_cast<int>(half)) % 2 == 0 ? 1.0 : -1.0;
      return (x < 20 ? 1.0 : 70.0) * (1.0 + 0.3 * sign);
    };
    const Shared shared = share(Neighbours(window, points), estimate_of(noisy));
    for (int y = 0; y < edge_px; ++y) {
      EXPECT_NEAR(double(shared.radiance[pixel(19, y)].g), 1.0, 0.3) << step;
      EXPECT_NEAR(double(shared.radiance[pixel(20, y)].g), 70.0, 21.0) << step;
    }
  }
}

TEST(Share, PointsThatHaveNoSamplesTakeThoseAround) {
  Estimate sparse = estimate_of([](int, int, std::size_t) { return 3.0; });
  for (std::size_t p = 0; p < count; ++p) {
    if (p % 3 == 0) continue;
    sparse.clear(p);
  }
  const Shared shared = share(Neighbours(window, flat()), sparse);
  for (const glm::vec3& value : shared.radiance) EXPECT_NEAR(double(value.g), 3.0, 1e-4);
}

TEST(Share, WhatFewPointsSayLeavesNoLattice) {
  // One point of 25 is sampled, with noise only. Coarser levels step over pixels, so that
  // neighbouring pixels read different points. Yet they should differ by no more than one step of a
  // linear transition between points five pixels apart: a fifth of the difference of two
  // independent values, 2 / 25 of their mean square each, or twice that with the remaining details.
  const Neighbours neighbours(window, flat());
  double off = 0.0, apart = 0.0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    base::Rng rng(base::Key(seed, base::Stream::Test, 35));
    Estimate estimate =
        estimate_of([&](int, int, std::size_t) { return rng.next() < 0.1 ? 10.0 : 0.0; });
    for (std::size_t p = 0; p < count; ++p) {
      if (p % edge_px % 5 != 2 || p / edge_px % 5 != 2) estimate.clear(p);
    }
    const Shared shared = share(neighbours, estimate);
    for (int y = 8; y < edge_px - 8; ++y) {
      for (int x = 8; x < edge_px - 8; ++x) {
        const double value = double(shared.radiance[pixel(x, y)].g);
        off += (value - 1.0) * (value - 1.0);
        apart += std::pow(double(shared.radiance[pixel(x + 1, y)].g) - value, 2);
      }
    }
  }
  EXPECT_LT(apart, 4.0 / 25.0 * off);
}

// Means of two samples, uniform over [0, 1), have the variance 1 / 24. The other points state it
// for a point whose two samples happen to agree: with 4 noise fields over windows of about 60
// points, within a factor of two.
TEST(Share, WhatKeepsAllOfItsOwnStillTellsNoiseByOthers) {
  base::Rng rng(base::Key(3, base::Stream::Test, 4));
  const Estimate estimate = estimate_of([&](int, int, std::size_t) { return rng.next(); });
  const Shared shared = share(Neighbours(window, flat()), estimate, Keep::All);
  double mean = 0.0;
  for (std::size_t p = 0; p < count; ++p) {
    const double own = double(estimate.sum[p].g) / 2.0;
    EXPECT_NEAR(double(shared.radiance[p].g), own, 1e-5);
    EXPECT_GT(double(shared.squared_error[p]), 0.5 / 24.0);
    EXPECT_LT(double(shared.squared_error[p]), 2.0 / 24.0);
    mean += double(shared.squared_error[p]) / count;
  }
  // (a - b)^2 / 4 of uniform a, b has the mean 1 / 24 and the variance 7 / 2880.
  EXPECT_NEAR(mean, 1.0 / 24.0, 4.0 * std::sqrt(7.0 / 2880.0 / count));
}

// A point without neighbours has only its own two halves: for 0 and 1 the variance is
// (0 - 1)^2 / 4.
TEST(Share, WhatIsAloneTellsItsNoiseByItsHalves) {
  std::vector<GatherPoint> points = flat();
  for (std::size_t p = 1; p < count; ++p) points[p].reach_m = -1.0F;
  const Estimate estimate = estimate_of([](int, int, std::size_t half) { return double(half); });
  const Shared shared = share(Neighbours(window, points), estimate, Keep::All);
  EXPECT_NEAR(double(shared.squared_error[0]), 0.25, 1e-5);
  EXPECT_NEAR(double(shared.radiance[0].g), 0.5, 1e-6);
}

TEST(Share, MoreSamplesAreExpectedToHelp) {
  base::Rng rng(base::Key(5, base::Stream::Test, 4));
  const Shared shared =
      share(Neighbours(window, flat()),
            estimate_of([&](int x, int, std::size_t) { return std::sin(0.3 * x) + rng.next(); }));
  for (std::size_t p = 0; p < count; ++p) {
    const double now = shared.squared_error_with(p, 1.0);
    EXPECT_NEAR(now, double(shared.squared_error[p]), 1e-5 * now);
    EXPECT_LE(shared.squared_error_with(p, 1e6), 1e-3 * now);
  }
}

TEST(Share, ManySamplesKeepTheirOwnAmongFew) {
  // Different light at every point, of variance s = 0.2, and samples of variance v = 2: 200 in
  // blocks of 3 x 3, 2 elsewhere. Without denoising, a point of a block has the error v / 200.
  // Denoising with the right noise leaves no more (Wiener: s q / (s + q) < q), in a mean of N
  // squares of normal numbers with the relative error sqrt(2 / N).
  constexpr double s = 0.2, v = 2.0, many = 200.0;
  base::Rng rng(base::Key(5, base::Stream::Test, 31));
  const auto normal = [&] {
    return std::sqrt(-2.0 * std::log(1.0 - rng.next())) * std::cos(2.0 * base::pi * rng.next());
  };
  const auto has_many = [](std::size_t p) { return p % edge_px % 8 < 3 && p / edge_px % 8 < 3; };
  Estimate estimate(count, 1, 1);
  std::vector<double> truth;
  for (std::size_t p = 0; p < count; ++p) {
    truth.push_back(10.0 + std::sqrt(s) * normal());
    const double samples = has_many(p) ? many : 2.0, half = samples / 2.0;
    const auto of_half = [&] {
      return static_cast<float>(half * (truth[p] + std::sqrt(v / half) * normal()));
    };
    const float first = of_half(), second = of_half();
    estimate.add_luminance(p, first, second);
    estimate.sum[p] = glm::vec3(first + second);
    estimate.samples[p] = static_cast<float>(samples);
  }
  const Shared shared = share(Neighbours(window, flat()), estimate);
  double found = 0.0, of = 0.0;
  for (std::size_t p = 0; p < count; ++p) {
    if (!has_many(p)) continue;
    found += std::pow(double(shared.radiance[p].g) - truth[p], 2);
    of += 1.0;
  }
  EXPECT_LT(found / of, v / many * (1.0 + 4.0 * std::sqrt(2.0 / of)));
}

TEST(Share, SameBytesOnOneAndTwoThreads) {
  base::Rng rng(base::Key(7, base::Stream::Test, 4));
  const Estimate estimate = estimate_of([&](int, int, std::size_t) { return rng.next(); });
  const auto run = [&](int threads) {
    const base::ThreadLimit limit(threads);
    return share(Neighbours(window, flat()), estimate).radiance;
  };
  EXPECT_EQ(run(1), run(2));
}

}  // namespace
}  // namespace earthshine::raytrace::flat_estimate
