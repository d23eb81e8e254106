// SPDX-License-Identifier: Apache-2.0
#include "studies/why/last_bounce.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/studies/plates.h"

namespace earthshine::studies {
namespace {

double share_from(const std::vector<LightShare>& shares, const std::string& from, bool reflected) {
  const auto found = std::find_if(shares.begin(), shares.end(), [&](const LightShare& s) {
    return s.from == from && s.reflected == reflected;
  });
  return found == shares.end() ? 0.0 : found->share;
}

// A unit cube whose walls all emit M and reflect rho = 0.5: B = M / (1 - rho) everywhere. Of this,
// M is a point's own light, rho M is light straight from the walls, and rho (B - M) is reflected by
// them. From the centre of the floor the ceiling has F = 4 / (2 pi) 2 x / sqrt(1 + x^2)
// atan(x / sqrt(1 + x^2)), x = 1/2: 0.2394, and each of the other walls a quarter of the rest.
TEST(LastBounce, InAFurnaceSharesAreFormFactors) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5, 1.0));
  builder.room({m, m, m, m, m, m});
  const tests::Prepared prepared(builder.scene);
  radiosity::SolveOptions solver;
  solver.patch_edge_m = 0.25;
  const radiosity::Solution solution = prepared.solve(solver);
  SeenPoint point;
  point.position = Vec3(0.5, 0.5, 0.0);
  point.normal = Vec3(0, 0, 1);
  point.offset_m = prepared.query.offset_m(8);
  point.diffuse = Rgb(0.5);
  point.reflectance = 0.5;
  point.emitted = Rgb(1.0 / base::pi);
  constexpr int rays = 16384;
  const std::vector<LightShare> shares =
      light_shares(prepared, solution, {&point, 1}, 2.0 / base::pi, rays);
  EXPECT_NEAR(share_from(shares, own_light, false), 0.5, 1e-9);
  EXPECT_NEAR(share_from(shares, prepared.groups.names[prepared.groups.material[m]], false), 0.25,
              1e-3);
  const double x = 0.5, h = std::sqrt(1.0 + x * x);
  const double ceiling = 4.0 / (2.0 * base::pi) * 2.0 * x / h * std::atan(x / h);
  // A share p from `rays` independent rays has the standard error sqrt(p (1 - p) / rays); an even
  // sequence has less. Times the reflected quarter.
  const auto within = [](double p) { return 0.25 * 4.0 * std::sqrt(p * (1.0 - p) / rays); };
  EXPECT_NEAR(share_from(shares, "quad-5", true), 0.25 * ceiling, within(ceiling));
  for (const char* wall : {"quad-0", "quad-1", "quad-2", "quad-3"}) {
    const double p = (1.0 - ceiling) / 4.0;
    EXPECT_NEAR(share_from(shares, wall, true), 0.25 * p, within(p)) << wall;
  }
  double sum = 0.0;
  for (const LightShare& share : shares) sum += share.share;
  EXPECT_NEAR(sum, 1.0, 1e-3);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end(),
                             [](const auto& a, const auto& b) { return a.share > b.share; }));
}

// Under the Sun on black ground there is only sunlight.
TEST(LastBounce, WithNothingRoundItLightComesStraight) {
  auto builder = tests::plate_on_ground(0.0, 0.6);
  builder.scene.sun = tests::overhead_sun(1000.0);
  const tests::Prepared prepared(builder.scene);
  const scenes::Camera camera = tests::above(2.0, 2.0);
  const std::uint32_t pixel = 16 * 32 + 16;
  const auto points = seen_points(builder.scene, prepared.query, camera, 32, 32, {&pixel, 1}, 1);
  const auto shares = light_shares(prepared, {}, points, 0.6 * 1000.0 / base::pi, 256);
  ASSERT_EQ(shares.size(), 1U);
  EXPECT_EQ(shares[0].from, "sun");
  EXPECT_FALSE(shares[0].reflected);
  EXPECT_NEAR(shares[0].share, 1.0, 1e-9);
}

}  // namespace
}  // namespace earthshine::studies
