// SPDX-License-Identifier: Apache-2.0
#include "scenes/light/lamp_light.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/numbers/random.h"

namespace earthshine::scenes {
namespace {

Lamp spot() {
  Lamp lamp;
  lamp.kind = LampKind::Spot;
  lamp.axis = Vec3(0, 0, -1);
  lamp.position = Vec3(0, 0, 3);
  lamp.intensity_cd = Rgb(1152.0);
  lamp.beam_deg = 100.0;
  lamp.field_deg = 135.0;
  return lamp;
}

TEST(Lamp, EighteenFootcandlesAtEightFeetIs1152CandelaByInverseSquare) {
  // 18 fc = 193.75 lx at 2.4384 m: I = E d^2 = 1152 cd.
  Lamp lamp = spot();
  lamp.position = Vec3(0, 0, 2.4384);
  const LightSample sample = sample_lamp(lamp, Vec3(0.0), 0.5, 0.5);
  EXPECT_NEAR(sample.normal_illuminance_lx.g, 193.75, 0.05);
  EXPECT_NEAR(sample.distance_m, 2.4384, 1e-12);
}

TEST(Lamp, SpotsFluxIsTheIntegralOfItsProfile) {
  const Lamp lamp = spot();
  double integral = 0.0;  // over solid angle, midpoint in the cosine
  const int steps = 100000;
  for (int k = 0; k < steps; ++k) {
    const double cosine = -1.0 + 2.0 * (k + 0.5) / steps;
    integral += spot_profile(lamp, cosine) * 2.0 * base::pi * 2.0 / steps;
  }
  EXPECT_NEAR(lamp_flux_lm(lamp).g / (1152.0 * integral), 1.0, 1e-6);
}

TEST(Lamp, SpotIsFullInItsBeamAndDarkBeyondItsField) {
  const Lamp lamp = spot();
  EXPECT_EQ(spot_profile(lamp, std::cos(base::radians(49.9))), 1.0);
  EXPECT_EQ(spot_profile(lamp, std::cos(base::radians(67.6))), 0.0);
}

TEST(Lamp, PointLampsFluxIsFourPiTimesItsIntensity) {
  Lamp lamp;
  lamp.intensity_cd = Rgb(100.0);
  EXPECT_NEAR(lamp_flux_lm(lamp).g, 400.0 * base::pi, 1e-9);
}

TEST(Lamp, DiskGivesItsAxisTheClosedForm) {
  // On the axis at height h of a Lambertian disc: E = M r^2 / (r^2 + h^2); mean over stratified
  // samples, whose error is below 1e-4 at 256 x 4 points of a smooth integrand.
  Lamp lamp;
  lamp.kind = LampKind::Disk;
  lamp.position = Vec3(0, 0, 2);
  lamp.axis = Vec3(0, 0, -1);
  lamp.radius_m = 1.0;
  lamp.exitance = Rgb(1000.0);
  double sum = 0.0;
  for (int i = 0; i < 256; ++i) {
    for (int k = 0; k < 4; ++k) {
      const LightSample s = sample_lamp(lamp, Vec3(0.0), (i + 0.5) / 256, (k + 0.5) / 4);
      sum += s.normal_illuminance_lx.g * s.direction.z;
    }
  }
  EXPECT_NEAR(sum / 1024 / (1000.0 / 5.0), 1.0, 1e-4);
}

TEST(Lamp, DiskOverAFloorGivesItTheClosedFormHoweverNear) {
  // E = M r^2 / (r^2 + h^2) again, with 64 x 64 points. Points uniform over the disk fail at h =
  // 1e-3 r: one in a million of them is as near as h. Points uniform in the solid angle of the
  // enclosing square miss by the strips along the rim, 4 in 64 of few cells: tolerance 1 %.
  Lamp lamp;
  lamp.kind = LampKind::Disk;
  lamp.axis = glm::normalize(Vec3(0.3, -0.5, 0.8));
  lamp.radius_m = 2.0;
  lamp.exitance = Rgb(1000.0);
  for (const double height : {2e-6, 2e-3, 0.1, 1.0, 1.9}) {
    lamp.position = Vec3(1, 2, 3);
    const Vec3 below = lamp.position + height * lamp.axis;
    double sum = 0.0;
    for (int i = 0; i < 64; ++i) {
      for (int k = 0; k < 64; ++k) {
        const LightSample s = sample_lamp(lamp, below, (i + 0.5) / 64, (k + 0.5) / 64);
        sum -= s.normal_illuminance_lx.g * glm::dot(s.direction, lamp.axis);
      }
    }
    EXPECT_NEAR(sum / 4096 / (1000.0 * 4.0 / (4.0 + height * height)), 1.0, 0.01) << height;
  }
}

TEST(Lamp, RectangleShinesOneWayAndCanBeSeenFromThereOnly) {
  Lamp lamp;
  lamp.kind = LampKind::Rectangle;
  lamp.position = Vec3(0, 0, 2);
  lamp.edge_u = Vec3(0, 1, 0);
  lamp.edge_v = Vec3(1, 0, 0);
  lamp.axis = Vec3(0, 0, -1);  // edge_u x edge_v
  lamp.exitance = Rgb(10.0);
  EXPECT_NEAR(lamp_flux_lm(lamp).r, 10.0, 1e-12);
  const auto hit = hit_lamp(lamp, Vec3(0.4, 0.4, 0), Vec3(0, 0, 1));
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->distance_m, 2.0, 1e-12);
  EXPECT_NEAR(hit->radiance.r, 10.0 / base::pi, 1e-12);
  EXPECT_FALSE(hit_lamp(lamp, Vec3(0.6, 0.4, 0), Vec3(0, 0, 1)));
  EXPECT_FALSE(hit_lamp(lamp, Vec3(0.4, 0.4, 4), Vec3(0, 0, -1)));
  EXPECT_EQ(sample_lamp(lamp, Vec3(0, 0, 4), 0.5, 0.5).normal_illuminance_lx.r, 0.0);
}

TEST(Lamp, EmittedRaysCarryTheFluxTheySample) {
  // Mean weight 1, and a spot's mean cosine equals the profile's first moment.
  const Lamp lamp = spot();
  const base::SobolOwen4 sobol(base::Key(3, base::Stream::Test, 0));
  double weight = 0.0, cosine = 0.0;
  const int count = 1 << 14;
  for (int k = 0; k < count; ++k) {
    const auto p = sobol.point(static_cast<std::uint32_t>(k));
    const EmittedRay ray = emit_from_lamp(lamp, p[0], p[1], p[2], p[3]);
    weight += ray.weight / count;
    cosine += ray.weight * glm::dot(ray.direction, lamp.axis) / count;
  }
  double moment = 0.0, total = 0.0;
  for (int k = 0; k < 100000; ++k) {
    const double c = (k + 0.5) / 100000;
    moment += spot_profile(lamp, c) * c;
    total += spot_profile(lamp, c);
  }
  // Weights lie in [0, 2.2]: the plain Monte Carlo standard error would be below 0.5 / sqrt(16384)
  // = 0.004.
  EXPECT_NEAR(weight, 1.0, 4 * 0.004);
  EXPECT_NEAR(cosine, moment / total, 4 * 0.004);
}

TEST(Cone, SolidAngleOfTheSunKeepsItsDigits) {
  // pi r^2 (1 - r^2 / 12) for small r.
  const double r = base::radians(0.2666);
  EXPECT_NEAR(cone_solid_angle_sr(r) / (base::pi * r * r * (1.0 - r * r / 12.0)), 1.0, 1e-10);
}

}  // namespace
}  // namespace earthshine::scenes
