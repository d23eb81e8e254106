// SPDX-License-Identifier: Apache-2.0
#include "radiosity/near_lamps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "radiosity/patches/split.h"
#include "radiosity/solution.h"
#include "tests/support/scene_builder.h"

namespace earthshine::radiosity {
namespace {

constexpr double half_edge = 1.0, start_edge = 0.25;

// A square floor with a lamp of 1000 lm at this height over its centre.
scenes::Scene floor_under_lamp(double height, scenes::LampKind kind = scenes::LampKind::Point) {
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 2.0 * half_edge, 0.0, true);
  Vec3 low = builder.scene.vertices.front(), high = low;
  for (const Vec3& vertex : builder.scene.vertices) {
    low = glm::min(low, vertex);
    high = glm::max(high, vertex);
  }
  scenes::Lamp lamp;
  lamp.name = lamp.group = "lamp";
  lamp.kind = kind;
  lamp.position = 0.5 * (low + high) + Vec3(0.0, 0.0, height);
  lamp.intensity_cd = Rgb(1000.0 / (4.0 * base::pi));
  lamp.axis = Vec3(0.0, 0.0, 1.0);
  lamp.beam_deg = 60.0, lamp.field_deg = 90.0;
  builder.scene.lamps.push_back(lamp);
  return builder.scene;
}

Patches cut(const scenes::Scene& scene) { return subdivide_near_lamps(scene, start_edge); }

// A spot of half a degree 1 m over the floor lights 8.7 mm of it: area pi (4.4 mm)^2, smooth toward
// its border, so that a patch with 1/32 of the flux is about 1.4 mm wide.
TEST(NearLamps, NoPatchHoldsMuchOfANarrowBeam) {
  for (const double field_deg : {0.1, 0.5, 5.0}) {
    scenes::Scene scene = floor_under_lamp(1.0, scenes::LampKind::Spot);
    scene.lamps[0].axis = glm::normalize(Vec3(0.1, 0.2, -1.0));
    scene.lamps[0].beam_deg = 0.5 * field_deg;
    scene.lamps[0].field_deg = field_deg;
    const Patches patches = cut(scene);
    const double radius = std::tan(base::radians(field_deg / 2));
    const Vec3 middle = scene.lamps[0].position + scene.lamps[0].axis / -scene.lamps[0].axis.z;
    double smallest = 1.0, longest_inside = 0.0;
    for (std::uint32_t i = 0; i < patches.count(); ++i) {
      const CellSize size = cell_size(patches, i);
      smallest = std::min(smallest, std::min(size.s_m, size.t_m));
      if (glm::length(patches.point(i, 0.5, 0.5) - middle) > 0.5 * radius) continue;
      longest_inside = std::max(longest_inside, std::max(size.s_m, size.t_m));
    }
    EXPECT_GT(longest_inside, 0.0) << field_deg;
    EXPECT_LT(longest_inside, 0.6 * radius) << field_deg;
    EXPECT_GT(smallest, 0.05 * radius) << field_deg;
    EXPECT_LT(patches.count(), 64U + 600U) << field_deg;
  }
}

TEST(NearLamps, NoPatchIsLongerThanAQuarterOfItsDistance) {
  for (const double height : {1e-3, 0.03}) {
    const scenes::Scene scene = floor_under_lamp(height);
    const Patches patches = cut(scene);
    const double area = std::accumulate(patches.area_m2.begin(), patches.area_m2.end(), 0.0);
    EXPECT_NEAR(area, 4.0 * half_edge * half_edge, 1e-12);
    for (std::uint32_t i = 0; i < patches.count(); ++i) {
      const CellSize size = cell_size(patches, i);
      // Distance to the nearest of many points of the patch: at least the distance to the patch.
      double distance = 1e9;
      for (int k = 0; k < 81; ++k) {
        const Vec3 point = patches.point(i, k % 9 / 8.0, k / 9 / 8.0);
        distance = std::min(distance, glm::length(point - scene.lamps[0].position));
      }
      EXPECT_LE(std::max(size.s_m, size.t_m), distance / 4.0);
    }
    // Each halving of scale adds the same number, far fewer than uniform patches: the ring from r
    // to 2 r has 3 pi r^2, and halving stops above r / 8, so that 192 pi = 603 fit.
    EXPECT_LT(patches.count(), 64U + 603U * std::size_t(std::log2(start_edge / height) + 3.0));
  }
}

// A lamp of 1.6 m is as near at its ends as in its middle.
TEST(NearLamps, LongLampsAreNearAlongAllTheirLength) {
  scenes::Scene scene = floor_under_lamp(0.07, scenes::LampKind::Rectangle);
  scenes::Lamp& lamp = scene.lamps[0];
  lamp.edge_u = Vec3(0.0, 1.6, 0.0);
  lamp.edge_v = Vec3(0.01, 0.0, 0.0);
  lamp.axis = Vec3(0.0, 0.0, -1.0);
  lamp.exitance = Rgb(1000.0);
  const Patches patches = cut(scene);
  for (std::uint32_t i = 0; i < patches.count(); ++i) {
    const CellSize size = cell_size(patches, i);
    double distance = 1e9;
    for (int k = 0; k < 81; ++k) {
      const Vec3 way = patches.point(i, k % 9 / 8.0, k / 9 / 8.0) - lamp.position;
      const double beyond_u = std::max(std::abs(way.y) - 0.8, 0.0);
      const double beyond_v = std::max(std::abs(way.x) - 0.005, 0.0);
      distance = std::min(distance, std::hypot(beyond_u, beyond_v, way.z));
    }
    EXPECT_LE(std::max(size.s_m, size.t_m), distance / 4.0);
  }
}

TEST(NearLamps, OnlyWhatTheyShineAtIsCut) {
  const std::size_t even = subdivide(floor_under_lamp(1.0), start_edge).count();
  EXPECT_EQ(cut(floor_under_lamp(1.0)).count(), even);
  EXPECT_EQ(cut(floor_under_lamp(-1e-3)).count(), even);  // behind a black back
  EXPECT_EQ(cut(floor_under_lamp(1e-3, scenes::LampKind::Spot)).count(), even);  // directed away
}

// Near a lamp of radius 0.2 m the light varies no faster than over its size: no patch is longer
// than 0.05 m, and none so short is halved.
TEST(NearLamps, NothingIsCutForLessThanTheSizeOfTheLamp) {
  scenes::Scene scene = floor_under_lamp(1e-3, scenes::LampKind::Disk);
  scene.lamps[0].radius_m = 0.2;
  scene.lamps[0].axis = Vec3(0.0, 0.0, -1.0);
  const Patches patches = cut(scene);
  double shortest = start_edge;
  for (std::uint32_t i = 0; i < patches.count(); ++i) {
    const CellSize size = cell_size(patches, i);
    shortest = std::min({shortest, size.s_m, size.t_m});
  }
  EXPECT_LE(shortest, 0.05);
  EXPECT_GT(shortest, 0.025);
}

// The solid angle of a square of half edge a from height h over its centre is 4 atan(a^2 / (h
// sqrt(2 a^2 + h^2))): this share of 1000 lm / 4 pi lands.
TEST(NearLamps, HalfOfTheirLightLands) {
  for (const double height : {0.1, 1e-3, 1e-4, 5e-5}) {
    const scenes::Scene scene = floor_under_lamp(height);
    const tests::Prepared prepared(scene);
    SolveOptions options;
    options.patch_edge_m = start_edge;
    const Solution solution = prepared.solve(options);
    const double a2 = half_edge * half_edge;
    const double solid_angle =
        4.0 * std::atan(a2 / (height * std::sqrt(2.0 * a2 + height * height)));
    const SourceFlux& flux = solution.report.sources.at(0);
    EXPECT_NEAR(flux.landed_lm.y, 1000.0 * solid_angle / (4.0 * base::pi),
                4.0 * 1000.0 * flux.share_std_error)
        << height;
    EXPECT_NEAR(flux.scale, 1.0, 0.01) << height;  // by the patches' own samples
  }
}

}  // namespace
}  // namespace earthshine::radiosity
