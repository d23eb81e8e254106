// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>

#include "radiosity/direct/sources.h"
#include "radiosity/solution.h"
#include "tests/support/scene_builder.h"

namespace earthshine::radiosity {
namespace {

// A closed room of 4 x 1 x height m whose six walls emit 1 - rho, each with its own material and
// light group.
tests::SceneBuilder furnace(const std::array<double, 6>& rho, double height_m) {
  tests::SceneBuilder builder;
  std::array<std::uint32_t, 6> m{};
  for (std::size_t k = 0; k < 6; ++k) {
    scenes::Material wall = tests::grey(rho[k], 1.0 - rho[k]);
    wall.name = wall.light_group = "wall-" + std::to_string(k);
    m[k] = builder.material(wall);
  }
  builder.room(m);
  for (Vec3& p : builder.scene.vertices) p = Vec3(4.0 * p.x, p.y, height_m * p.z);
  return builder;
}

// B = M + rho E with M = 1 - rho and E = B everywhere has the solution 1; closed rows preserve it
// for any rays.
void expect_one_everywhere(const scenes::Scene& scene) {
  SolveOptions options;
  options.form_factor_rays = 256;
  const Solution solution = tests::Prepared(scene).solve(options);
  for (const ObjectLight& object : solution.report.objects) {
    EXPECT_NEAR(object.radiosity_lm_m2.g, 1.0, 1e-6) << object.name;
    EXPECT_NEAR(object.illuminance_lx.g, 1.0, 1e-6) << object.name;
  }
}

TEST(ExplicitEmitters, AMixedFurnaceIsExactWhicheverWallsAreSmall) {
  // The walls x = 0 and x = 4 are 1/26 of the surface each.
  std::array<double, 6> rho = {0.0, 0.2, 0.5, 0.8, 0.95, 0.9999};
  for (int turn = 0; turn < 6; ++turn) {
    expect_one_everywhere(furnace(rho, 0.5).scene);
    std::rotate(rho.begin(), rho.begin() + 1, rho.end());
  }
}

TEST(ExplicitEmitters, ASmallBlackWallOfAWhiteFurnaceDoesNotStandOut) {
  // 0.6 % of the surface emits 1, the rest a ten-thousandth of that, 60 times less than the overall
  // mean: the white walls reflect as much light as the black one emits.
  expect_one_everywhere(furnace({0.0, 0.9999, 0.9999, 0.9999, 0.9999, 0.9999}, 0.05).scene);
}

TEST(ExplicitEmitters, ASmallBrightEmitterAmongDimOnesIsSampled) {
  tests::SceneBuilder builder = furnace({0.5, 0.5, 0.5, 0.5, 0.5, 0.5}, 0.5);
  const std::uint32_t lamp = builder.material(tests::grey(0.0, 100.0));
  builder.quad(lamp, {1.9, 0.4, 0.49}, {1.9, 0.6, 0.49}, {2.1, 0.6, 0.49}, {2.1, 0.4, 0.49});
  const std::vector<bool> is_explicit = emitter_is_explicit(builder.scene);
  EXPECT_TRUE(is_explicit[lamp]);
  for (std::uint32_t m = 0; m < lamp; ++m) EXPECT_FALSE(is_explicit[m]);
}

TEST(ExplicitEmitters, ManySmallBrightEmittersAreAllSampled) {
  // Eight panels of 1 % each: together they are wide, but few rays of a row hit one of them.
  tests::SceneBuilder builder;
  const std::uint32_t wall = builder.material(tests::grey(0.5));
  builder.room({wall, wall, wall, wall, wall, wall});
  for (int k = 0; k < 8; ++k) {
    scenes::Material panel = tests::grey(0.0, 100.0);
    panel.light_group = "panel-" + std::to_string(k);
    const double x = 0.05 + 0.11 * k;
    builder.quad(builder.material(panel), {x, 0.2, 0.99}, {x, 0.8, 0.99}, {x + 0.1, 0.8, 0.99},
                 {x + 0.1, 0.2, 0.99});
  }
  const std::vector<bool> is_explicit = emitter_is_explicit(builder.scene);
  for (std::uint32_t m = 1; m < is_explicit.size(); ++m) EXPECT_TRUE(is_explicit[m]);
}

}  // namespace
}  // namespace earthshine::radiosity
