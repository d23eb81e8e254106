// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "studies/accuracy/findings.h"

namespace earthshine::studies {
namespace {

TEST(Ladder, LeavesOutWhatHasNothingToVary) {
  scenes::Scene scene;
  scenes::Effects effects;
  const auto has = [](const std::vector<AccuracyStep>& steps, const std::string& name) {
    return std::any_of(steps.begin(), steps.end(),
                       [&](const AccuracyStep& s) { return s.series == name; });
  };
  std::vector<AccuracyStep> steps = accuracy_ladder(scene, effects, {});
  for (const char* name :
       {series::patches, series::form_factor_rays, series::gather_rays, series::lights}) {
    EXPECT_FALSE(has(steps, name)) << name;
  }
  effects.solution = effects.earth = true;
  steps = accuracy_ladder(scene, effects, {});
  for (const char* name :
       {series::error, series::patches, series::form_factor_rays, series::gather_rays,
        series::camera_samples, series::lights, series::samples}) {
    EXPECT_TRUE(has(steps, name)) << name;
  }
}

TEST(Ladder, StartsWithTheCheapestOfEverySeries) {
  scenes::Effects effects;
  effects.solution = effects.earth = true;
  const std::vector<AccuracyStep> steps = accuracy_ladder({}, effects, {});
  std::set<std::string> seen;
  for (std::size_t k = 0; k < 8; ++k) seen.insert(steps[k].series + steps[k].method);
  EXPECT_EQ(seen.size(), 8U);
  for (const AccuracyStep& a : steps) {
    for (const AccuracyStep& b : steps) {
      const bool later = &a < &b && a.series == b.series && a.method == b.method;
      EXPECT_TRUE(!later || a.work < b.work) << b.name();
    }
  }
}

TEST(Ladder, StepsSayTheWordsThatDrawThem) {
  scenes::Effects effects;
  effects.solution = effects.earth = true;
  for (const AccuracyStep& step : accuracy_ladder({}, effects, {})) {
    const std::vector<std::string> words = step.options();
    if (step.series == series::patches && step.setting == 0.25) {
      EXPECT_EQ(words, (std::vector<std::string>{"--set", "quality.patch_edge=0.25"}));
    }
    if (step.method == "paths" && step.setting == 16) {
      EXPECT_EQ(words, (std::vector<std::string>{"--indirect", "paths", "--set",
                                                 "quality.gather_rays=16"}));
    }
    if (step.method == "distributed") {
      EXPECT_EQ(words[1], "distributed");
      EXPECT_EQ(words[3], std::to_string(step.lights));
    }
  }
}

TEST(Ladder, ExpectationFollowsTheSeriesThenTheMean) {
  AccuracyStep a, b;
  a.series = "one";
  a.work = 2.0;
  b.series = "two";
  AccuracyStep next = a;
  next.work = 6.0;
  EXPECT_EQ(expected_seconds(next, {}), 0.0);
  EXPECT_EQ(expected_seconds(next, {{b, 4.0}}), 4.0);
  EXPECT_EQ(expected_seconds(next, {{b, 4.0}, {a, 5.0}}), 15.0);
}

MeasuredStep measured(const char* method, const char* series, double setting, double seconds,
                      double error, double setting_error) {
  MeasuredStep point;
  point.step.method = method;
  point.step.series = series;
  point.step.setting = setting;
  point.cost.cpu_seconds = seconds;
  point.error.error = error;
  point.setting_error.error = setting_error;
  return point;
}

// Paths at 10 s have 4 %; the error falls with the root of the time: 1 % takes 160 s.
TEST(Findings, AnswersAreTheCheapestReachedOrSayWhatPathsWouldTake) {
  const std::vector<MeasuredStep> points = {
      measured("radiosity", series::error, 0.1, 1.0, 0.08, 0.08),
      measured("radiosity", series::error, 0.02, 3.0, 0.018, 0.015),
      measured("paths", series::samples, 4, 1.0, 0.126, 0.126),
      measured("paths", series::samples, 40, 10.0, 0.04, 0.04)};
  const Findings found = find_accuracy(points, {0.05, 0.02, 0.01}, 0.002);
  ASSERT_EQ(found.answers.size(), 3U);
  EXPECT_EQ(found.answers[0].best, 1U);
  EXPECT_EQ(found.answers[0].methods[1].point, 3U);
  EXPECT_EQ(found.answers[1].best, 1U);
  EXPECT_FALSE(found.answers[2].best);
  EXPECT_NEAR(*found.answers[2].methods[1].expected_seconds, 160.0, 1e-9);
  EXPECT_FALSE(found.answers[2].methods[0].expected_seconds);
  EXPECT_EQ(found.front, (std::vector<std::size_t>{0, 1}));
}

// A method whose limit is 9 % has no picture within 5 %, but settings within 5 %.
TEST(Findings, TheLimitIsKeptApartFromTheSetting) {
  const std::vector<MeasuredStep> points = {
      measured("radiosity", series::error, 0.1, 1.0, 0.12, 0.08),
      measured("radiosity", series::error, 0.02, 3.0, 0.098, 0.04),
      measured("radiosity", series::error, 0.01, 9.0, 0.091, 0.01)};
  const Findings found = find_accuracy(points, {0.05}, 0.002);
  EXPECT_FALSE(found.answers[0].best);
  EXPECT_FALSE(found.answers[0].methods[0].point);
  EXPECT_EQ(found.answers[0].methods[0].setting, 1U);
}

// Errors below the reference's resolution count as the resolution.
TEST(Findings, TheReferenceLimitsWhatIsSaid) {
  const std::vector<MeasuredStep> points = {
      measured("radiosity", series::error, 0.1, 1.0, 0.001, 0.001),
      measured("radiosity", series::error, 0.05, 2.0, 0.0, 0.0)};
  const Findings found = find_accuracy(points, {0.05, 0.01}, 0.03);
  EXPECT_TRUE(found.answers[0].is_resolved);
  EXPECT_FALSE(found.answers[1].is_resolved);
  EXPECT_EQ(found.front, (std::vector<std::size_t>{0}));  // the second is not measurably better
  EXPECT_FALSE(found.laws.front().law);
  EXPECT_EQ(found.worth.front().down_to, 0.03);
}

TEST(Findings, NothingMeasuredFindsNothing) {
  const Findings found = find_accuracy({}, {0.05}, 0.0);
  EXPECT_TRUE(found.front.empty());
  EXPECT_TRUE(found.worth.empty());
  EXPECT_TRUE(found.laws.empty());
  ASSERT_EQ(found.answers.size(), 1U);
  EXPECT_FALSE(found.answers[0].best);
}

}  // namespace
}  // namespace earthshine::studies
