// SPDX-License-Identifier: Apache-2.0
#include "raytrace/light/distributed_area.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "raytrace/light/light_sampler.h"
#include "tests/support/scene_builder.h"

namespace earthshine::raytrace {
namespace {

constexpr double earth_radiance = 1000.0;

scenes::Area area(const Vec3& center, const Vec3& edge_u, const Vec3& edge_v) {
  const Vec3 normal = glm::normalize(glm::cross(edge_u, edge_v));
  return {"panel", center, edge_u, edge_v, normal};
}

// A plate of 1 m around the origin, facing up to a uniform Earth of half angle 70 degrees.
scenes::Scene plate_under(const scenes::Area& over) {
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 1.0, 0.0, true);
  scenes::Earth earth;
  earth.half_angle_deg = 70.0;
  earth.model = scenes::EarthModel::Uniform;
  earth.radiance = Rgb(earth_radiance);
  builder.scene.earth = earth;
  builder.scene.areas.push_back(over);
  return builder.scene;
}

// Facing down, 4 m wide, 2 m above the plate.
scenes::Area overhead() { return area({0, 0, 2}, {0, 4, 0}, {4, 0, 0}); }

double exact_illuminance() {  // E = pi L sin^2
  return base::pi * earth_radiance * std::pow(std::sin(base::radians(70.0)), 2);
}

// Unoccluded illuminance of a horizontal plate at a point from the sampler's lights.
double illuminance(const scenes::Scene& scene, int lights, const Vec3& point) {
  const tests::Prepared prepared(scene);
  const LightSampler sampler(prepared, Indirect::Distributed, lights, false,
                             earth_area(scene, "panel"));
  double sum = 0.0;
  for (std::size_t k = 0; k < sampler.count(); ++k) {
    const scenes::LightSample sample = sampler.sample(k, point, 0.5, 0.5);
    sum += sample.normal_illuminance_lx.g * std::max(0.0, sample.direction.z);
  }
  return sum;
}

TEST(DistributedArea, UniformEarthsIlluminanceIsExact) {
  EXPECT_NEAR(earth_illuminance_lx(plate_under(overhead())).g / exact_illuminance(), 1.0, 1e-9);
}

TEST(DistributedArea, ManyLightsGiveTheScenesCentreWhatTheEarthDoes) {
  // The lattice's error falls nearly as 1/N for an integrand without edges.
  const scenes::Scene scene = plate_under(overhead());
  double before = 1.0;
  for (const int lights : {16, 256, 4096}) {
    const double error =
        std::abs(illuminance(scene, lights, Vec3(0.0)) / exact_illuminance() - 1.0);
    EXPECT_LT(error, before) << lights;
    before = error;
  }
  EXPECT_LT(before, 1e-3);
}

TEST(DistributedArea, LightsTogetherEmitTheAreasFlux) {
  // Far below, N lights equal one of intensity M A / pi on the axis, for any N.
  const scenes::Scene scene = plate_under(overhead());
  const double exitance = earth_area(scene, "panel")->exitance.g;
  const double d = 1e5;
  for (const int lights : {2, 7, 64}) {
    const double intensity = illuminance(scene, lights, Vec3(0, 0, 2.0 - d)) * d * d;
    EXPECT_NEAR(intensity * base::pi / (exitance * 16.0), 1.0, 1e-8) << lights;
  }
}

TEST(DistributedArea, WhatLiesBelowThePlatesHorizonDoesNotCount) {
  // A wall in the plane x = 2 facing the plate: its lower half changes nothing.
  const scenes::Scene whole = plate_under(area({2, 0, 0}, {0, 0, 2}, {0, 2, 0}));
  const scenes::Scene upper = plate_under(area({2, 0, 0.5}, {0, 0, 1}, {0, 2, 0}));
  EXPECT_NEAR(earth_area(whole, "panel")->exitance.g / earth_area(upper, "panel")->exitance.g, 1.0,
              1e-12);
}

std::string refusal(const scenes::Scene& scene, const std::string& name) {
  try {
    (void)earth_area(scene, name);
  } catch (const base::Error& error) {
    EXPECT_EQ(error.blame(), base::Blame::Input);
    return error.what();
  }
  return "";
}

TEST(DistributedArea, AreasThatCannotStandForTheEarthAreRefused) {
  const scenes::Scene scene = plate_under(overhead());
  EXPECT_FALSE(earth_area(scene, ""));
  EXPECT_NE(refusal(scene, "pannel").find("its areas are panel"), std::string::npos);
  const scenes::Scene turned = plate_under(area({0, 0, 2}, {4, 0, 0}, {0, 4, 0}));
  EXPECT_NE(refusal(turned, "panel").find("swap edge_u and edge_v"), std::string::npos);
  const scenes::Scene below = plate_under(area({0, 0, -2}, {4, 0, 0}, {0, 4, 0}));
  EXPECT_NE(refusal(below, "panel").find("does not light"), std::string::npos);
  scenes::Scene without = scene;
  without.earth.reset();
  EXPECT_NE(refusal(without, "panel").find("Add [earth]"), std::string::npos);
}

}  // namespace
}  // namespace earthshine::raytrace
