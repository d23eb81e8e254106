// SPDX-License-Identifier: Apache-2.0
#include "studies/settings_choice.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"

namespace earthshine::tests {
namespace {

using studies::ChoiceRules;
using studies::choose_settings;
using studies::NoiseFound;
using studies::NoiseSetting;
using studies::SettingsChoice;
using studies::SolveState;

SolveState solved(double patch_error, double ray_error, double other = 0.0) {
  return {0.04, 1000.0, 256, patch_error, ray_error, other};
}

ChoiceRules wanting(double error) {
  ChoiceRules rules;
  rules.wanted = error;
  rules.rays_per_patch_cut = 100.0;
  rules.picture_rays = 1e6;
  rules.picture_noise = error;
  return rules;
}

double squared(double x) { return x * x; }

// Errors add in squares: 0.02^2 - 0.003^2 - 0.004^2 is left for the picture.
TEST(SettingsChoice, ASolveThatIsGoodEnoughIsKeptAndTheRestIsThePictures) {
  const SettingsChoice choice = choose_settings(solved(0.003, 0.004), wanting(0.02));
  EXPECT_TRUE(choice.keeps);
  EXPECT_TRUE(choice.reached);
  EXPECT_NEAR(choice.picture_noise, std::sqrt(squared(0.02) - squared(0.003) - squared(0.004)),
              1e-12);
  EXPECT_NEAR(choice.cost, 1e6 * squared(0.02 / choice.picture_noise), 1e-3);
}

// Whatever the state: what is chosen keeps its promise by the very laws, and nothing among twice or
// half its patches or rays that keeps it too is cheaper by more than the third that another solve
// must save.
TEST(SettingsChoice, ItIsTheCheapestThatReachesTheWantedError) {
  base::Rng rng(base::Key(1, base::Stream::Test, 0));
  int reached = 0, solves = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const SolveState state = solved(0.04 * rng.next(), 0.04 * rng.next(), 0.01 * rng.next());
    ChoiceRules rules = wanting(0.02 + 0.02 * rng.next());
    rules.picture_rays = std::pow(10.0, 5.0 + 3.0 * rng.next());
    const SettingsChoice best = choose_settings(state, rules);
    const auto left = [&](double patches, double rays) {
      return squared(rules.wanted) - squared(state.other_error) -
             squared(state.patch_error / patches) - squared(state.ray_error) / (patches * rays);
    };
    const auto cost = [&](double patches, double rays) {
      const double solve = patches == 1.0 && rays == 1.0
                               ? 0.0
                               : state.patches * patches * (1.25 * state.rays * rays + 100.0);
      return solve + rules.picture_rays * squared(rules.picture_noise) / left(patches, rays);
    };
    const double patches = best.patches / state.patches, rays = double(best.rays) / state.rays;
    if (!best.reached) continue;
    ++reached;
    solves += best.keeps ? 0 : 1;
    EXPECT_GE(left(patches, rays), 0.1 * squared(rules.wanted) * (1.0 - 1e-9));
    EXPECT_NEAR(best.picture_noise, std::sqrt(left(patches, rays)), 1e-12);
    EXPECT_NEAR(best.refine_error, state.refine_error / std::sqrt(patches), 1e-12);
    for (const double p : {0.5, 1.0, 2.0}) {
      for (const double r : {0.5, 1.0, 2.0}) {
        if (p * patches < 1.0 || p * patches > 4.0 || r * rays < 1.0 || r * rays > 4.0) continue;
        if (left(p * patches, r * rays) < 0.1 * squared(rules.wanted)) continue;
        EXPECT_GE(cost(p * patches, r * rays), cost(patches, rays) * (2.0 / 3.0 - 1e-9));
      }
    }
  }
  EXPECT_GT(reached, 100);
  EXPECT_GT(solves, 30);
}

TEST(SettingsChoice, WhereNothingReachesItTheNearestIsTaken) {
  const SettingsChoice choice = choose_settings(solved(0.5, 0.5), wanting(0.01));
  EXPECT_FALSE(choice.reached);
  EXPECT_DOUBLE_EQ(choice.patches, 4000.0);
  EXPECT_EQ(choice.rays, 1024);
}

TEST(SettingsChoice, WhatMayNotChangeStaysAsItIs) {
  ChoiceRules rules = wanting(0.01);
  rules.may_cut = false;
  EXPECT_DOUBLE_EQ(choose_settings(solved(0.5, 0.5), rules).patches, 1000.0);
  rules.may_cut = true;
  rules.may_cast = false;
  EXPECT_EQ(choose_settings(solved(0.5, 0.5), rules).rays, 256);
  rules.may_cut = false;
  EXPECT_TRUE(choose_settings(solved(0.5, 0.5), rules).keeps);
}

TEST(SettingsChoice, NothingIsAskedForThatDoesNotFitIntoMemory) {
  ChoiceRules rules = wanting(0.01);
  rules.fits = [](double patches, int rays) { return patches * rays <= 600000.0; };
  const SettingsChoice choice = choose_settings(solved(0.5, 0.5), rules);
  EXPECT_LE(choice.patches * choice.rays, 600000.0);
  EXPECT_FALSE(choice.keeps);
  rules.fits = [](double, int) { return false; };
  EXPECT_TRUE(choose_settings(solved(0.5, 0.5), rules).keeps);
}

// Without a picture all of the error is the solution's.
TEST(SettingsChoice, ASolutionAloneMayUseTheWholeError) {
  ChoiceRules rules = wanting(0.02);
  rules.picture_rays = 0.0;
  EXPECT_TRUE(choose_settings(solved(0.0, 0.0199), rules).keeps);
  EXPECT_FALSE(choose_settings(solved(0.0, 0.0201), rules).keeps);
}

// Noise goes with the setting: (gather g'/g)^2 + (samples s'/s)^2 = wanted^2; and rays with its
// inverse square: any other split of the squares costs more.
TEST(NextSetting, BringsTheNoiseToTheWantedOneWithTheFewestRays) {
  const NoiseSetting before{0.02, 0.03};
  const NoiseFound found{0.03, 0.01, 5e6, 2e6};
  const double wanted = 0.02;
  const NoiseSetting next = studies::next_setting(before, found, wanted);
  const double gather = found.gather * next.gather / before.gather;
  const double samples = found.samples * next.samples / before.samples;
  EXPECT_NEAR(std::hypot(gather, samples), wanted, 1e-12);
  const auto rays = [&](double share) {
    return found.gather_rays * squared(found.gather / wanted) / share +
           found.sample_rays * squared(found.samples / wanted) / (1.0 - share);
  };
  const double share = squared(gather / wanted);
  EXPECT_LT(rays(share), rays(0.9 * share));
  EXPECT_LT(rays(share), rays(1.1 * share));
}

TEST(NextSetting, AnEndWithoutNoiseIsNotPaidFor) {
  const NoiseSetting next = studies::next_setting({0.02, 0.02}, {0.0, 0.02, 1e6, 1e6}, 0.02);
  EXPECT_DOUBLE_EQ(next.gather, 8.0 * 0.02);
  EXPECT_NEAR(next.samples, 0.02, 1e-12);
}

TEST(NextSetting, OneStepIsNoLargerThanEight) {
  const NoiseSetting next = studies::next_setting({0.02, 0.02}, {5.0, 5.0, 1e6, 1e6}, 0.01);
  EXPECT_DOUBLE_EQ(next.gather, 0.02 / 8.0);
  EXPECT_DOUBLE_EQ(next.samples, 0.02 / 8.0);
}

}  // namespace
}  // namespace earthshine::tests
