// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "radiosity/fill_solution.h"
#include "radiosity/near_lamps.h"
#include "scenes/health/mend.h"
#include "scenes/light/lamp_light.h"
#include "tests/support/boxes.h"

namespace earthshine::radiosity {
namespace {

scenes::Lamp point_lamp(const char* name, const Vec3& position, const Rgb& intensity_cd) {
  scenes::Lamp lamp;
  lamp.name = name;
  lamp.group = "lamps";
  lamp.position = position;
  lamp.intensity_cd = intensity_cd;
  return lamp;
}

Solution solve_at(const scenes::Scene& scene, double edge_m) {
  SolveOptions options;
  options.patch_edge_m = edge_m;
  return tests::Prepared(scene).solve(options);
}

// given = escaped at once + lost at once + emitted + landed; emitted + landed = absorbed + escaped.
void expect_closed(const GroupLedger& line) {
  for (int c = 0; c < 3; ++c) {
    const double at_once = line.escaped_at_once_lm[c] + line.lost_at_once_lm[c];
    EXPECT_NEAR(line.given_lm[c], at_once + line.absorbed_lm[c] + line.escaped_lm[c],
                1e-12 * line.given_lm[c])
        << line.name;
  }
}

// A lamp above the middle of a plate at half its side: the plate is one of a cube's six faces and
// receives a sixth of 4 pi I. With 65536 rays the share of misses has a standard error of sqrt(5/36
// / 65536) = 0.0015.
constexpr double flux_lm = 400.0 * base::pi, sixth_error_lm = 4 * 0.0015 * flux_lm;

TEST(Ledger, LampOverAPlateGivesWhatLandsAndWhatEscapesAtOnce) {
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 1.0, 0.0, true);
  builder.scene.lamps.push_back(point_lamp("lamp", {0, 0, 0.5}, Rgb(100.0)));
  const SolveReport report = solve_at(builder.scene, 0.25).report;
  const GroupLedger& line = report.groups.at(0);
  EXPECT_NEAR(line.given_lm.g, flux_lm, 1e-9);
  EXPECT_NEAR(line.escaped_at_once_lm.g, flux_lm * 5 / 6, sixth_error_lm);
  EXPECT_NEAR(line.lost_at_once_lm.g, 0.0, 1e-9);
  EXPECT_NEAR(line.landed_lm.g, flux_lm - line.escaped_at_once_lm.g, 1e-9);
  EXPECT_NEAR(report.sources.at(0).landed_lm.g, line.landed_lm.g, 1e-9);
  expect_closed(line);
}

// With 4096 rays, as for pictures, the standard error is four times larger, and the balance equally
// exact. The lamp casts 61 440 fewer rays; nothing else changes.
TEST(Ledger, FewerRaysFromALampAreRougherAndCloseAsWell) {
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 1.0, 0.0, true);
  builder.scene.lamps.push_back(point_lamp("lamp", {0, 0, 0.5}, Rgb(100.0)));
  SolveOptions few;
  few.patch_edge_m = 0.25;
  few.flux_rays = 4096;
  const SolveReport report = tests::Prepared(builder.scene).solve(few).report;
  EXPECT_EQ(solve_at(builder.scene, 0.25).report.shadow_rays - report.shadow_rays, 61440U);
  const GroupLedger& line = report.groups.at(0);
  EXPECT_NEAR(line.escaped_at_once_lm.g, flux_lm * 5 / 6, 4 * sixth_error_lm);
  expect_closed(line);
}

TEST(Ledger, LampUnderABlackBackLosesASixthThere) {
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 1.0, 0.0, true);
  builder.scene.lamps.push_back(point_lamp("lamp", {0, 0, -0.5}, Rgb(100.0)));
  const GroupLedger line = solve_at(builder.scene, 0.25).report.groups.at(0);
  EXPECT_NEAR(line.given_lm.g, flux_lm, 1e-9);
  EXPECT_NEAR(line.lost_at_once_lm.g, flux_lm / 6, sixth_error_lm);
  EXPECT_NEAR(line.escaped_at_once_lm.g, flux_lm * 5 / 6, sixth_error_lm);
  EXPECT_EQ(line.landed_lm.g, 0.0);
  expect_closed(line);
}

TEST(Ledger, SkyAndSurfacesCarriedByFGiveWhatLandsAndWhatTheyEmit) {
  // The Sun at 60 degrees to a plate of 1 m2; another one of 1 m2 beside it that emits 10 lm/m2.
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 1.0, 0.0, true);
  scenes::Material shining = tests::grey(0.0, 10.0);
  shining.light_group = "shining";
  builder.quad(builder.material(shining), {5, 0, 0}, {6, 0, 0}, {6, 1, 0}, {5, 1, 0});
  scenes::Sun sun;
  sun.direction = Vec3(std::sqrt(0.75), 0, 0.5);
  sun.angular_radius_deg = 0.0;
  builder.scene.sun = sun;
  // From 60 degrees too: half of its illuminance on both.
  scenes::Lamp distant;
  distant.name = distant.group = "distant";
  distant.kind = scenes::LampKind::Distant;
  distant.axis = -Vec3(0, std::sqrt(0.75), 0.5);
  distant.illuminance_lx = Rgb(14.0);
  builder.scene.lamps.push_back(distant);
  const auto given = [](const std::string& name) {
    return name == "distant" ? 14.0 : name == "shining" ? 10.0 : 133100.0;
  };
  for (const GroupLedger& line : solve_at(builder.scene, 0.5).report.groups) {
    EXPECT_NEAR(line.given_lm.g / given(line.name), 1.0, 1e-12) << line.name;
    EXPECT_EQ(line.escaped_at_once_lm.g, 0.0);
    EXPECT_EQ(line.lost_at_once_lm.g, 0.0);
    expect_closed(line);
  }
}

TEST(Ledger, ManyLampsOfTwoColoursInAClosedRoomLandTheFluxOfEachChannel) {
  // 40 lamps are selected randomly, so that red and blue of the samples are wrong by some per
  // mille. Nothing escapes: each channel lands as emitted, 20 lamps of 4 pi I.
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.room({m, m, m, m, m, m});
  for (int k = 0; k < 40; ++k) {
    const Vec3 place(0.1 + 0.2 * (k % 5), 0.2 + 0.2 * (k / 5 % 4), k < 20 ? 0.3 : 0.8);
    builder.scene.lamps.push_back(
        point_lamp("lamp", place, k % 2 == 0 ? Rgb(10.0, 0.0, 0.0) : Rgb(0.0, 0.0, 30.0)));
  }
  const GroupLedger line = solve_at(builder.scene, 0.25).report.groups.at(0);
  EXPECT_NEAR(line.landed_lm.r / (20 * 40.0 * base::pi), 1.0, 1e-12);
  EXPECT_NEAR(line.landed_lm.b / (20 * 120.0 * base::pi), 1.0, 1e-12);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(line.escaped_at_once_lm[c] + line.lost_at_once_lm[c], 0.0, 1e-9);
  }
  expect_closed(line);
}

// A closed cube of 1 m: the flux of every lamp lands exactly. Spots of half a degree and less light
// a few mm of a wall that no sample point of a patch of 0.25 m hits.
TEST(Ledger, EveryLampInAClosedRoomGivesAndLandsItsFlux) {
  std::vector<scenes::Lamp> lamps;
  for (const double field_deg : {0.1, 0.5, 1.0, 2.0, 5.0, 60.0}) {
    scenes::Lamp spot = point_lamp("spot", {0.4, 0.55, 0.9}, Rgb(1000.0, 2000.0, 500.0));
    spot.kind = scenes::LampKind::Spot;
    spot.axis = glm::normalize(Vec3(0.13, 0.07, -0.8));
    spot.beam_deg = 0.5 * field_deg;
    spot.field_deg = field_deg;
    lamps.push_back(spot);
  }
  for (const Vec3& place :
       {Vec3(0.5, 0.5, 0.5), Vec3(0.5, 0.5, 1e-3), Vec3(1e-3, 2e-3, 1e-3), Vec3(0.1, 0.93, 0.4)}) {
    lamps.push_back(point_lamp("point", place, Rgb(10.0, 20.0, 30.0)));
  }
  scenes::Lamp disk = point_lamp("disk", {0.5, 0.5, 0.999}, Rgb(0.0));
  disk.kind = scenes::LampKind::Disk;
  disk.axis = Vec3(0, 0, -1);
  disk.radius_m = 0.5;  // to the walls
  disk.exitance = Rgb(100.0);
  lamps.push_back(disk);
  scenes::Lamp rectangle = disk;
  rectangle.name = "rectangle";
  rectangle.kind = scenes::LampKind::Rectangle;
  rectangle.edge_u = Vec3(1, 0, 0);
  rectangle.edge_v = Vec3(0, -1, 0);
  lamps.push_back(rectangle);
  for (const scenes::Lamp& lamp : lamps) {
    tests::SceneBuilder builder;
    const std::uint32_t m = builder.material(tests::grey(0.5));
    builder.room({m, m, m, m, m, m});
    builder.scene.lamps.push_back(lamp);
    SolveOptions options;
    options.patch_edge_m = 0.25;
    const tests::Prepared prepared(builder.scene);
    const GroupLedger line =
        solve(prepared, options, subdivide_near_lamps(builder.scene, 0.25)).report.groups.at(0);
    const Rgb flux = scenes::lamp_flux_lm(lamp);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(line.given_lm[c] / flux[c], 1.0, 1e-9) << lamp.name << " " << lamp.field_deg;
      EXPECT_NEAR(line.landed_lm[c] / flux[c], 1.0, 1e-9) << lamp.name << " " << lamp.field_deg;
    }
    EXPECT_LT(line.imbalance, 1e-9) << lamp.name << " " << lamp.field_deg;
  }
}

// A luminaire's closed housing on a floor: the lamp inside lights nothing, and all of its flux ends
// on black backs, including the floor under the housing.
TEST(Ledger, ALampInAHousingOnAFloorLosesAllOfItsFlux) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.plate(m, 4.0, 0.0, true);
  const std::size_t housing = builder.scene.objects.size();
  tests::add_box(builder, m, {-0.5, -0.5, 0.0}, {0.5, 0.5, 1.0});
  for (scenes::Triangle& triangle : builder.scene.triangles) {
    triangle.object = std::min(triangle.object, static_cast<std::uint32_t>(housing));
  }
  builder.scene.objects.resize(housing + 1);
  builder.scene.objects[housing].triangle_count = 12;
  scenes::find_coincident_faces(builder.scene, scenes::mend_surfaces(builder.scene, {}));
  builder.scene.lamps.push_back(point_lamp("lamp", {0.1, 0.2, 0.5}, Rgb(100.0)));
  const GroupLedger line = solve_at(builder.scene, 0.25).report.groups.at(0);
  EXPECT_EQ(line.landed_lm.g, 0.0);
  EXPECT_NEAR(line.lost_at_once_lm.g / flux_lm, 1.0, 1e-9);
  EXPECT_LT(line.imbalance, 1e-9);
}

// A spot of 0.02 degrees on patches that were not refined for beams: no sample finds its light, and
// the ledger reports it.
TEST(Ledger, FluxThatNoSampleFindsIsAnImbalance) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.room({m, m, m, m, m, m});
  scenes::Lamp spot = point_lamp("spot", {0.4, 0.55, 0.9}, Rgb(1000.0));
  spot.kind = scenes::LampKind::Spot;
  spot.axis = Vec3(0, 0, -1);
  spot.beam_deg = 0.01;
  spot.field_deg = 0.02;
  builder.scene.lamps.push_back(spot);
  const tests::Prepared prepared(builder.scene);
  const GroupLedger line =
      solve(prepared, SolveOptions{}, subdivide(builder.scene, 1.0)).report.groups.at(0);
  EXPECT_NEAR(line.given_lm.g / scenes::lamp_flux_lm(spot).g, 1.0, 1e-9);
  EXPECT_EQ(line.landed_lm.g, 0.0);
  EXPECT_NEAR(line.imbalance, 1.0, 1e-9);
}

}  // namespace
}  // namespace earthshine::radiosity
