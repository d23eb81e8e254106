// SPDX-License-Identifier: Apache-2.0
#include "raytrace/solve_control/reach_surfaces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "radiosity/near_lamps.h"
#include "tests/studies/room.h"

namespace earthshine::raytrace {
namespace {

SteeredSolution reached(const scenes::Scene& scene, double error, std::uint64_t seed = 1) {
  const tests::Prepared prepared(scene);
  Wanted wanted;
  wanted.error = error;
  return reach_surfaces(prepared, wanted, seed, {});
}

// An error that falls as the fourth root of the rays is halved by 16 times as many rays, even if
// the last stated errors deviate by chance: here the last one by +10 %, the previous one by -10 %.
// A constant error is far off; a large error that falls fast is not.
TEST(ReachSolution, ASinglePassDoesNotTellHowFarTheEndIs) {
  std::vector<PassError> passes;
  for (const double rays : {1.0, 2.0, 4.0, 8.0, 16.0, 32.0}) {
    passes.push_back({rays, 0.2 / std::sqrt(std::sqrt(rays))});
  }
  const double now = passes.back().error;
  EXPECT_FALSE(is_far_off(passes, 0.51 * now));
  EXPECT_TRUE(is_far_off(passes, 0.49 * now));
  passes.back().error *= 1.1, passes[4].error *= 0.9;
  EXPECT_FALSE(is_far_off(passes, 0.7 * now));
  EXPECT_TRUE(is_far_off({{1.0, 0.1}, {4.0, 0.1}, {8.0, 0.1}}, 0.05));
  EXPECT_FALSE(is_far_off({{8.0, 0.1}}, 0.05));
  EXPECT_FALSE(is_far_off({{7.9, 0.1}, {8.0, 0.1005}}, 0.05));
}

// A solution within the error has no limit, however little the last solve improved it; any other
// has one.
TEST(ReachSolution, OfSurfacesALimitIsNamedWhereTheErrorIsNotReachedAndThereAlone) {
  scenes::Scene held = tests::small_room().scene;
  held.quality.max_patches = 60;
  int reached_it = 0, missed_it = 0;
  for (const double error : {0.2, 0.15, 0.1, 0.07, 0.03}) {
    for (const scenes::Scene* scene : {&std::as_const(held), &tests::small_room().scene}) {
      if (error < 0.05 && scene != &held) continue;  // slow
      const SteeredSolution solution = reached(*scene, error);
      const bool enough = solution.surface.parts.total().estimate <= error;
      EXPECT_EQ(solution.limit == Limit::None, enough) << error;
      (enough ? reached_it : missed_it) += 1;
    }
  }
  EXPECT_GT(reached_it, 2);
  EXPECT_GT(missed_it, 0);
}

// The Sun shines through a hole of 10 cm onto the floor of a room of 80 m2: the sixteen points of a
// patch usually miss the spot. The solution must not be black for any seed.
TEST(ReachSolution, OfSurfacesASpotOfSunlightIsFound) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.6));
  builder.quad(m, {0, 0, 0}, {0, 4, 0}, {0, 4, 3}, {0, 0, 3});
  builder.quad(m, {4, 0, 0}, {4, 0, 3}, {4, 4, 3}, {4, 4, 0});
  builder.quad(m, {0, 0, 0}, {0, 0, 3}, {4, 0, 3}, {4, 0, 0});
  builder.quad(m, {0, 4, 0}, {4, 4, 0}, {4, 4, 3}, {0, 4, 3});
  builder.quad(m, {0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0});
  const auto ceiling = [&](double x0, double y0, double x1, double y1) {
    builder.quad(m, {x0, y0, 3}, {x0, y1, 3}, {x1, y1, 3}, {x1, y0, 3});
  };
  ceiling(0, 0, 3, 4);
  ceiling(3.1, 0, 4, 4);
  ceiling(3, 0, 3.1, 3);
  ceiling(3, 3.1, 3.1, 4);
  builder.scene.sun = scenes::Sun();
  builder.scene.sun->direction = Vec3(0, 0, 1);
  builder.scene.sun->illuminance_lx = Rgb(1e5);
  builder.scene.quality.form_factor_rays = 64;  // the test is about light, not form factors
  builder.scene.quality.refine = false;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const SteeredSolution found = reached(builder.scene, 0.5, seed);
    EXPECT_TRUE(found.surface.known) << seed;
    const std::vector<float>& b = found.solution.radiosity;
    EXPECT_GT(std::accumulate(b.begin(), b.end(), 0.0), 0.0) << seed;
  }
}

enum class Pane { None, Glass, Mirror };

// A bare lamp on the floor of a closed room, treated as 0.1 mm above it, and a pane across the room
// 5 cm above the lamp.
scenes::Scene lamp_on_the_floor(Pane kind) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.room({m, m, m, m, m, m});
  scenes::Material pane = tests::grey(0.0);
  pane.two_sided = true;
  (kind == Pane::Glass ? pane.transmit : pane.mirror) = Rgb(1.0);
  if (kind != Pane::None) {
    builder.quad(builder.material(pane), {0, 0, .05}, {1, 0, .05}, {1, 1, .05}, {0, 1, .05});
  }
  scenes::Lamp lamp;
  lamp.name = lamp.group = "lamp";
  lamp.kind = scenes::LampKind::Point;
  lamp.position = Vec3(0.4, 0.6, 0.0001);
  lamp.intensity_cd = Rgb(100.0);
  builder.scene.lamps.push_back(lamp);
  return builder.scene;
}

// Half of its light lands on a spot so small that cosine-distributed rays miss it; rays aimed at
// bright patches find it. For a lamp of flux Phi, the walls send rho Phi / (1 - rho) in all.
TEST(ReachSolution, OfALampOnTheFloorAllLightIsFoundThroughASheetOfGlassToo) {
  for (const Pane pane : {Pane::None, Pane::Glass}) {
    const SteeredSolution found = reached(lamp_on_the_floor(pane), 0.1);
    EXPECT_EQ(found.limit, Limit::None);
    EXPECT_LT(found.solution.report.groups.front().imbalance, 1e-9);
    double sum = 0.0;
    for (std::uint32_t i = 0; i < found.solution.patches.count(); ++i) {
      sum += found.solution.patches.area_m2[i] * double(found.solution.radiosity[3 * i]);
    }
    EXPECT_NEAR(sum, 400.0 * base::pi * 0.5 / (1.0 - 0.5),
                found.surface.parts.total().bound_95 * sum);
  }
}

// A lamp emits its flux, whatever its samples found, and in a closed room all of it lands: 4 pi I,
// or for a spot lamp of half a degree I 2 pi (1 - (cos(beam / 2) + cos(field / 2)) / 2). The walls
// send rho Phi / (1 - rho) in all.
TEST(ReachSolution, OfSurfacesALampInAClosedRoomGivesAndLandsItsFlux) {
  for (const double field_deg : {360.0, 5.0, 0.5}) {
    scenes::Scene scene = lamp_on_the_floor(Pane::None);
    scenes::Lamp& lamp = scene.lamps.front();
    lamp.position = Vec3(0.4, 0.6, 0.9);
    if (field_deg < 360.0) {
      lamp.kind = scenes::LampKind::Spot;
      lamp.axis = glm::normalize(Vec3(0.1, -0.2, -0.9));
      lamp.beam_deg = 0.5 * field_deg;
      lamp.field_deg = field_deg;
    }
    const double flux = scenes::lamp_flux_lm(lamp).g;
    const SteeredSolution found = reached(scene, 0.05);
    const radiosity::GroupLedger& line = found.solution.report.groups.front();
    EXPECT_NEAR(line.given_lm.g / flux, 1.0, 1e-9) << field_deg;
    EXPECT_NEAR(line.landed_lm.g / flux, 1.0, 1e-9) << field_deg;
    EXPECT_NEAR(found.solution.report.sources.front().landed_lm.g / flux, 1.0, 1e-9) << field_deg;
    EXPECT_LT(line.imbalance, 1e-9) << field_deg;
    double sum = 0.0;
    for (std::uint32_t i = 0; i < found.solution.patches.count(); ++i) {
      sum += found.solution.patches.area_m2[i] * double(found.solution.radiosity[3 * i]);
    }
    EXPECT_NEAR(sum / (flux * 0.5 / (1.0 - 0.5)), 1.0, 1e-5) << field_deg;
  }
}

// Aimed rays do not follow mirrors, the only connection between parts of this floor. A closed room
// must conserve energy: the ledger's defect is the least error of the solution.
TEST(ReachSolution, OfSurfacesTheErrorIsNoLessThanWhatTheLedgerLacks) {
  const SteeredSolution found = reached(lamp_on_the_floor(Pane::Mirror), 0.1);
  const radiosity::GroupLedger& all = found.solution.report.groups.front();
  ASSERT_GT(all.imbalance, 0.1);
  EXPECT_GE(found.surface.parts.total().estimate, all.imbalance * (1.0 - 1e-9));
  EXPECT_EQ(found.limit, Limit::Ledger);
}

// Finds the largest number that fits within 1/64, from below, and its cause.
TEST(PatchBound, IsTheLeastOfWhatIsAllowedAndNamesIt) {
  scenes::Quality given;
  Wanted wanted;
  const auto bound = [&] { return patch_bound(wanted, given, 1000, 1 << 20); };
  EXPECT_EQ(bound().most, std::size_t{1} << 20);
  EXPECT_EQ(bound().of, Limit::Steps);
  wanted.fits = [](double patches, int) { return patches <= 70000; };
  EXPECT_LE(bound().most, 70000U);
  EXPECT_GE(bound().most, 70000U - 70000U / 64 - 1);
  EXPECT_EQ(bound().of, Limit::Memory);
  given.max_patches = 5000;
  EXPECT_EQ(bound().most, 5000U);
  EXPECT_EQ(bound().of, Limit::Settings);
  wanted.fits = [](double, int) { return false; };
  EXPECT_EQ(bound().most, 1000U);  // the first patches always remain
}

// Memory is not named as the limit if the solve ends below the number that fits, even if memory
// does not hold the largest number. It is named if memory holds no more than the first patches.
TEST(ReachSolution, OfSurfacesMemoryIsNamedWhereItIsWhatCameFirst) {
  const tests::Prepared prepared(tests::small_room().scene);
  for (const bool tight : {false, true}) {
    Wanted wanted;
    wanted.error = 0.02;
    wanted.fits = [&](double patches, int) { return patches < (tight ? 200.0 : 1e6); };
    std::size_t first = 0;
    const SteeredSolution found =
        reach_surfaces(prepared, wanted, 1, [&](const auto& report) { first = report.patches; });
    EXPECT_EQ(found.limit, tight ? Limit::Memory : Limit::None);
    if (tight) {
      EXPECT_EQ(found.solution.patches.count(), first);
    }
  }
}

// A stop at the first or any later query keeps the results so far: complete light, and at the first
// query the patches of the first solve.
TEST(ReachSolution, OfSurfacesAStopKeepsWhatThereIs) {
  const tests::Prepared prepared(tests::small_room().scene);
  std::size_t first = 0, most = 0;
  for (const int asks : {0, 30, 150}) {
    std::atomic<int> asked{0};
    Wanted wanted;
    wanted.error = 0.003;
    wanted.stop = [&] { return asked++ >= asks; };
    const SteeredSolution found =
        reach_surfaces(prepared, wanted, 1, [&](const auto& report) { first = report.patches; });
    EXPECT_EQ(found.limit, Limit::Stopped) << asks;
    EXPECT_EQ(found.surface.known, !found.steps.empty()) << asks;
    EXPECT_EQ(found.solution.radiosity.size(),
              found.solution.patches.count() * found.solution.columns);
    for (const radiosity::GroupLedger& group : found.solution.report.groups) {
      EXPECT_LT(group.imbalance, 1e-12) << asks;
    }
    if (asks == 0) {
      EXPECT_EQ(found.solution.patches.count(), first);
    }
    most = std::max(most, found.solution.patches.count());
  }
  EXPECT_GT(most, first);
}

// With a clock that advances by `pass_s` in each pass over all patches and not otherwise; a limit
// of 0 is exceeded from the start.
SteeredSolution within(double limit_s, double pass_s) {
  const tests::Prepared prepared(tests::small_room().scene);
  double now = limit_s > 0.0 ? 0.0 : 1.0;
  Wanted wanted;
  wanted.error = 0.001;
  wanted.seconds = std::max(limit_s, 1e-9);
  wanted.now = [&now] { return now; };
  const auto stage = [&](const std::string& name) -> Progress {
    const bool whole = name.find(" patches") != std::string::npos && !name.starts_with("shadows") &&
                       !name.starts_with("uneven");
    return [&now, step = whole ? pass_s : 0.0](std::size_t done, std::size_t) {
      if (done > 0 && done % parts_of_a_pass == 0) now += step;
    };
  };
  return reach_surfaces(prepared, wanted, 1, {}, stage);
}

// Without remaining time, the error of the first solve is stated and nothing else begins: one step,
// with the first patches.
TEST(ReachSolution, OfSurfacesPastTheTimeLimitIsTheFirstSolveWithItsError) {
  const SteeredSolution late = within(0.0, 0.0);
  EXPECT_EQ(late.limit, Limit::Time);
  ASSERT_EQ(late.steps.size(), 1U);
  EXPECT_TRUE(late.surface.known);
  const scenes::Scene& scene = tests::small_room().scene;
  const radiosity::SolveOptions first = first_surface_options(scene, 0.001, 1);
  EXPECT_EQ(late.steps[0].patches,
            radiosity::subdivide_near_lamps(scene, first.patch_edge_m).count());
}

// A pass of 0.45 of the limit leaves 0.55: the next one may cast 0.55 / 0.45 = 1.2 times its rays,
// times two for rounding up, and 128 more per patch, the minimum. Without a limit it casts 2^20.
TEST(ReachSolution, OfSurfacesNoPassIsBegunThatTheTimeLeftDoesNotPayFor) {
  const SteeredSolution found = within(1.0, 0.45);
  EXPECT_EQ(found.limit, Limit::Time);
  ASSERT_EQ(found.steps.size(), 2U);
  const auto rays = [&](std::size_t k) {
    return static_cast<double>(found.steps[k].patches) * found.steps[k].form_factor_rays;
  };
  EXPECT_LE(rays(1), 2.0 * rays(0) + 128.0 * double(found.steps[1].patches));
}

// Passes of 0.3 of the limit: the second ends at 0.6 and leaves 0.4 for a third of 1.2 x 0.3, which
// ends at 0.9.
TEST(ReachSolution, OfSurfacesTheTimeThatPaysForAnotherPassIsUsed) {
  const SteeredSolution found = within(1.0, 0.3);
  EXPECT_EQ(found.limit, Limit::Time);
  EXPECT_EQ(found.steps.size(), 3U);
}

}  // namespace
}  // namespace earthshine::raytrace
