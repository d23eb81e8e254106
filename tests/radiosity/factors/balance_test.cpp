// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/scene_builder.h"

namespace earthshine::radiosity {
namespace {

// Maximum over j of |sum_i A_i a_i F_ij - A_j (1 - escape_j - lost_j)| / A_j.
double worst_column_defect(const FormFactors& f, const Patches& patches) {
  std::vector<double> sum(f.count(), 0.0);
  for (std::size_t i = 0; i < f.count(); ++i) {
    for (std::uint64_t e = f.row_start[i]; e < f.row_start[i + 1]; ++e) {
      const std::uint32_t j = f.column[e];
      sum[j] +=
          patches.area_m2[i] * f.kept[i] * f.row_scale[i] * double(f.hits[e]) * f.column_scale[j];
    }
  }
  double worst = 0.0;
  for (std::size_t j = 0; j < f.count(); ++j) {
    const double target = patches.area_m2[j] * (1.0 - f.escape[j] - f.lost[j]);
    worst = std::max(worst, std::abs(sum[j] - target) / patches.area_m2[j]);
  }
  return worst;
}

double worst_row_defect(const FormFactors& f) {
  double worst = 0.0;
  for (std::size_t i = 0; i < f.count(); ++i) {
    double sum = f.sky[i] + f.black[i];
    for (std::uint64_t e = f.row_start[i]; e < f.row_start[i + 1]; ++e) {
      const std::uint32_t j = f.column[e];
      sum += f.row_scale[i] * double(f.hits[e]) * f.column_scale[j] * f.kept[j];
    }
    worst = std::max(worst, std::abs(sum - 1.0));
  }
  return worst;
}

void expect_conservation(const scenes::Scene& scene, double edge_m, int rays) {
  const scenes::RayQuery query(scene);
  const Patches patches = subdivide(scene, edge_m);
  FormFactors factors = cast_form_factors(scene, query, patches, {rays, 1});
  EXPECT_GT(worst_column_defect(factors, patches), 1e-3);  // noise before balancing
  const BalanceReport report = balance(factors, patches.area_m2);
  EXPECT_TRUE(report.balanced);
  EXPECT_LE(report.after, 1e-12);
  EXPECT_LE(worst_column_defect(factors, patches), 1e-10);
  EXPECT_LE(worst_row_defect(factors), 1e-14);
}

TEST(Balance, ClosedRoomConservesEnergyAndStaysClosed) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.room({m, m, m, m, m, m});
  expect_conservation(builder.scene, 0.125, 256);
}

TEST(Balance, RoomWithAnOpenTopConservesEnergy) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.room({m, m, m, m, m, m});
  builder.scene.triangles.resize(10);  // no ceiling
  builder.scene.objects.pop_back();
  expect_conservation(builder.scene, 0.125, 256);
}

TEST(Balance, RoomWithAHalfMirrorConservesEnergy) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  scenes::Material half = tests::grey(0.2);
  half.mirror = Rgb(0.6);
  const std::uint32_t h = builder.material(half);
  builder.room({m, m, m, m, m, h});
  expect_conservation(builder.scene, 0.125, 256);
}

TEST(Balance, PatchesThatNoRayReachesBorrowTheTransposedEntries) {
  // A plate a thousandth of the room's size: few of the walls' rays hit it, and its cells see
  // everything.
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.room({m, m, m, m, m, m});
  builder.quad(m, {0.5, 0.5, 0.5}, {0.501, 0.5, 0.5}, {0.501, 0.501, 0.5}, {0.5, 0.501, 0.5});
  const scenes::RayQuery query(builder.scene);
  const Patches patches = subdivide(builder.scene, 0.25);
  FormFactors factors = cast_form_factors(builder.scene, query, patches, {64, 1});
  const BalanceReport report = balance(factors, patches.area_m2);
  EXPECT_EQ(report.borrowed, 1U);
  EXPECT_LE(worst_row_defect(factors), 1e-14);
  EXPECT_LE(worst_column_defect(factors, patches), 1e-8);
}

TEST(Balance, APatchThatOnlyASpecksRaysReachedBorrowsToo) {
  // Patches 0 and 1 see each other, 2 sees both but was hit only by rays of 3, a patch of a
  // billionth of its area: to fill column 2 from that row would need a scale of a billion.
  FormFactors f;
  f.rays_per_patch = 64;
  f.row_start = {0, 1, 2, 4, 5};
  f.column = {1, 0, 0, 1, 2};
  f.hits = {64, 64, 32, 32, 64};
  f.row_scale.assign(4, 1.0 / 64.0);
  f.column_scale.assign(4, 1.0);
  f.kept.assign(4, 1.0);
  for (auto* share : {&f.sky, &f.black, &f.escape, &f.lost}) share->assign(4, 0.0);
  f.sky_illuminance.assign(4, Rgb(0.0));
  const std::vector<double> area = {1.0, 1.0, 1.0, 1e-9};
  const BalanceReport report = balance(f, area);
  EXPECT_EQ(report.borrowed, 2U);  // 2, and the small patch, which no ray hit
  EXPECT_TRUE(report.balanced) << report.after;
  for (const double scale : f.column_scale) EXPECT_LT(scale, 10.0);
}

TEST(Balance, WhatAPatchBorrowsDoesNotDependOnHowManyRaysItSent) {
  // Patches of equal area: 0 and 1 see each other by two thirds and 2 by a third. 2 sees both
  // equally, with 64 times as many rays, but all their rays missed it. A_i F_ij = A_j F_ji gives it
  // 32 of the 96 rays of 0 and of 1, so that the raw matrix is correct and balancing scales
  // nothing.
  FormFactors f;
  f.rays_per_patch = 64;
  f.row_start = {0, 1, 2, 4};
  f.column = {1, 0, 0, 1};
  f.hits = {64, 64, 32 * 64, 32 * 64};
  f.row_scale = {1.0 / 96.0, 1.0 / 96.0, 1.0 / (96.0 * 64.0)};
  f.column_scale.assign(3, 1.0);
  f.kept.assign(3, 1.0);
  for (auto* share : {&f.black, &f.escape, &f.lost}) share->assign(3, 0.0);
  f.sky = {0.0, 0.0, 1.0 / 3.0};
  f.escape = f.sky;
  f.sky_illuminance.assign(3, Rgb(0.0));
  const BalanceReport report = balance(f, std::vector<double>(3, 1.0));
  EXPECT_EQ(report.borrowed, 1U);
  EXPECT_TRUE(report.balanced) << report.after;
  for (const double scale : f.column_scale) EXPECT_NEAR(scale, 1.0, 1e-12);
}

TEST(Balance, FacingPlatesWhoseRaysDisagreeStillBalance) {
  // Each plate's only neighbour is the other: without the sky no scaling could satisfy both sums.
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.plate(m, 1.0, 0.0, true);
  builder.plate(m, 2.0, 1.0, false);
  expect_conservation(builder.scene, 4.0, 64);
}

TEST(Balance, ANearlyClosedRoomNeedsNoMoreSweepsThanAClosedOne) {
  // A slit of a hundredth of the ceiling: the open share is 0.2 % of the surface. Without Newton's
  // step the defect would decrease by about this share per sweep (3e-7 after 500).
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.9));
  builder.room({m, m, m, m, m, m});
  for (Vec3& p : builder.scene.vertices) {
    if (p.z > 0.5 && p.x > 0.5 && &p - builder.scene.vertices.data() >= 20) p.x = 0.99;
  }
  const scenes::RayQuery query(builder.scene);
  const Patches patches = subdivide(builder.scene, 0.1);
  FormFactors factors = cast_form_factors(builder.scene, query, patches, {1024, 1});
  const BalanceReport report = balance(factors, patches.area_m2);
  EXPECT_TRUE(report.balanced);
  EXPECT_LE(report.sweeps, 40);
  EXPECT_LE(worst_column_defect(factors, patches), 1e-10);
}

TEST(Balance, TwoClosedRoomsJoinedByASmallHoleBalance) {
  // Each room's light leaves through a hundredth of a per cent of its surface: the defect between
  // the rooms decreases by about this share per plain sweep (3e-6 after 500), and at once by
  // Newton's step.
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.9));
  scenes::Material sheet = tests::grey(0.9);
  sheet.two_sided = true;
  const std::uint32_t wall = builder.material(sheet);
  builder.room({m, m, m, m, m, m});
  for (Vec3& p : builder.scene.vertices) p.x *= 2.0;
  // The wall between them leaves an opening of 2 x 2 cm in a corner.
  builder.quad(wall, {1, 0, 0}, {1, 0.98, 0}, {1, 0.98, 1}, {1, 0, 1});
  builder.quad(wall, {1, 0.98, 0}, {1, 1, 0}, {1, 1, 0.98}, {1, 0.98, 0.98});
  const scenes::RayQuery query(builder.scene);
  const Patches patches = subdivide(builder.scene, 0.125);
  FormFactors factors = cast_form_factors(builder.scene, query, patches, {1024, 1});
  for (const double black : factors.black) ASSERT_EQ(black, 0.0);
  const BalanceReport report = balance(factors, patches.area_m2);
  EXPECT_TRUE(report.balanced);
  EXPECT_LE(report.sweeps, 150) << report.after;
  EXPECT_LE(worst_column_defect(factors, patches), 1e-10);
}

TEST(Balance, TooFewHitsForAnyScalingAreFilledUntilOneExists) {
  // Eight rays for each of 2400 patches: many patches are hit by one or two rays of neighbours that
  // hit no other starved patch, and no scaling of rows and columns satisfies both sums.
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.room({m, m, m, m, m, m});
  const scenes::RayQuery query(builder.scene);
  const Patches patches = subdivide(builder.scene, 0.05);
  FormFactors factors = cast_form_factors(builder.scene, query, patches, {8, 1});
  const BalanceReport report = balance(factors, patches.area_m2);
  EXPECT_TRUE(report.balanced) << report.after;
  EXPECT_GT(report.filled, 0U);
  EXPECT_LE(report.held, 0.002);  // every patch gets a thousandth; some need more
  EXPECT_LE(worst_column_defect(factors, patches), 1e-10);
  EXPECT_LE(worst_row_defect(factors), 1e-13);
  for (const double scale : factors.column_scale) {
    EXPECT_TRUE(std::isfinite(scale));
    EXPECT_GT(scale, 0.0);
  }
}

TEST(Balance, HitsThatAdmitAScalingAreNotTouched) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.room({m, m, m, m, m, m});
  const scenes::RayQuery query(builder.scene);
  const Patches patches = subdivide(builder.scene, 0.25);
  FormFactors factors = cast_form_factors(builder.scene, query, patches, {256, 1});
  const std::vector<float> hits = factors.hits;
  const BalanceReport report = balance(factors, patches.area_m2);
  EXPECT_EQ(report.filled, 0U);
  EXPECT_EQ(report.held, 0.0);
  EXPECT_EQ(report.worst, no_patch);
  EXPECT_EQ(factors.hits, hits);
}

TEST(Balance, SkySharesSeenAndReachedAgreeWithinTheRaysNoise) {
  // escape_j = F_j,sky by reciprocity; 1024 rays per patch: 4 binomial standard errors of the
  // difference of two estimates.
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.room({m, m, m, m, m, m});
  builder.scene.triangles.resize(10);
  builder.scene.objects.pop_back();
  const scenes::RayQuery query(builder.scene);
  const Patches patches = subdivide(builder.scene, 0.25);
  FormFactors factors = cast_form_factors(builder.scene, query, patches, {1024, 1});
  balance(factors, patches.area_m2);
  for (std::size_t j = 0; j < factors.count(); ++j) {
    EXPECT_NEAR(factors.escape[j], factors.sky[j], 4.0 * std::sqrt(2.0 * 0.25 / 1024.0));
  }
}

TEST(Balance, ALonePlateUnderTheSkyHasNothingToBalance) {
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 1.0, 0.0, true);
  const scenes::RayQuery query(builder.scene);
  const Patches patches = subdivide(builder.scene, 0.25);
  FormFactors factors = cast_form_factors(builder.scene, query, patches, {64, 1});
  EXPECT_TRUE(balance(factors, patches.area_m2).balanced);
  for (const double sky : factors.sky) EXPECT_EQ(sky, 1.0);
}

}  // namespace
}  // namespace earthshine::radiosity
