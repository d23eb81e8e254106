// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "radiosity/solution.h"
#include "tests/support/scene_builder.h"

namespace earthshine::radiosity {
namespace {

SolveOptions coarse(double edge_m = 0.25) {
  SolveOptions options;
  options.patch_edge_m = edge_m;
  options.form_factor_rays = 256;
  return options;
}

TEST(Solve, ClosedBoxReachesExitanceOverOneMinusReflectance) {
  // 1 + rho + rho^2 + ... = 1 / (1 - rho), on every patch.
  for (const double rho : {0.0, 0.5, 0.9, 0.99, 0.999999}) {
    tests::SceneBuilder builder;
    const std::uint32_t m = builder.material(tests::grey(rho, 2.0));
    builder.room({m, m, m, m, m, m});
    const Solution solution = tests::Prepared(builder.scene).solve(coarse());
    for (const float b : solution.radiosity) EXPECT_NEAR(b * (1.0 - rho) / 2.0, 1.0, 1e-6) << rho;
  }
}

TEST(Solve, WhiteFurnaceOfMixedReflectancesIsOneEverywhere) {
  // M = 1 - rho_i: B = 1 solves B = M + rho B for any rho_i.
  tests::SceneBuilder builder;
  std::array<std::uint32_t, 6> materials{};
  const double rho[] = {0.1, 0.5, 0.99, 0.999999, 0.0, 0.7};
  for (std::size_t k = 0; k < 6; ++k)
    materials[k] = builder.material(tests::grey(rho[k], 1.0 - rho[k]));
  builder.room(materials);
  // The emission of the face with 0.999999 is small but carried through F like the others'.
  const Solution solution = tests::Prepared(builder.scene).solve(coarse());
  for (const float b : solution.radiosity) EXPECT_NEAR(b, 1.0, 1e-6);
}

TEST(Solve, FurnaceWithAHalfMirrorInItIsStillAFurnace) {
  // The half mirror (rho 0.2, M 0.2) sends 0.2 + 0.2 diffusely and reflects 0.6 of the other light,
  // which is again 1: B is 0.4 on it and 1 on the others.
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.7, 0.3));
  scenes::Material mirror = tests::grey(0.2, 0.2);
  mirror.mirror = Rgb(0.6);
  const std::uint32_t h = builder.material(mirror);
  builder.room({m, m, h, m, m, m});
  const Solution solution = tests::Prepared(builder.scene).solve(coarse());
  for (std::uint32_t i = 0; i < solution.patches.count(); ++i) {
    EXPECT_NEAR(solution.radiosity[3 * i], solution.patches.material(i) == h ? 0.4 : 1.0, 1e-6);
  }
}

TEST(Solve, EnergyInEqualsAbsorbedPlusEscapedPerGroup) {
  tests::SceneBuilder builder;
  const std::uint32_t wall = builder.material(tests::grey(0.8));
  scenes::Material panel = tests::grey(0.3, 50.0);
  const std::uint32_t emitting = builder.material(panel);
  builder.room({wall, wall, emitting, wall, wall, wall});
  builder.scene.triangles.resize(10);  // open top
  builder.scene.objects.pop_back();
  scenes::Lamp lamp;
  lamp.name = "lamp";
  lamp.group = "lamps";
  lamp.position = Vec3(0.5, 0.5, 0.7);
  lamp.intensity_cd = Rgb(10.0);
  builder.scene.lamps.push_back(lamp);
  scenes::Sun sun;
  sun.direction = glm::normalize(Vec3(0.3, 0.1, 0.95));
  builder.scene.sun = sun;
  const Solution solution = tests::Prepared(builder.scene).solve(coarse(0.1));
  ASSERT_EQ(solution.report.groups.size(), 3U);
  for (const GroupLedger& line : solution.report.groups) {
    EXPECT_LE(line.imbalance, 1e-9) << line.name;
    EXPECT_GT(line.escaped_lm.g, 0.0) << line.name;
    EXPECT_NEAR(line.emitted_lm.g + line.landed_lm.g, line.absorbed_lm.g + line.escaped_lm.g,
                1e-9 * (line.emitted_lm.g + line.landed_lm.g));
  }
}

TEST(Solve, LightIsLinearInEachGroup) {
  // Doubling the lamp doubles its column and does not change the other one.
  const auto solve_with = [](double intensity_cd) {
    tests::SceneBuilder builder;
    const std::uint32_t wall = builder.material(tests::grey(0.6));
    builder.room({wall, wall, wall, wall, wall, wall});
    for (int k = 0; k < 2; ++k) {
      scenes::Lamp lamp;
      lamp.name = lamp.group = k == 0 ? "a" : "b";
      lamp.position = Vec3(0.3 + 0.4 * k, 0.5, 0.5);
      lamp.intensity_cd = Rgb(k == 0 ? intensity_cd : 7.0);
      builder.scene.lamps.push_back(lamp);
    }
    return tests::Prepared(builder.scene).solve(coarse());
  };
  const Solution once = solve_with(1.0), twice = solve_with(2.0);
  for (std::size_t i = 0; i < once.radiosity.size() / 6; ++i) {
    EXPECT_NEAR(twice.radiosity[6 * i] / once.radiosity[6 * i], 2.0, 1e-6);
    EXPECT_NEAR(twice.radiosity[6 * i + 3] / once.radiosity[6 * i + 3], 1.0, 1e-6);
  }
}

TEST(Solve, SceneWithoutLightCastsNoRays) {
  tests::SceneBuilder builder;
  const std::uint32_t wall = builder.material(tests::grey(0.6));
  builder.room({wall, wall, wall, wall, wall, wall});
  builder.scene.ambient_radiance = Rgb(5.0);  // no source: it is not reflected
  const Solution solution = tests::Prepared(builder.scene).solve(coarse());
  EXPECT_EQ(solution.report.form_factor_rays, 0U);
  EXPECT_EQ(solution.columns, 0U);
  EXPECT_GT(solution.report.patches, 0U);
}

TEST(Solve, WhereNothingReflectsMoreRaysChangeAndCostNothing) {
  // All light is direct; F B = 0 for any F.
  tests::SceneBuilder builder;
  const std::uint32_t black = builder.material(tests::grey(0.0));
  builder.room({black, black, black, black, black, black});
  scenes::Lamp lamp;
  lamp.name = lamp.group = "lamp";
  lamp.position = Vec3(0.3, 0.5, 0.5);
  lamp.intensity_cd = Rgb(7.0);
  builder.scene.lamps.push_back(lamp);
  const tests::Prepared made(builder.scene);
  SolveOptions options = coarse();
  options.form_factor_rays = 256;
  const Solution few = made.solve(options);
  options.form_factor_rays = 1 << 18;
  const Solution many = made.solve(options);
  EXPECT_EQ(many.report.form_factor_rays, few.report.form_factor_rays);
  EXPECT_EQ(many.direct_lx, few.direct_lx);
  for (const float light : many.indirect_lx) EXPECT_EQ(light, 0.0F);
}

TEST(Solve, CubeWithSixFacesMatchesTheExactSixSurfaceSystem) {
  // Faces z0 z1 x0 x1 y0 y1 of a unit cube in one patch each: values from view-factors.json (exact
  // F in closed form). Rays have a standard error of F of 0.4 / sqrt(N) per entry; with N = 65536
  // and these reflectances the error of B is below 4 x 0.002.
  const double rho[] = {0.5, 0.75, 0.3, 0.6, 0.9, 0.05};
  const double emit[] = {0.0, 1.0, 0.0, 0.0, 0.2, 0.0};
  tests::SceneBuilder builder;
  std::array<std::uint32_t, 6> m{};
  for (std::size_t k = 0; k < 6; ++k) m[k] = builder.material(tests::grey(rho[k], emit[k]));
  builder.room({m[2], m[3], m[4], m[5], m[0], m[1]});
  SolveOptions options = coarse(2.0);
  options.form_factor_rays = 65536;
  const Solution solution = tests::Prepared(builder.scene).solve(options);
  const auto b = [&](std::size_t object) {
    return solution.report.objects[object].radiosity_lm_m2.g;
  };
  EXPECT_NEAR(b(4), 0.20869697974821, 0.008);
  EXPECT_NEAR(b(5), 1.1691096920717, 0.008);
  EXPECT_NEAR(b(1), 0.2460852638112, 0.008);
  EXPECT_NEAR(b(3), 0.022736812093798, 0.008);
}

TEST(Solve, SurfacesWithoutPatchesAreNoSolution) {
  tests::SceneBuilder builder;
  const std::uint32_t glowing = builder.material(tests::grey(0.5, 1.0));
  builder.quad(glowing, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  const tests::Prepared made(builder.scene);
  EXPECT_THROW((void)solve(made, coarse(), Patches{}), base::Error);
}

}  // namespace
}  // namespace earthshine::radiosity
