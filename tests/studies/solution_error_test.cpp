// SPDX-License-Identifier: Apache-2.0
// Second looks made of numbers whose errors are known.
#include "studies/solution_error.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/studies/normal.h"

namespace earthshine::studies {
namespace {

struct Truth {
  std::size_t values = 100;
  bool together = false;     // all values go up and down as one
  double ray_sigma = 0.0;    // of a few-ray look
  double point_sigma = 0.0;  // of the direct light of a few-ray look
  double patches = 0.0;      // RMS error of the solution's own patches
  double order = 2.0;        // in which it falls with the edge
  radiosity::SecondLooks made{.ray_share = 1.0 / 32.0, .point_share = 0.25, .error_ratio = 0.5};
};

constexpr double mean_value = 4.0;

struct Made {
  Looks looks;
  double realised = 0.0;  // relative RMS error of the solution, all causes
};

class Maker {
 public:
  Maker(const Truth& truth, std::uint64_t seed) : truth_(truth), normal_(seed) {
    for (std::size_t i = 0; i < truth.values; ++i) {
      pattern_.push_back(truth.patches * std::sqrt(2.0) *
                         std::sin(2.0 * M_PI * (double(i) + 0.5) / double(truth.values)));
    }
  }
  Made make() {
    const double ray = std::sqrt(truth_.made.ray_share), point = std::sqrt(truth_.made.point_share);
    Made made;
    made.looks.own = values(1.0, ray, point);
    for (int k = 0; k < 4; ++k) {
      made.looks.add(radiosity::Look::FewRays, values(1.0, 1.0, 1.0));
      std::vector<double> direct = noise(truth_.point_sigma);
      for (std::size_t i = 0; i < truth_.values; ++i) direct[i] += made.looks.own[i];
      made.looks.add(radiosity::Look::OtherDirect, direct);
    }
    const double left = std::pow(truth_.made.error_ratio, truth_.order);
    for (int k = 0; k < 2; ++k) {
      made.looks.add(radiosity::Look::OtherPatches,
                     values(truth_.made.finer ? left : 1.0 / left, ray * std::sqrt(2.0), point));
    }
    for (const double value : made.looks.own) made.realised += std::pow(value - mean_value, 2.0);
    made.realised = std::sqrt(made.realised / double(truth_.values)) / mean_value;
    return made;
  }

 private:
  std::vector<double> noise(double sigma) {
    std::vector<double> drawn(truth_.values, sigma > 0.0 ? sigma * normal_.next() : 0.0);
    for (std::size_t i = 0; i < drawn.size() && sigma > 0.0 && !truth_.together; ++i) {
      drawn[i] = sigma * normal_.next();
    }
    return drawn;
  }
  std::vector<double> values(double patches, double rays, double points) {
    const std::vector<double> by_rays = noise(truth_.ray_sigma * rays);
    const std::vector<double> by_points = noise(truth_.point_sigma * points);
    std::vector<double> all;
    for (std::size_t i = 0; i < truth_.values; ++i) {
      all.push_back(mean_value + patches * pattern_[i] + by_rays[i] + by_points[i]);
    }
    return all;
  }

  const Truth& truth_;
  tests::Normal normal_;
  std::vector<double> pattern_;
};

SolutionError error_of(const Truth& truth, const Looks& looks, double solver_error = 0.0) {
  return solution_error(looks, truth.made, solver_error, mean_value);
}

TEST(SolutionError, GivesTheNoiseOfEachCauseBack) {
  // 20 000 values: the solution's own distance from the few-ray looks, the noisiest of what is
  // read, has a mean square of relative standard error sqrt(2 / 20 000) = 1 %, its root half of it.
  Truth truth;
  truth.values = 20000;
  truth.ray_sigma = 0.8;
  truth.point_sigma = 0.4;
  const SolutionError error = error_of(truth, Maker(truth, 1).make().looks, 1e-3);
  EXPECT_NEAR(error.form_factors.estimate / (0.8 / std::sqrt(32.0) / mean_value), 1.0, 0.025);
  EXPECT_NEAR(error.lamps.estimate / (0.4 / 2.0 / mean_value), 1.0, 0.02);
  EXPECT_EQ(error.solver.estimate, 1e-3);
  EXPECT_EQ(error.solver.bound_95, 1e-3);
  // What is left of the patches is noise of (own - a)(own - b) alone: of variance below
  // 2 (s0^2 + s^2)^2 / 20 000 with s0^2 + s^2 = 0.06 + 0.08; times 1/3 for a second order.
  EXPECT_LT(error.patches.estimate,
            2.0 * std::sqrt(0.14 * std::sqrt(2.0 / 20000)) / 3 / mean_value);
}

TEST(SolutionError, GivesThePatchesOfACoarserAndAFinerCutBack) {
  // Without noise there is no chance. The estimate takes the second order.
  for (const bool finer : {false, true}) {
    for (const double ratio : {0.25, 0.5, 0.6}) {
      Truth truth;
      truth.patches = 0.2;
      truth.made.finer = finer;
      truth.made.error_ratio = ratio;
      const SolutionError second = error_of(truth, Maker(truth, 1).make().looks);
      EXPECT_NEAR(second.patches.estimate, 0.2 / mean_value, 1e-9);
      EXPECT_GE(second.patches.bound_95, 0.2 / mean_value);
      // Of a lower order, as at hard shadows, it underrates the error; the bound is it.
      truth.order = 0.75;
      const SolutionError sharp = error_of(truth, Maker(truth, 1).make().looks);
      EXPECT_LT(sharp.patches.estimate, 0.2 / mean_value);
      EXPECT_NEAR(sharp.patches.bound_95, 0.2 / mean_value, 1e-9);
    }
  }
}

// One of 100 among 19 of 0: mean 5, it counts as 4 times 5. An error of a tenth of it is one of 2
// there: RMS 2 / sqrt(20) over 5.
TEST(SolutionError, BrightValuesCountInProportion) {
  Looks looks;
  looks.own.assign(20, 0.0);
  looks.own[7] = 100.0;
  looks.few_rays.assign(4, looks.own);
  looks.other_direct.assign(4, looks.own);
  std::vector<double> other = looks.own;
  other[7] = 90.0;
  looks.other_patches.assign(2, other);
  const SolutionError error =
      weighed_error(looks, {.error_ratio = std::sqrt(0.5), .finer = false}, 0.0);
  // q = r^2 = 1/2: q / (1 - q) = 1. The mean is too bright by 2 / 20 of 5.
  EXPECT_NEAR(error.patches.estimate, 2.0 / std::sqrt(20.0) / (5.0 * 0.98), 1e-12);
}

// A room has 35 times the light that it should: what leaks in goes with the patch edge, and the
// other cut, of half the edge, shows (1 + 34 / 2) of the 35. The error is 34 times the truth, which
// is 34 / 35 of what is seen.
TEST(SolutionError, IsRelativeToWhatTheMeanShouldBe) {
  Looks looks;
  looks.own.assign(20, 35.0);
  looks.few_rays.assign(4, looks.own);
  looks.other_direct.assign(4, looks.own);
  looks.other_patches.assign(2, std::vector<double>(20, 18.0));
  const SolutionError error = weighed_error(looks, {.error_ratio = 0.5, .finer = true}, 0.0);
  EXPECT_GT(error.patches.bound_95, 34.0);
  // By the second order 17 / (1 - 1/4) = 22.7 are too much.
  EXPECT_NEAR(error.patches.estimate, (17.0 / 0.75) / (35.0 - 17.0 / 0.75), 1e-9);
}

TEST(SolutionError, PatchesAreFreeOfNoiseOnAverage) {
  // The square of what is found, before the root: mean over many draws within four standard errors.
  // A difference of 3 * 0.05 with noise well above it.
  Truth truth;
  truth.values = 400;
  truth.ray_sigma = 0.8;
  truth.point_sigma = 0.2;
  truth.patches = 0.1;
  Maker maker(truth, 3);
  constexpr int times = 400;
  double sum = 0.0, squares = 0.0;
  for (int k = 0; k < times; ++k) {
    const double found = error_of(truth, maker.make().looks).patches.estimate * mean_value;
    sum += found * found;
    squares += std::pow(found, 4.0);
  }
  const double mean = sum / times;
  const double error = std::sqrt((squares / times - mean * mean) / times);
  // The form factors' variance is the larger of two estimates, each of relative standard error
  // sqrt(2 / (3 * 400)) = 4 % and sqrt(2 / 400) = 7 %: 5 % more of 0.02 is taken off than was
  // there, over 9.
  EXPECT_NEAR(mean, 0.01, 4.0 * error + 0.05 * 0.02 / 9.0);
}

TEST(SolutionError, PatchesBoundHoldsInNoise) {
  // Of the order at whose share the bound is the error itself: noise of the looks well above
  // the difference leaves it on either side, and the bound adds what that is.
  Truth truth;
  truth.ray_sigma = 2.0;
  truth.patches = 0.1;
  truth.order = 0.75;
  Maker maker(truth, 9);
  constexpr int times = 1000;
  int holds = 0;
  for (int k = 0; k < times; ++k) {
    if (error_of(truth, maker.make().looks).patches.bound_95 >= 0.1 / mean_value) ++holds;
  }
  EXPECT_GE(holds / double(times), 0.95 - 4.0 * std::sqrt(0.95 * 0.05 / times));
}

TEST(SolutionError, BoundHolds) {
  constexpr int times = 1000;
  const double least = 0.95 - 4.0 * std::sqrt(0.95 * 0.05 / times);
  for (const bool together : {false, true}) {
    for (const double order : {1.0, 2.0}) {
      for (const bool finer : {false, true}) {
        Truth truth;
        truth.values = 60;
        truth.together = together;
        truth.ray_sigma = 0.8;
        truth.point_sigma = 0.2;
        truth.patches = 0.1;
        truth.order = order;
        truth.made.finer = finer;
        Maker maker(truth, 5);
        int holds = 0;
        for (int k = 0; k < times; ++k) {
          const Made made = maker.make();
          if (made.realised <= error_of(truth, made.looks).total().bound_95) ++holds;
        }
        EXPECT_GE(holds / double(times), least) << together << order << finer;
      }
    }
  }
}

TEST(SolutionError, LightThatTheFewRaysAllMissIsDoubted) {
  // The solution has 1 where all looks of a 32nd of the rays have 0: (1 - 0)^2 / (1/32 + 1/4) is
  // the variance of a look that their distance tells, a 32nd of it the solution's: 1 / 9.
  Truth truth;
  truth.made.point_share = 0.25;
  Looks looks;
  looks.own.assign(50, 1.0);
  looks.few_rays.assign(4, std::vector<double>(50, 0.0));
  looks.other_direct.assign(4, looks.own);
  looks.other_patches.assign(2, looks.own);
  const SolutionError error = solution_error(looks, truth.made, 0.0, 1.0);
  EXPECT_NEAR(error.form_factors.estimate, 1.0 / 3.0, 1e-12);
  EXPECT_GT(error.form_factors.bound_95, 1.0);
  EXPECT_EQ(error.lamps.estimate, 0.0);
}

TEST(SolutionError, NothingSeenOrBlackHasNone) {
  Truth truth;
  Looks looks = Maker(truth, 1).make().looks;
  EXPECT_EQ(solution_error(looks, truth.made, 1.0, 0.0).total().bound_95, 0.0);
  looks = some_of(looks, {});
  EXPECT_EQ(error_of(truth, looks, 1.0).total().bound_95, 0.0);
}

TEST(SolutionError, SomeOfTheLooksAreThoseAskedFor) {
  Looks looks;
  looks.own = {1, 2, 3};
  looks.add(radiosity::Look::FewRays, {4, 5, 6});
  looks.add(radiosity::Look::OtherDirect, {7, 8, 9});
  looks.add(radiosity::Look::OtherPatches, {10, 11, 12});
  const std::vector<std::uint32_t> which{2, 0};
  const Looks some = some_of(looks, which);
  EXPECT_EQ(some.own, (std::vector<double>{3, 1}));
  EXPECT_EQ(some.few_rays.at(0), (std::vector<double>{6, 4}));
  EXPECT_EQ(some.other_direct.at(0), (std::vector<double>{9, 7}));
  EXPECT_EQ(some.other_patches.at(0), (std::vector<double>{12, 10}));
}

}  // namespace
}  // namespace earthshine::studies
