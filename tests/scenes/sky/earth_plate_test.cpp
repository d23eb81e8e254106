// SPDX-License-Identifier: Apache-2.0
// Illuminance of open plates at any tilt from the Earth and the Sun, against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "base/numbers/random.h"
#include "scenes/light/lamp_light.h"
#include "scenes/sky/sky.h"

namespace earthshine::scenes {
namespace {

using base::pi;

Scene over_the_earth(double altitude_m, EarthModel model) {
  Scene scene;
  Earth earth;
  earth.direction = Vec3(0, 0, 1);
  earth.half_angle_deg = base::degrees(earth_half_angle_rad(altitude_m));
  earth.model = model;
  earth.radiance = Rgb(1.0);
  earth.albedo = Rgb(1.0);
  scene.earth = earth;
  return scene;
}

// Places the Sun at theta from the spacecraft's zenith, at the Earth's centre.
void put_sun(Scene& scene, double theta_deg) {
  const double theta = base::radians(theta_deg);
  Sun sun;
  sun.direction = Vec3(std::sin(theta), 0.0, -std::cos(theta));
  sun.illuminance_lx = Rgb(1.0);
  scene.sun = sun;
}

// Midpoint rule over the disc, 400 x 800 points.
double illuminance(const Scene& scene, const Vec3& normal) {
  const double half_angle = base::radians(scene.earth->half_angle_deg);
  const int rings = 400, spokes = 800;
  double sum = 0.0;
  for (int i = 0; i < rings; ++i) {
    for (int k = 0; k < spokes; ++k) {
      const Vec3 d =
          sample_cone(scene.earth->direction, half_angle, (i + 0.5) / rings, (k + 0.5) / spokes);
      const double cosine = glm::dot(d, normal);
      if (cosine > 0.0) sum += earth_radiance(scene, d).g * cosine;
    }
  }
  return sum * cone_solid_angle_sr(half_angle) / (rings * spokes);
}

// View factor of a plate to a sphere of radius 1 at distance H, L between the plate's normal and
// the centre (Thornton, Thermal Structures; Howell B-43).
double view_factor(double distance, double tilt_rad) {
  const double h = distance, s = std::sqrt(h * h - 1.0), cosine = std::cos(tilt_rad);
  const double whole = std::acos(1.0 / h);
  if (tilt_rad <= whole) return cosine / (h * h);
  if (tilt_rad >= pi - whole) return 0.0;
  return 0.5 - std::asin(s / (h * std::sin(tilt_rad))) / pi +
         (cosine * std::acos(-s / std::tan(tilt_rad)) -
          s * std::sqrt(1.0 - h * h * cosine * cosine)) /
             (pi * h * h);
}

TEST(EarthPlate, TiltedPlatesSeeTheUniformDiscByTheClosedForm) {
  // E = pi L F. The printed table of F (three digits) verifies the closed form.
  struct Row {
    double altitude_km;
    double printed[7];
  };
  const Row rows[] = {{296.0, {0.913, 0.799, 0.567, 0.315, 0.111, 0.008, 0.0}},
                      {425.0, {0.879, 0.765, 0.530, 0.283, 0.091, 0.004, 0.0}}};
  for (const Row& row : rows) {
    const Scene scene = over_the_earth(row.altitude_km * 1e3, EarthModel::Uniform);
    for (int k = 0; k < 7; ++k) {
      const double tilt = base::radians(30.0 * k);
      const double exact = view_factor((6371.0 + row.altitude_km) / 6371.0, tilt);
      EXPECT_NEAR(exact, row.printed[k], 5.1e-4) << 30 * k;
      // Where the plate's horizon cuts the disc the midpoint rule has a lower order.
      EXPECT_NEAR(illuminance(scene, Vec3(std::sin(tilt), 0.0, std::cos(tilt))) / pi, exact, 3e-5)
          << row.altitude_km << " km, " << 30 * k << " deg";
    }
  }
}

TEST(EarthPlate, LambertEarthFollowsItsPhaseAt296And425Km) {
  // A of E = albedo E_sun A for plates that face the nadir, from independent integration (four
  // printed digits); at 425 km and 110 deg it is 0 to four digits.
  const double theta[] = {0, 30, 60, 80, 90, 100, 110};
  const double low[] = {0.9109, 0.7888, 0.4554, 0.1583, 0.0162, 0.0001, 0.0};
  const double high[] = {0.8749, 0.7577, 0.4375, 0.1524, 0.0212, 0.0005, 0.0};
  for (int k = 0; k < 7; ++k) {
    for (const bool is_low : {true, false}) {
      Scene scene = over_the_earth(is_low ? 296e3 : 425e3, EarthModel::Lambert);
      put_sun(scene, theta[k]);
      EXPECT_NEAR(illuminance(scene, Vec3(0, 0, 1)), (is_low ? low : high)[k], 1e-4) << theta[k];
    }
  }
}

TEST(EarthPlate, TurningThePlateRoundTheNadirMixesSunSideAndAway) {
  // Vertical plates at azimuth psi from the Sun, for a disc cut only by its own horizon: E(psi) +
  // E(psi + 180 deg) = 2 E(90 deg). At the full Earth (theta = 0) all azimuths are equal.
  Scene scene = over_the_earth(425e3, EarthModel::Lambert);
  put_sun(scene, 0.0);
  const double across = illuminance(scene, Vec3(0, 1, 0));
  for (const double psi : {0.0, 0.7, 2.0}) {
    EXPECT_NEAR(illuminance(scene, Vec3(std::cos(psi), std::sin(psi), 0.0)), across, 3e-5);
  }
  EXPECT_NEAR(across, 0.2807, 1e-4);
}

TEST(EarthPlate, SunSamplesGiveAPlateItsIlluminanceByTheCosineLaw) {
  // E cos(tilt) for any size of the disc if all of it is above the plate's horizon: mean of
  // independent samples within four standard errors.
  Scene scene;
  for (const double radius : {0.2666, 20.0}) {
    scene.sun = Sun{};
    scene.sun->angular_radius_deg = radius;
    base::Rng rng(base::Key(1, base::Stream::Test, 95));
    const double tilt = base::radians(50.0);
    const Vec3 normal(std::sin(tilt), 0.0, std::cos(tilt));
    const double each = sun_sample_illuminance(scene).g;
    double sum = 0.0, squares = 0.0;
    const int count = 20000;
    for (int n = 0; n < count; ++n) {
      const double u = rng.next(), v = rng.next();
      const double e =
          each * glm::dot(sample_cone(scene.sun->direction, base::radians(radius), u, v), normal);
      sum += e / count;
      squares += e * e / count;
    }
    const double std_error = std::sqrt(std::max(0.0, squares - sum * sum) / count);
    EXPECT_NEAR(sum, 133100.0 * std::cos(tilt), 4.0 * std_error) << radius;
  }
}

}  // namespace
}  // namespace earthshine::scenes
