// SPDX-License-Identifier: Apache-2.0
// Passage through the Earth's shadow: closed forms of shadow cylinder and cones, and the visible
// share of the Sun that the light uses.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "scenes/sky/orbit.h"
#include "scenes/sky/sky.h"

namespace earthshine::scenes {
namespace {

constexpr double earth_m = base::earth_radius_m;
constexpr double sun_deg = 0.2666;

Orbit orbit_of(double altitude_km, double beta_deg) {
  Orbit orbit;
  orbit.altitude_m = altitude_km * 1e3;
  orbit.beta_deg = beta_deg;
  return orbit;
}

// The position between low, where the condition is false, and high, where it is true.
double where_it_begins(double low, double high, const std::function<bool(double)>& holds) {
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    (holds(middle) ? high : low) = middle;
  }
  return high;
}

TEST(Eclipse, OfAPointSunIsTheShadowCylinder) {
  // Behind the Earth's middle and nearer than R to the axis of the shadow:
  // cos eta = sqrt(h^2 + 2 R h) / ((R + h) cos beta).
  for (const double altitude_km : {200.0, 425.0, 1500.0, 20000.0}) {
    for (const double beta_deg : {0.0, 12.5, -40.0}) {
      const double h = altitude_km * 1e3;
      const double cosine = std::sqrt(h * h + 2.0 * earth_m * h) /
                            ((earth_m + h) * std::cos(base::radians(beta_deg)));
      const Eclipse found = find_eclipse(orbit_of(altitude_km, beta_deg), 0.0);
      if (cosine >= 1.0) {
        EXPECT_FALSE(found.penumbra || found.umbra) << altitude_km << " " << beta_deg;
        continue;
      }
      const double eta = base::degrees(std::acos(cosine));
      for (const auto& span : {found.penumbra, found.umbra}) {
        ASSERT_TRUE(span);
        EXPECT_NEAR(span->begin_deg, 180.0 - eta, 1e-9);
        EXPECT_NEAR(span->end_deg, 180.0 + eta, 1e-9);
      }
    }
  }
}

TEST(Eclipse, Takes387ThousandthsOfALowOrbitAt425Km) {
  const Eclipse found = find_eclipse(orbit_of(425.0, 0.0), 0.0);
  EXPECT_NEAR((found.umbra->end_deg - found.umbra->begin_deg) / 360.0, 0.387, 5e-4);
  const double period_s = orbit_period_s(425e3);
  EXPECT_NEAR((found.umbra->end_s - found.umbra->begin_s) / period_s, 0.387, 5e-4);
  EXPECT_NEAR(found.umbra->begin_s / period_s, found.umbra->begin_deg / 360.0, 1e-12);
  // The Sun's disc sets in some 8 s: 2 x 0.2666 deg at 3.87 deg a minute.
  const Eclipse wide = find_eclipse(orbit_of(425.0, 0.0), sun_deg);
  EXPECT_NEAR(wide.umbra->begin_s - wide.penumbra->begin_s, 2.0 * sun_deg / 3.87 * 60.0, 0.05);
}

TEST(Eclipse, OfTheSunsDiscIsBoundedByTheShadowCones) {
  // Planes tangent to the Earth and inclined by the Sun's radius r: at the distance x behind the
  // Earth's middle the umbra has the radius R / cos r - x tan r, the penumbra R / cos r + x tan r.
  // The spacecraft is at x = -a cos beta cos phi, sqrt(a^2 - x^2) from the axis.
  const double r = base::radians(sun_deg);
  for (const double altitude_km : {200.0, 425.0, 1500.0, 35786.0}) {
    for (const double beta_deg : {0.0, 6.0, -15.0, 55.0}) {
      const Orbit orbit = orbit_of(altitude_km, beta_deg);
      const double a = earth_m + orbit.altitude_m;
      const auto inside = [&](double phi_deg, double sign) {
        const double x = -a * std::cos(base::radians(beta_deg)) * std::cos(base::radians(phi_deg));
        return x > 0.0 && std::sqrt(a * a - x * x) < earth_m / std::cos(r) + sign * x * std::tan(r);
      };
      const Eclipse found = find_eclipse(orbit, sun_deg);
      ASSERT_EQ(found.penumbra.has_value(), inside(180.0, 1.0)) << altitude_km << " " << beta_deg;
      ASSERT_EQ(found.umbra.has_value(), inside(180.0, -1.0)) << altitude_km << " " << beta_deg;
      if (!found.umbra) continue;
      EXPECT_NEAR(found.penumbra->begin_deg,
                  where_it_begins(0.0, 180.0, [&](double p) { return inside(p, 1.0); }), 1e-8);
      EXPECT_NEAR(found.umbra->begin_deg,
                  where_it_begins(0.0, 180.0, [&](double p) { return inside(p, -1.0); }), 1e-8);
      EXPECT_NEAR(found.umbra->end_deg,
                  where_it_begins(360.0, 180.0, [&](double p) { return inside(p, -1.0); }), 1e-8);
    }
  }
}

TEST(Eclipse, IsWhereTheLightOfTheSunFades) {
  Scene scene;
  scene.sun.emplace();
  Earth& earth = scene.earth.emplace();
  earth.altitude_m = 425e3;
  earth.half_angle_deg = base::degrees(earth_half_angle_rad(earth.altitude_m));
  scene.orbit = orbit_of(425.0, 30.0);
  const auto share = [&](double position) {
    move_along_orbit(scene, position);
    return visible_sun_share(scene);
  };
  const Eclipse found = find_eclipse(*scene.orbit, scene.sun->angular_radius_deg);
  EXPECT_NEAR(where_it_begins(0, 180, [&](double p) { return share(p) < 1.0; }),
              found.penumbra->begin_deg, 1e-6);
  EXPECT_NEAR(where_it_begins(0, 180, [&](double p) { return share(p) <= 0.0; }),
              found.umbra->begin_deg, 1e-6);
  EXPECT_NEAR(where_it_begins(360, 180, [&](double p) { return share(p) <= 0.0; }),
              found.umbra->end_deg, 1e-6);
  EXPECT_NEAR(where_it_begins(360, 180, [&](double p) { return share(p) < 1.0; }),
              found.penumbra->end_deg, 1e-6);
}

TEST(Eclipse, EndsWhereTheSunStandsTooHighOverTheOrbit) {
  // At midnight the Sun is beta from the Earth's middle; the limb is 69.62 deg from it.
  const double limb_deg = base::degrees(earth_half_angle_rad(425e3));
  const Eclipse grazing = find_eclipse(orbit_of(425.0, limb_deg), sun_deg);
  EXPECT_TRUE(grazing.penumbra);
  EXPECT_FALSE(grazing.umbra);
  EXPECT_TRUE(find_eclipse(orbit_of(425.0, limb_deg - 0.28), sun_deg).umbra);
  EXPECT_FALSE(find_eclipse(orbit_of(425.0, limb_deg + 0.28), sun_deg).penumbra);
  for (const double beta_deg : {75.0, -90.0, 90.0}) {
    const Eclipse none = find_eclipse(orbit_of(425.0, beta_deg), sun_deg);
    EXPECT_FALSE(none.penumbra || none.umbra) << beta_deg;
  }
}

TEST(Eclipse, LastsAllTheOrbitOrIsNeverWholeWhereTheDiscsAreSo) {
  // At 10 m the limb is 0.1 deg below the horizontal: always above the terminator, the Sun's disc
  // of 0.2666 deg never clears the limb.
  const Eclipse dusk = find_eclipse(orbit_of(0.01, 90.0), sun_deg);
  ASSERT_TRUE(dusk.penumbra);
  EXPECT_EQ(dusk.penumbra->begin_deg, 0.0);
  EXPECT_EQ(dusk.penumbra->end_deg, 360.0);
  EXPECT_FALSE(dusk.umbra);
  // From 10^6 km the Earth's disc, 0.36 deg, still hides the Sun's, but not a disc of 0.5 deg.
  EXPECT_TRUE(find_eclipse(orbit_of(1e6, 0.0), sun_deg).umbra);
  EXPECT_FALSE(find_eclipse(orbit_of(1e6, 0.0), 0.5).umbra);
  EXPECT_TRUE(find_eclipse(orbit_of(1e6, 0.0), 0.5).penumbra);
}

}  // namespace
}  // namespace earthshine::scenes
