// SPDX-License-Identifier: Apache-2.0
// Scaling laws of the predicted cost for synthetic reports with sums computed by hand. The bill
// includes each ray and each second exactly once.
#include "studies/cost/cost.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "studies/cost/cost_laws.h"
#include "tests/base/silent_ranks.h"
#include "tests/support/scene_builder.h"

namespace earthshine::studies {
namespace {

using scenes::LightKind;

constexpr std::size_t at(LightKind kind) { return static_cast<std::size_t>(kind); }

double seconds_of(const radiosity::SolveReport& report, const std::string& stage) {
  for (const auto& [name, seconds] : report.seconds) {
    if (name == stage) return seconds;
  }
  ADD_FAILURE() << "no stage " << stage;
  return 0.0;
}

radiosity::SolveReport small_solve() {
  radiosity::SolveReport report;
  report.patches = 1000;
  report.form_factor_rays = 64000;
  report.refinement_rays = 10000;
  report.nonzeros = 50000;
  report.seconds = {{"patches", 1.0},      {"form factors", 2.0}, {"balance", 3.0},
                    {"direct light", 5.0}, {"linear solve", 7.0}, {"ledger", 11.0}};
  report.sources_cost[at(LightKind::Sun)] = {8000, 1.5};
  report.sources_cost[at(LightKind::Emitter)] = {4000, 3.5};
  report.shadow_rays = 12000;
  return report;
}

// Four times the patches with 16 times the rays each, rows of 200 entries instead of 50: 4 * 16
// form-factor rays, 4 * 4 entries.
TEST(CostLaws, ASolveGrowsWithItsPatchesRaysAndEntries) {
  const radiosity::SolveReport whole = scaled(small_solve(), {4000.0, 16.0, 200.0, false});
  EXPECT_EQ(whole.patches, 4000U);
  EXPECT_EQ(whole.form_factor_rays, 64U * 64000U);
  EXPECT_EQ(whole.nonzeros, 800000U);
  EXPECT_DOUBLE_EQ(seconds_of(whole, "form factors"), 64 * 2.0);
  EXPECT_DOUBLE_EQ(seconds_of(whole, "balance"), 16 * 3.0);
  EXPECT_DOUBLE_EQ(seconds_of(whole, "linear solve"), 16 * 7.0);
  EXPECT_DOUBLE_EQ(seconds_of(whole, "direct light"), 4 * 5.0);
  EXPECT_DOUBLE_EQ(seconds_of(whole, "ledger"), 4 * 11.0);
  EXPECT_DOUBLE_EQ(seconds_of(whole, "patches"), 4 * 1.0);
  EXPECT_EQ(whole.sources_cost[at(LightKind::Sun)].rays, 32000U);
  EXPECT_DOUBLE_EQ(whole.sources_cost[at(LightKind::Emitter)].seconds, 14.0);
  EXPECT_EQ(whole.shadow_rays, 48000U);
}

// Its rounds use an eighth of the rays: 16 / 8 = 2 times as many as the small one's, on 4 times the
// patches; never fewer than the small one's.
TEST(CostLaws, RefinementGrowsWithAnEighthOfTheRays) {
  const radiosity::SolveReport whole = scaled(small_solve(), {4000.0, 16.0, 200.0, true});
  EXPECT_EQ(whole.refinement_rays, 80000U);
  EXPECT_DOUBLE_EQ(seconds_of(whole, "patches"), 8.0);
  const radiosity::SolveReport few = scaled(small_solve(), {4000.0, 1.0, 50.0, true});
  EXPECT_EQ(few.refinement_rays, 40000U);
  const radiosity::SolveReport fewer = scaled(small_solve(), {500.0, 1.0, 50.0, true});
  EXPECT_DOUBLE_EQ(seconds_of(fewer, "patches"), 1.0);
  EXPECT_DOUBLE_EQ(seconds_of(fewer, "balance"), 3.0);
}

TEST(CostLaws, ASmallRunOfTheWholeIsTheWhole) {
  const radiosity::SolveReport small = small_solve();
  const radiosity::SolveReport same = scaled(small, {1000.0, 1.0, 50.0, true});
  EXPECT_EQ(same.patches, small.patches);
  EXPECT_EQ(same.form_factor_rays, small.form_factor_rays);
  EXPECT_EQ(same.refinement_rays, small.refinement_rays);
  EXPECT_EQ(same.shadow_rays, small.shadow_rays);
  EXPECT_EQ(same.nonzeros, small.nonzeros);
  EXPECT_EQ(same.seconds, small.seconds);
}

// error = 0.2 (patches / 100)^-p: at p = 1/2, from 0.1 at 400 patches to 0.02 takes 25 times as
// many patches. Exponents are limited to 1/4 .. 1.
TEST(CostLaws, PatchesFollowTheFallOfTheError) {
  const auto rounds = [](double power) {
    return std::vector<radiosity::RefineRound>{{100, 0.2}, {400, 0.2 * std::pow(4.0, -power)}};
  };
  EXPECT_NEAR(expected_patches(rounds(0.5), 0.02, 1e9), 10000.0, 1e-6);
  EXPECT_NEAR(expected_patches(rounds(0.5), 0.02, 5000.0), 5000.0, 1e-9);
  EXPECT_NEAR(expected_patches(rounds(1.0), 0.025, 1e9), 800.0, 1e-6);
  EXPECT_NEAR(expected_patches(rounds(3.0), 0.2 / 128, 1e9), 800.0, 1e-6);
  EXPECT_NEAR(expected_patches(rounds(0.0), 0.1, 1e9), 400.0 * 16, 1e-6);
  EXPECT_NEAR(expected_patches({{100, 0.2}, {100, 0.1}}, 0.05, 1e9), 1600.0, 1e-6);
  EXPECT_EQ(expected_patches(rounds(0.5), 0.1, 1e9), 400.0);  // already reached
  EXPECT_EQ(expected_patches({{100, 0.2}}, 0.02, 777.0), 777.0);
  EXPECT_EQ(expected_patches({}, 0.02, 777.0), 777.0);
}

// After 24 rounds, each with a tenth more patches than the last and hardly less error, one of 25
// remains: a tenth more. The largest growth of the last four rounds counts, not earlier ones.
TEST(CostLaws, PatchesGrowNoFasterThanTheRoundsThatAreLeft) {
  std::vector<radiosity::RefineRound> rounds = {{100, 0.2}, {400, 0.2}};
  while (rounds.size() < 24) rounds.push_back({rounds.back().patches * 11 / 10, 0.19});
  const auto last = double(rounds.back().patches);
  EXPECT_NEAR(expected_patches(rounds, 0.02, 1e9), 1.1 * last, 0.001 * last);
  rounds.back().patches = rounds[22].patches;  // limited by a budget
  EXPECT_NEAR(expected_patches(rounds, 0.02, 1e9), last, 0.001 * last);
  rounds.push_back(rounds.back());  // no round remains
  EXPECT_EQ(expected_patches(rounds, 0.02, 1e9), double(rounds.back().patches));
}

raytrace::RenderReport small_picture() {
  raytrace::RenderReport report;
  report.rays.camera = 1000;
  report.rays.gather = 16000;
  report.rays.lobe = 30;
  report.rays.mirror = 40;
  report.rays.refraction = 50;
  report.rays.layers = 60;
  report.rays.planning = 70;
  report.rays.add_shadow(LightKind::Sun, 500);
  report.rays.add_shadow(LightKind::MeasuredLamp, 300);
  report.seconds = 3.0;
  report.gather_seconds = 2.0;
  report.camera_samples = 8.0;
  return report;
}

TEST(CostLaws, APictureGrowsWithItsPixels) {
  const raytrace::RenderReport whole = scaled(small_picture(), {100.0, 1600.0, 0.0});
  EXPECT_EQ(whole.rays.camera, 16000U);
  EXPECT_EQ(whole.rays.gather, 256000U);
  EXPECT_EQ(whole.rays.lobe, 480U);
  EXPECT_EQ(whole.rays.mirror, 640U);
  EXPECT_EQ(whole.rays.refraction, 800U);
  EXPECT_EQ(whole.rays.layers, 960U);
  EXPECT_EQ(whole.rays.planning, 70U);  // the witness has as many rays as in the small picture
  EXPECT_EQ(whole.rays.shadow, 12800U);
  EXPECT_EQ(whole.rays.to_light[at(LightKind::Sun)], 8000U);
  EXPECT_EQ(whole.rays.to_light[at(LightKind::MeasuredLamp)], 4800U);
  EXPECT_DOUBLE_EQ(whole.seconds, 48.0);
  EXPECT_DOUBLE_EQ(whole.gather_seconds, 32.0);
  EXPECT_DOUBLE_EQ(whole.camera_samples, 8.0);
}

// A pixel's cost is 10 + 320 / sqrt(pixels): 20 in 1024 pixels, 15 in 4096, 11.25 in 65 536.
// Seconds likewise, separately for gathering and the rest; equal costs in both pictures stay equal.
TEST(CostLaws, APixelCostsLessWhereFewerAreOnEdges) {
  SmallPicture coarse{small_picture(), 1024.0}, fine{small_picture(), 4096.0};
  coarse.report.rays.gather = 20 * 1024, fine.report.rays.gather = 15 * 4096;
  coarse.report.rays.camera = 3 * 1024, fine.report.rays.camera = 3 * 4096;
  coarse.report.gather_seconds = 20 * 1024, fine.report.gather_seconds = 15 * 4096;
  coarse.report.seconds = 22 * 1024, fine.report.seconds = 17 * 4096;
  const raytrace::RenderReport report = as_part_of(65536.0, coarse, fine);
  EXPECT_EQ(report.rays.gather, 46080U);  // 11.25 * 4096
  EXPECT_EQ(report.rays.camera, 12288U);
  EXPECT_NEAR(report.gather_seconds, 11.25 * 4096, 1e-6);
  EXPECT_NEAR(report.seconds, 13.25 * 4096, 1e-6);
  // For any noise, the cost is at least a third of the finer picture's, and at most equal to it.
  coarse.report.rays.gather = 1000 * 1024;
  EXPECT_EQ(as_part_of(65536.0, coarse, fine).rays.gather, 20480U);
  coarse.report.rays.gather = 1024;
  EXPECT_EQ(as_part_of(65536.0, coarse, fine).rays.gather, 61440U);
}

TEST(CostLaws, PathsGrowWithPixelsAndPaths) {
  const raytrace::RenderReport whole = scaled(small_picture(), {100.0, 200.0, 256.0});
  EXPECT_EQ(whole.rays.camera, 64U * 1000U);
  EXPECT_EQ(whole.rays.gather, 64U * 16000U);
  EXPECT_DOUBLE_EQ(whole.seconds, 64 * 3.0);
  EXPECT_DOUBLE_EQ(whole.camera_samples, 256.0);
}

std::map<std::string, EffectCost> by_name(const std::vector<EffectCost>& costs) {
  std::map<std::string, EffectCost> named;
  for (const EffectCost& cost : costs) {
    EXPECT_TRUE(named.emplace(cost.effect, cost).second) << cost.effect << " is there twice";
  }
  return named;
}

Bill bill_of_two() {
  Bill bill;
  bill.solve = small_solve();
  bill.pictures = {small_picture(), small_picture()};
  bill.pictures[1].rays.add_shadow(LightKind::Earth, 77);
  bill.pictures[1].rays.add_shadow(LightKind::SpotLamp, 11);
  return bill;
}

// A growth estimated from the whole picture has priority over its error alone. With few samples the
// error looks larger than it is, so that time grows as the error, not as its square.
TEST(CostLaws, ACutPictureGrowsAsItsErrorUnlessItKnowsMore) {
  raytrace::RenderReport report;
  report.relative_noise = 0.4;
  const double eight_times = samples_growth(report, 0.05);
  report.relative_noise = 0.2;
  EXPECT_NEAR(eight_times / samples_growth(report, 0.05), std::pow(2.0, 1.05), 1e-9);
  report.growth = 3.0;
  EXPECT_EQ(samples_growth(report, 0.05), 3.0);
  report.growth = 0.0;
  report.relative_noise = 0.05;
  EXPECT_EQ(samples_growth(report, 0.05), 1.0);
}

// It ends by the clock; ranks that ended at different times would wait for each other forever.
TEST(Pilot, RanksDoItWithoutAWord) {
  tests::SceneBuilder builder;
  const std::uint32_t wall = builder.material(tests::grey(0.5, 1.0));
  builder.room({wall, wall, wall, wall, wall, wall});
  const tests::Prepared prepared(builder.scene);
  scenes::Camera camera;
  camera.position = Vec3(0.2);
  camera.look_at = Vec3(0.8);
  raytrace::RenderOptions picture;
  picture.columns = picture.rows = 64;
  test::Silent silent(0, 2);
  const base::RanksInForce in_force(&silent);
  const Pilot pilot = expect_costs({prepared, {}}, {&camera}, {picture});
  EXPECT_GT(pilot.bill.pictures.at(0).rays.total(), 0U);
}

// Every counter of solve and pictures is in one row, once: the rows add up to the sum by hand.
// Seconds likewise, except for direct light without a source (none here: 1.5 + 3.5 = 5).
TEST(Bill, TheSharesAddUpToTheWhole) {
  for (const bool between : {true, false}) {
    for (const bool apart : {true, false}) {
      scenes::Effects effects;
      effects.interreflection = between;
      Bill bill = bill_of_two();
      for (auto& picture : bill.pictures) {
        if (!apart) picture.gather_seconds = 0.0;  // as for path tracing
      }
      double rays = 64000.0 + 10000.0 + 12000.0, rows = 0.0, seconds = 0.0;
      for (const auto& picture : bill.pictures) {
        const raytrace::RayCounts& r = picture.rays;
        rays += double(r.camera + r.gather + r.lobe + r.mirror + r.refraction + r.layers +
                       r.planning + r.shadow);
      }
      for (const EffectCost& cost : effect_costs(bill, effects)) {
        rows += cost.rays;
        seconds += cost.seconds;
        EXPECT_GE(cost.seconds, 0.0);
      }
      EXPECT_DOUBLE_EQ(rows, rays);
      EXPECT_DOUBLE_EQ(total_seconds(bill), 29.0 + 6.0);
      EXPECT_NEAR(seconds, total_seconds(bill), 1e-9);
    }
  }
}

TEST(Bill, EachKindOfRayGoesToItsEffect) {
  scenes::Effects effects;
  effects.interreflection = true;
  const auto costs = by_name(effect_costs(bill_of_two(), effects));
  const std::map<std::string, double> rays = {{"interreflection", 74000.0 + 32000.0},
                                              {"sun", 8000.0 + 1000.0},
                                              {"earth", 77.0},
                                              {"point lamps", 0.0},
                                              {"spot lamps", 11.0},
                                              {"rectangle lamps", 0.0},
                                              {"disk lamps", 0.0},
                                              {"measured lamps", 600.0},
                                              {"distant lamps", 0.0},
                                              {"emitting surfaces", 4000.0},
                                              {"glossy reflection", 60.0},
                                              {"mirror", 80.0},
                                              {"refraction", 100.0},
                                              {"layers", 120.0},
                                              {"camera rays", 2000.0 + 140.0}};
  EXPECT_EQ(costs.size(), rays.size());
  for (const auto& [effect, count] : rays) {
    ASSERT_TRUE(costs.count(effect) == 1) << effect;
    EXPECT_DOUBLE_EQ(costs.at(effect).rays, count) << effect;
  }
  // The stages except direct light, and both gathers.
  EXPECT_NEAR(costs.at("interreflection").seconds, 1 + 2 + 3 + 7 + 11 + 2 * 2.0, 1e-9);
}

// Without interreflection the hemisphere is searched for the Earth only.
TEST(Bill, WithoutInterreflectionTheGatherIsTheEarths) {
  Bill bill;
  bill.pictures = {small_picture()};
  const auto costs = by_name(effect_costs(bill, {}));
  EXPECT_DOUBLE_EQ(costs.at("earth").rays, 16000.0);
  EXPECT_DOUBLE_EQ(costs.at("earth").seconds, 2.0);
  EXPECT_DOUBLE_EQ(costs.at("interreflection").rays, 0.0);
  EXPECT_DOUBLE_EQ(costs.at("interreflection").seconds, 0.0);
}

}  // namespace
}  // namespace earthshine::studies
