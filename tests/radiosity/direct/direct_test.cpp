// SPDX-License-Identifier: Apache-2.0
#include "radiosity/direct/direct.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/scene_builder.h"

namespace earthshine::radiosity {
namespace {

// A plate of 0.1 mm facing up at the origin, in one patch.
tests::SceneBuilder small_plate() {
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 1e-4, 0.0, true);
  return builder;
}

double illuminance(const scenes::Scene& scene) {
  const tests::Prepared prepared(scene);
  SolveOptions options;
  options.patch_edge_m = 1.0;
  return prepared.solve(options).report.objects[0].illuminance_lx.g;
}

TEST(Direct, PointSunGivesItsIlluminanceTimesTheCosine) {
  tests::SceneBuilder builder = small_plate();
  scenes::Sun sun;
  sun.direction =
      glm::normalize(Vec3(std::sin(base::radians(60.0)), 0, std::cos(base::radians(60.0))));
  sun.angular_radius_deg = 0.0;
  builder.scene.sun = sun;
  EXPECT_NEAR(illuminance(builder.scene) / (133100.0 * 0.5), 1.0, 1e-12);
}

TEST(Direct, WideSunGivesAPlateThatFacesItItsIlluminance) {
  // For any size of the disc: 16 Owen-Sobol points of a cosine from 1 to cos 20 deg = 0.94 have a
  // standard error below 0.02 / 16.
  tests::SceneBuilder builder = small_plate();
  scenes::Sun sun;
  sun.angular_radius_deg = 20.0;
  builder.scene.sun = sun;
  EXPECT_NEAR(illuminance(builder.scene) / 133100.0, 1.0, 4 * 0.00125);
}

TEST(Direct, PointLampObeysTheInverseSquareAndCosineLaws) {
  // 1000 cd at 4 m, 60 deg off the plate's normal: E = 1000 / 16 * 0.5. Over the plate E varies by
  // 3e-5.
  tests::SceneBuilder builder = small_plate();
  scenes::Lamp lamp;
  lamp.name = lamp.group = "lamp";
  lamp.position = 4.0 * Vec3(std::sin(base::radians(60.0)), 0, std::cos(base::radians(60.0)));
  lamp.intensity_cd = Rgb(1000.0);
  builder.scene.lamps.push_back(lamp);
  EXPECT_NEAR(illuminance(builder.scene) / 31.25, 1.0, 3e-5);
}

TEST(Direct, ShadowIsWhereTheBlockerStands) {
  tests::SceneBuilder builder = small_plate();
  scenes::Sun sun;
  sun.direction = Vec3(0, 0, 1);
  builder.scene.sun = sun;
  builder.plate(0, 0.5, 1.0, false);
  EXPECT_EQ(illuminance(builder.scene), 0.0);
}

TEST(Direct, UniformEarthOverANadirPlateIsPiLTimesTheViewFactor) {
  // E = pi L (R / (R + h))^2. One patch, 1024 rays: the binomial standard error of the share of
  // rays that hit the disc, times pi L.
  tests::SceneBuilder builder = small_plate();
  scenes::Earth earth;
  earth.half_angle_deg = base::degrees(std::asin(6371.0 / 6796.0));
  earth.model = scenes::EarthModel::Uniform;
  earth.radiance = Rgb(1000.0);
  builder.scene.earth = earth;
  const double share = std::pow(6371.0 / 6796.0, 2);
  const double exact = base::pi * 1000.0 * share;
  const double std_error = base::pi * 1000.0 * std::sqrt(share * (1.0 - share) / 1024.0);
  EXPECT_NEAR(illuminance(builder.scene), exact, 4.0 * std_error);
}

TEST(Direct, NarrowEarthIsSampledAndAgreesWithTheSameLaw) {
  // Half angle 5 deg: E = pi L sin^2(5 deg); 64 points over a disc whose cosine varies by 0.4 %:
  // the standard error of the mean is below 0.004 / sqrt(64).
  tests::SceneBuilder builder = small_plate();
  scenes::Earth earth;
  earth.half_angle_deg = 5.0;
  earth.model = scenes::EarthModel::Uniform;
  earth.radiance = Rgb(1000.0);
  builder.scene.earth = earth;
  const double exact = base::pi * 1000.0 * std::pow(std::sin(base::radians(5.0)), 2);
  EXPECT_NEAR(illuminance(builder.scene) / exact, 1.0, 4 * 0.0005);
}

TEST(Direct, LampInAClosedRoomLandsItsWholeFlux) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.room({m, m, m, m, m, m});
  scenes::Lamp lamp;
  lamp.name = lamp.group = "lamp";
  lamp.position = Vec3(0.3, 0.6, 0.4);
  lamp.intensity_cd = Rgb(100.0, 50.0, 25.0);
  builder.scene.lamps.push_back(lamp);
  const tests::Prepared prepared(builder.scene);
  SolveOptions options;
  options.patch_edge_m = 0.25;
  const Solution solution = prepared.solve(options);
  const GroupLedger& ledger = solution.report.groups.at(0);
  EXPECT_NEAR(ledger.landed_lm.r, 400.0 * base::pi, 1e-9);
  EXPECT_NEAR(ledger.landed_lm.b, 100.0 * base::pi, 1e-9);
  EXPECT_EQ(solution.report.sources.at(0).escaped_share, 0.0);
  // The patches' samples agree within a few per mille before scaling.
  EXPECT_NEAR(solution.report.sources.at(0).scale, 1.0, 0.01);
}

TEST(Direct, EmitterIsCarriedOneWayByItsShareOfTheSurface) {
  tests::SceneBuilder builder;
  const std::uint32_t wall = builder.material(tests::grey(0.5));
  const std::uint32_t bright = builder.material(tests::grey(0.0, 100.0));
  builder.room({wall, wall, wall, wall, wall, bright});  // a sixth of the surface: through F
  EXPECT_FALSE(emitter_is_explicit(builder.scene)[bright]);
  tests::SceneBuilder small;
  const std::uint32_t grey = small.material(tests::grey(0.5));
  const std::uint32_t lamp = small.material(tests::grey(0.0, 100.0));
  small.room({grey, grey, grey, grey, grey, grey});
  small.quad(lamp, {0.4, 0.4, 0.99}, {0.4, 0.6, 0.99}, {0.6, 0.6, 0.99}, {0.6, 0.4, 0.99});
  EXPECT_TRUE(emitter_is_explicit(small.scene)[lamp]);
}

}  // namespace
}  // namespace earthshine::radiosity
