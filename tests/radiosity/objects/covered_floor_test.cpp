// SPDX-License-Identifier: Apache-2.0
// The area under a body is excluded from the table between objects, in both methods.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "radiosity/exact/form_factors.h"
#include "radiosity/objects/form_factors.h"
#include "tests/support/boxes.h"

namespace earthshine::radiosity {
namespace {

constexpr std::size_t room_floor = 4, room_ceiling = 5, box_side = 6;

// A closed room of 1 m with a box on 0.3 x 0.4 m of its floor; the box's bottom is covered too.
scenes::Scene room_with_box() {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.room({m, m, m, m, m, m});
  tests::add_box(builder, m, {0.21, 0.5, 0.0}, {0.51, 0.9, 0.3});
  return builder.scene;
}

ObjectFormFactors by_rays(const scenes::Scene& scene, double edge_m, int rays, std::uint64_t seed,
                          bool raw = false) {
  const scenes::RayQuery query(scene);
  ObjectFactorReport report;
  return object_form_factors_by_rays(scene, query, subdivide(scene, edge_m), {rays, seed, raw},
                                     report);
}

ObjectFormFactors exactly(const scenes::Scene& scene, ExactReport& report) {
  const scenes::RayQuery query(scene);
  const Patches faces = subdivide(scene, 1e9);
  const ExactFormFactors exact = exact_form_factors(scene, query, faces, {});
  report = exact.report;
  return object_form_factors(scene, faces, exact.factors);
}

double row_sum(const ObjectFormFactors& o, std::size_t i) {
  return std::accumulate(o.F[i].begin(), o.F[i].end(), o.sky[i]);
}

// The floor's open part sees walls, ceiling and box: no black backs in a closed room, and A F is
// symmetric with the open areas, 1 - 0.3 * 0.4 for the floor.
TEST(CoveredFloor, NothingOfItIsBlackByEitherMethod) {
  const scenes::Scene scene = room_with_box();
  ExactReport report;
  const ObjectFormFactors exact = exactly(scene, report);
  EXPECT_EQ(report.open_std_error[room_floor], 0.0);
  EXPECT_NEAR(exact.open_area_m2[room_floor], 0.88, 1e-12);
  const ObjectFormFactors rays = by_rays(scene, 0.25, 1024, 1);
  EXPECT_NEAR(rays.open_area_m2[room_floor], 0.88, 1e-2);
  for (const ObjectFormFactors* o : {&exact, &rays}) {
    EXPECT_NEAR(o->area_m2[room_floor], 1.0, 1e-12);
    EXPECT_NEAR(o->black[room_floor], 0.0, 1e-9);
    EXPECT_NEAR(o->sky[room_floor], 0.0, 1e-5);
    EXPECT_NEAR(row_sum(*o, room_floor), 1.0, 1e-5);
    EXPECT_NEAR(o->open_area_m2[room_floor] * o->F[room_floor][room_ceiling],
                o->F[room_ceiling][room_floor], 2e-5);
  }
  EXPECT_NEAR(rays.F[room_floor][room_ceiling], exact.F[room_floor][room_ceiling],
              4.0 * rays.std_error[room_floor][room_ceiling]);
  EXPECT_NEAR(rays.F[room_floor][box_side], exact.F[room_floor][box_side],
              4.0 * rays.std_error[room_floor][box_side]);
}

// Points estimate the open area, and F is relative to the estimate: only the rays' noise remains in
// F. The mean square of (F - exact) / std_error is 1, for 400 seeds within 4 sqrt(2 / 400), and up
// to 4 % more, because each standard error has 50 or more degrees of freedom.
TEST(CoveredFloor, StandardErrorsHoldWhatPointsLeaveOpenOfTheArea) {
  const scenes::Scene scene = room_with_box();
  ExactReport report;
  const ObjectFormFactors exact = exactly(scene, report);
  constexpr int seeds = 400;
  double square = 0.0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const ObjectFormFactors o = by_rays(scene, 0.5, 128, seed, true);
    const double z = (o.F[room_floor][room_ceiling] - exact.F[room_floor][room_ceiling]) /
                     o.std_error[room_floor][room_ceiling];
    square += z * z / seeds;
  }
  EXPECT_NEAR(square, 1.0, 4.0 * std::sqrt(2.0 / seeds) + 0.04);
}

// A floor that sees only the sky, with a slab of a tenth of a millimetre on it, sends all its light
// there for any estimate of its open part. 64 points in each of 16 replicates estimate the area
// with an error of about 1.5 % / 4, which is no error of F. The error of one hit among 1024 rays is
// the smallest that is stated.
TEST(CoveredFloor, WhatPointsLeaveOpenOfTheAreaIsNoErrorOfAShareOfIt) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.quad(m, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  tests::add_box(builder, m, {0.21, 0.5, 0.0}, {0.51, 0.9, 1e-4});
  const ObjectFormFactors o = by_rays(builder.scene, 2.0, 1024, 1, true);
  EXPECT_NEAR(o.sky[0], 1.0, 2e-3);
  EXPECT_GE(o.sky_std_error[0], 0.9e-3);
  EXPECT_LE(o.sky_std_error[0], 2e-3);
}

TEST(CoveredFloor, AWhollyCoveredObjectSendsNothingAndReceivesNothing) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.quad(m, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  builder.quad(m, {0.3, 0.6, 0.1}, {0.4, 0.6, 0.1}, {0.4, 0.7, 0.1}, {0.3, 0.7, 0.1});
  tests::add_box(builder, m, {0.2, 0.5, 0.0}, {0.5, 0.9, 0.3});
  ExactReport report;
  for (const ObjectFormFactors& o :
       {exactly(builder.scene, report), by_rays(builder.scene, 0.5, 256, 1)}) {
    EXPECT_EQ(o.open_area_m2[1], 0.0);
    EXPECT_NEAR(o.area_m2[1], 0.01, 1e-12);
    EXPECT_EQ(o.black[1], 1.0);
    EXPECT_EQ(row_sum(o, 1), 0.0);
    EXPECT_EQ(o.F[0][1], 0.0);
  }
}

}  // namespace
}  // namespace earthshine::radiosity
