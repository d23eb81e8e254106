// SPDX-License-Identifier: Apache-2.0
#include "scenes/sky/sky.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scenes/light/lamp_light.h"

namespace earthshine::scenes {
namespace {

constexpr double altitude_m = 425e3;

Scene scene_with_earth(const Vec3& to_earth, EarthModel model) {
  Scene scene;
  Earth earth;
  earth.direction = glm::normalize(to_earth);
  earth.half_angle_deg = base::degrees(earth_half_angle_rad(altitude_m));
  earth.model = model;
  earth.radiance = Rgb(1.0);
  scene.earth = earth;
  return scene;
}

// Illuminance of a plate by midpoint quadrature over the Earth's disc; smooth inside, so that the
// error of 400 x 800 points is near 1e-5.
double plate_illuminance(const Scene& scene, const Vec3& plate_normal) {
  const double half_angle = base::radians(scene.earth->half_angle_deg);
  const int rings = 400, spokes = 800;
  double sum = 0.0;
  for (int i = 0; i < rings; ++i) {
    for (int k = 0; k < spokes; ++k) {
      const Vec3 d =
          sample_cone(scene.earth->direction, half_angle, (i + 0.5) / rings, (k + 0.5) / spokes);
      sum += earth_radiance(scene, d).g * std::max(0.0, glm::dot(d, plate_normal));
    }
  }
  return sum * cone_solid_angle_sr(half_angle) / (rings * spokes);
}

TEST(Sky, EarthFillsA69Point6DegreeConeAt425Km) {
  EXPECT_NEAR(base::degrees(earth_half_angle_rad(altitude_m)), 69.6, 0.05);
}

TEST(Sky, UniformEarthGivesANadirPlatePiLTimesTheViewFactor) {
  // E = pi L (R / (R + h))^2
  const Scene scene = scene_with_earth({0, 0, 1}, EarthModel::Uniform);
  const double view_factor = std::pow(std::sin(earth_half_angle_rad(altitude_m)), 2);
  EXPECT_NEAR(plate_illuminance(scene, {0, 0, 1}) / (base::pi * view_factor), 1.0, 2e-5);
}

TEST(Sky, LambertEarthMatchesTheTableOfTiltedPlates) {
  // E = albedo * E_sun * A(tilt, theta_s); A from independent integration at 425 km for a plate
  // that faces the nadir and for vertical plates toward the Sun, across and away (four printed
  // digits).
  struct Row {
    double theta_deg, nadir, sun_side, across, away;
  };
  const Row rows[] = {{0, 0.8749, 0.2807, 0.2807, 0.2807},  {30, 0.7577, 0.2552, 0.2431, 0.2310},
                      {60, 0.4375, 0.1613, 0.1404, 0.1194}, {80, 0.1524, 0.0726, 0.0489, 0.0260},
                      {90, 0.0212, 0.0242, 0.0077, 0.0000}, {100, 0.0005, 0.0011, 0.0002, 0.0000}};
  for (const Row& row : rows) {
    Scene scene = scene_with_earth({0, 0, 1}, EarthModel::Lambert);
    const double theta = base::radians(row.theta_deg);
    Sun sun;  // theta_s is measured at the Earth's centre between spacecraft and subsolar point
    sun.direction = Vec3(std::sin(theta), 0.0, -std::cos(theta));
    sun.illuminance_lx = Rgb(1.0);
    scene.sun = sun;
    scene.earth->albedo = Rgb(1.0);
    EXPECT_NEAR(plate_illuminance(scene, {0, 0, 1}), row.nadir, 1.5e-4) << row.theta_deg;
    EXPECT_NEAR(plate_illuminance(scene, {1, 0, 0}), row.sun_side, 1.5e-4) << row.theta_deg;
    EXPECT_NEAR(plate_illuminance(scene, {0, 1, 0}), row.across, 1.5e-4) << row.theta_deg;
    EXPECT_NEAR(plate_illuminance(scene, {-1, 0, 0}), row.away, 1.5e-4) << row.theta_deg;
  }
}

TEST(Sky, SunSetsBehindTheLimbOverItsOwnDiameter) {
  Scene scene = scene_with_earth({0, 0, 1}, EarthModel::Uniform);
  scene.sun = Sun{};
  const double limb = scene.earth->half_angle_deg;
  const auto share_at = [&](double over_limb_radii) {
    const double angle = base::radians(limb + over_limb_radii * scene.sun->angular_radius_deg);
    scene.sun->direction = Vec3(std::sin(angle), 0.0, std::cos(angle));
    return visible_sun_share(scene);
  };
  EXPECT_DOUBLE_EQ(share_at(1.01), 1.0);
  EXPECT_DOUBLE_EQ(share_at(-1.01), 0.0);
  // The segment beyond a chord of half length c in radii, and the curvature of the limb: a parabola
  // of height y^2 r cot(half angle) / 2 along c, c^3 r cot / (3 pi) of the disc. The next terms are
  // smaller by r, 5e-3. Beyond a chord at half the radius: 1/3 - sqrt(3)/(4 pi).
  const double bend = base::radians(scene.sun->angular_radius_deg) / std::tan(base::radians(limb)) /
                      (3.0 * base::pi);
  EXPECT_NEAR(share_at(0.0), 0.5 + bend, 5e-3 * bend);
  EXPECT_NEAR(share_at(-0.5),
              1.0 / 3.0 - std::sqrt(3.0) / (4.0 * base::pi) + std::pow(0.75, 1.5) * bend,
              5e-3 * bend);
}

TEST(Sky, SunsRadianceTimesItsDiscIsItsIlluminance) {
  const Sun sun;
  const double sine = std::sin(base::radians(sun.angular_radius_deg));
  EXPECT_NEAR(sun_radiance(sun).g * base::pi * sine * sine, 133100.0, 1e-6);
}

TEST(Sky, EarthIsDarkAtMidnightAndLitAtNoon) {
  Scene scene = scene_with_earth({0, 0, 1}, EarthModel::Lambert);
  scene.sun = Sun{};
  scene.sun->direction = Vec3(0, 0, 1);  // behind the Earth
  EXPECT_FALSE(earth_is_lit(scene));
  scene.sun->direction = Vec3(0, 0, -1);
  EXPECT_TRUE(earth_is_lit(scene));
  // The visible cap extends 20.4 deg from the nadir point: the last light vanishes at 110.4 deg.
  const auto at = [&](double deg) {
    const double theta = base::radians(deg);
    scene.sun->direction = Vec3(std::sin(theta), 0.0, -std::cos(theta));
    return earth_is_lit(scene);
  };
  EXPECT_TRUE(at(110.0));
  EXPECT_FALSE(at(111.0));
}

}  // namespace
}  // namespace earthshine::scenes
