// SPDX-License-Identifier: Apache-2.0
// The Earth's albedo by latitude.
#include <gtest/gtest.h>

#include <cmath>

#include "base/numbers/random.h"
#include "scenes/effects/light_groups.h"
#include "scenes/light/lamp_light.h"
#include "scenes/sky/sky.h"

namespace earthshine::scenes {
namespace {

using base::radians;

// At 425 km above the Earth, the Sun theta from the zenith.
Scene over_the_earth(double theta_deg) {
  Scene scene;
  scene.sun.emplace().direction =
      Vec3(std::sin(radians(theta_deg)), 0.0, -std::cos(radians(theta_deg)));
  Earth& earth = scene.earth.emplace();
  earth.altitude_m = 425e3;
  earth.half_angle_deg = base::degrees(earth_half_angle_rad(earth.altitude_m));
  earth.albedo = Rgb(1.0);
  return scene;
}

TEST(LatitudeAlbedo, IsKnockesPolynomialBetween0And1) {
  // P1(x) = x, P2(x) = (3 x^2 - 1) / 2: at the equator 0.34 - 0.145, at the poles 0.34 + 0.29 +-
  // a1; at sin^2 = 1/3 P2 vanishes.
  LatitudeAlbedo law;
  law.a1 = 0.1;
  EXPECT_NEAR(albedo_at(law, 0.0), 0.195, 1e-15);
  EXPECT_NEAR(albedo_at(law, 1.0), 0.73, 1e-15);
  EXPECT_NEAR(albedo_at(law, -1.0), 0.53, 1e-15);
  EXPECT_NEAR(albedo_at(law, -1.0 / std::sqrt(3.0)), 0.34 - 0.1 / std::sqrt(3.0), 1e-15);
  law.a0 = 0.95;
  EXPECT_EQ(albedo_at(law, 1.0), 1.0);
  law.a0 = 0.1;
  EXPECT_EQ(albedo_at(law, 0.0), 0.0);
}

TEST(LatitudeAlbedo, OverTheWholeSphereHasTheMeanA0) {
  // Area is proportional to sin(latitude), and Legendre's polynomials are orthogonal to 1.
  LatitudeAlbedo law;
  law.a1 = -0.076;
  double sum = 0.0;
  constexpr int count = 20000;
  for (int k = 0; k < count; ++k) sum += albedo_at(law, 2.0 * (k + 0.5) / count - 1.0);
  EXPECT_NEAR(sum / count, 0.34, 1e-8);
}

TEST(LatitudeAlbedo, LargestIsTheMostOfAllLatitudes) {
  for (const double a0 : {0.0, 0.05, 0.34, 0.9}) {
    for (const double a1 : {-0.3, 0.0, 0.1, 0.9}) {
      for (const double a2 : {-0.5, -0.02, 0.0, 0.29}) {
        const LatitudeAlbedo law{a0, a1, a2, Vec3(0, 0, 1)};
        double most = 0.0;
        for (int k = -5000; k <= 5000; ++k) most = std::max(most, albedo_at(law, k / 5000.0));
        EXPECT_NEAR(largest_albedo(law), most, 1e-7) << a0 << " " << a1 << " " << a2;
      }
    }
  }
}

TEST(LatitudeAlbedo, DimsEveryPlaceByItsLatitude) {
  // The ground point is found by marching along the direction; its latitude is the angle from the
  // equator. The radiance with mean albedo 1 times the law is the expected radiance.
  Scene by_latitude = over_the_earth(40.0);
  const Scene mean = by_latitude;
  LatitudeAlbedo& law = by_latitude.earth->by_latitude.emplace();
  law.a1 = 0.1;
  law.north = glm::normalize(Vec3(0.3, 0.8, -0.4));
  base::Rng rng(base::Key(1, base::Stream::Test, 7));
  const double a = base::earth_radius_m + 425e3;
  const Vec3 middle = Vec3(0, 0, 1) * a;
  for (int n = 0; n < 200; ++n) {
    const double u = rng.next(), v = rng.next();
    const Vec3 direction =
        sample_cone(Vec3(0, 0, 1), radians(by_latitude.earth->half_angle_deg - 0.01), u, v);
    double above = 0.0, nearest = glm::dot(middle, direction);
    for (int step = 0; step < 60; ++step) {
      const double t = 0.5 * (above + nearest);
      (glm::length(direction * t - middle) > base::earth_radius_m ? above : nearest) = t;
    }
    const double latitude =
        base::pi / 2 - std::acos(glm::dot(glm::normalize(direction * above - middle), law.north));
    const double x = std::sin(latitude);
    const double wanted = 0.34 + 0.1 * x + 0.29 * (1.5 * x * x - 0.5);
    EXPECT_NEAR(earth_radiance(by_latitude, direction).g,
                earth_radiance(mean, direction).g * wanted,
                1e-6 * earth_radiance(mean, direction).g);
  }
}

TEST(LatitudeAlbedo, AloneA0IsTheMeanAlbedo) {
  Scene mean = over_the_earth(70.0), law = mean;
  mean.earth->albedo = 0.3 * Rgb(1.0, 0.5, 0.2);
  law.earth->albedo = Rgb(1.0, 0.5, 0.2);
  law.earth->by_latitude = LatitudeAlbedo{0.3, 0.0, 0.0, Vec3(0, 1, 0)};
  for (const double x : {-0.8, 0.0, 0.5, 0.9}) {
    const Vec3 direction = glm::normalize(Vec3(x, 0.1, 1.0));
    const Rgb found = earth_radiance(law, direction), wanted = earth_radiance(mean, direction);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], wanted[c], 1e-12 * wanted[c] + 1e-15);
  }
}

TEST(LatitudeAlbedo, OfNoLatitudeLeavesTheEarthDark) {
  Scene scene = over_the_earth(0.0);
  EXPECT_TRUE(earth_is_lit(scene));
  scene.earth->by_latitude = LatitudeAlbedo{0.0, 0.0, 0.0, Vec3(0, 1, 0)};
  EXPECT_FALSE(earth_is_lit(scene));
  EXPECT_EQ(find_light_groups(scene).earth, no_group);
  scene.earth->by_latitude->a2 = 0.1;  // lit beyond 35 deg of latitude
  EXPECT_TRUE(earth_is_lit(scene));
  scene.earth->albedo = Rgb(0.0);
  EXPECT_FALSE(earth_is_lit(scene));
}

}  // namespace
}  // namespace earthshine::scenes
