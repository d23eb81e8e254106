// SPDX-License-Identifier: Apache-2.0
// The error that scenes/effects/culling states without interreflection, against solved scenes:
//   B - B0 = sum over k >= 1 of (rho F)^k B0, and |F| <= 1 in the area-weighted square mean, since
//   rows of F sum to at most 1, and so do area-weighted columns (Schur's test). Hence |B - B0| <=
//   (r + r^2 + ...) |B0| = r / (1 - r) |B0|.
#include <gtest/gtest.h>

#include <cmath>

#include "base/numbers/random.h"
#include "scenes/effects/culling.h"
#include "tests/support/boxes.h"

namespace earthshine::radiosity {
namespace {

// A room with up to eight boxes, one per octant; walls and boxes have different reflectances. Two
// point lamps in separate groups.
scenes::Scene random_room(std::uint64_t number, double most) {
  base::Rng random(base::Key(number, base::Stream::Test, 1));
  tests::SceneBuilder builder;
  const auto material = [&] {
    scenes::Material made = tests::grey(0.0);
    made.diffuse = most * Rgb(random.next(), random.next(), random.next());
    return builder.material(made);
  };
  std::array<std::uint32_t, 6> walls{};
  for (std::uint32_t& wall : walls) wall = material();
  builder.scene.materials[walls[number % 6]].diffuse[int(number % 3)] = most;
  builder.room(walls);
  for (int octant = 0; octant < 8; ++octant) {
    if (random.next() < 0.5) continue;
    const Vec3 corner = 0.5 * Vec3(octant & 1, (octant >> 1) & 1, (octant >> 2) & 1);
    const Vec3 low = corner + 0.1 + 0.1 * random.next();
    tests::add_box(builder, material(), low, low + 0.05 + 0.1 * random.next());
  }
  for (const char* name : {"a", "b"}) {
    scenes::Lamp lamp;
    lamp.name = lamp.group = name;
    lamp.position = Vec3(0.5) + 0.03 * Vec3(random.next(), random.next(), random.next());
    lamp.intensity_cd = Rgb(100.0);
    builder.scene.lamps.push_back(lamp);
  }
  return builder.scene;
}

TEST(CullingBound, NoSolvedSceneExceedsIt) {
  double tightest = 0.0;
  for (std::uint64_t number = 0; number < 24; ++number) {
    const double most = std::pow(10.0, -4.0 + 3.98 * double(number) / 23.0);  // 1e-4 .. 0.95
    const scenes::Scene scene = random_room(number, most);
    const tests::Prepared prepared(scene);
    // An error so large that only the bound decides.
    scenes::LightGroups groups = prepared.groups;
    scenes::Effects effects = prepared.effects;
    const auto culled = scenes::cull_effects(scene, {}, 1e9, {}, groups, effects);
    ASSERT_EQ(culled.size(), 1U);
    ASSERT_EQ(culled[0].effect, "interreflection");

    SolveOptions options;
    options.patch_edge_m = 0.25;
    options.form_factor_rays = 256;
    const Solution solution = prepared.solve(options);
    ASSERT_TRUE(solution.report.balance.balanced);
    for (std::size_t column = 0; column < solution.columns; ++column) {
      double left_out = 0.0, straight = 0.0;
      for (std::uint32_t i = 0; i < solution.patches.count(); ++i) {
        const std::size_t at = i * solution.columns + column;
        const double rho = scene.materials[solution.patches.material(i)].diffuse[int(column % 3)];
        const double b0 = rho * double(solution.direct_lx[at]);
        const double more = rho * double(solution.indirect_lx[at]);
        left_out += solution.patches.area_m2[i] * more * more;
        straight += solution.patches.area_m2[i] * b0 * b0;
      }
      const double error = std::sqrt(left_out / straight);
      EXPECT_LE(error, culled[0].error * (1.0 + 1e-5)) << number << " column " << column;
      tightest = std::max(tightest, error / culled[0].error);
    }
  }
  // The bound is tight: some scene nearly reaches it.
  EXPECT_GT(tightest, 0.3);
}

// A closed room with one reflectance and uniform light is the worst case: B = B0 / (1 - r). With
// walls lit non-uniformly by a lamp in the middle it still reaches nine tenths of the bound.
TEST(CullingBound, AClosedRoomOfOneReflectanceComesNearIt) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.2));
  builder.room({m, m, m, m, m, m});
  scenes::Lamp lamp;
  lamp.name = lamp.group = "lamp";
  lamp.position = Vec3(0.5);
  lamp.intensity_cd = Rgb(100.0);
  builder.scene.lamps = {lamp};
  SolveOptions options;
  options.patch_edge_m = 0.125;
  const Solution solution = tests::Prepared(builder.scene).solve(options);
  double left_out = 0.0, straight = 0.0;
  for (std::size_t i = 0; i < solution.patches.count(); ++i) {
    const double b0 = 0.2 * double(solution.direct_lx[i * 3]);
    const double more = 0.2 * double(solution.indirect_lx[i * 3]);
    left_out += more * more;
    straight += b0 * b0;
  }
  const double error = std::sqrt(left_out / straight);
  EXPECT_LE(error, 0.25);
  EXPECT_GE(error, 0.9 * 0.25);
}

}  // namespace
}  // namespace earthshine::radiosity
