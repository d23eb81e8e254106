// SPDX-License-Identifier: Apache-2.0
// The Sun's disc behind the Earth's, against sums over rings and sampled directions.
#include "scenes/sky/two_discs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/numbers/random.h"
#include "scenes/light/lamp_light.h"
#include "scenes/sky/sky.h"

namespace earthshine::scenes {
namespace {

using base::pi;

// For a ring at angle theta about the centre of a: the half arc within b, by the law of cosines.
double shared_by_rings(double a, double b, double separation) {
  constexpr int rings = 200'000;
  double sum = 0.0;
  for (int k = 0; k < rings; ++k) {
    const double theta = a * (k + 0.5) / rings;
    const double cosine = (std::cos(b) - std::cos(theta) * std::cos(separation)) /
                          (std::sin(theta) * std::sin(separation));
    sum += 2.0 * std::acos(std::clamp(cosine, -1.0, 1.0)) * std::sin(theta) * a / rings;
  }
  return sum;
}

Scene eclipse(double sun_deg, double earth_deg, double separation_deg) {
  Scene scene;
  scene.sun.emplace().direction = Vec3(0.0, 0.0, 1.0);
  scene.sun->angular_radius_deg = sun_deg;
  const double s = base::radians(separation_deg);
  scene.earth.emplace().direction = Vec3(std::sin(s), 0.0, std::cos(s));
  scene.earth->half_angle_deg = earth_deg;
  return scene;
}

TEST(TwoDiscs, ShareWhatTheirRingsAddUpTo) {
  // A ring ends at a rim as a square root: the error of the midpoint rule is its width^1.5, 1e-8.
  struct Row {
    double a_deg, b_deg, separation_deg;
  };
  for (const Row& row : {Row{0.2666, 69.6, 69.6}, Row{0.2666, 69.6, 69.75}, Row{20.0, 69.6, 75.0},
                         Row{0.2666, 0.36, 0.4}, Row{10.0, 80.0, 85.0}, Row{30.0, 5.0, 28.0}}) {
    const double a = base::radians(row.a_deg), b = base::radians(row.b_deg);
    const double separation = base::radians(row.separation_deg);
    const double shared = shared_solid_angle(a, b, separation);
    EXPECT_NEAR(shared / shared_by_rings(a, b, separation), 1.0, 1e-6) << row.separation_deg;
    EXPECT_NEAR(shared_solid_angle(b, a, separation) / shared, 1.0, 1e-9);
  }
}

TEST(TwoDiscs, AHalfSphereWithItsRimThroughACentreSharesHalf) {
  for (const double radius : {1e-5, 0.1, 1.0}) {
    const double half = std::sin(0.5 * radius);
    EXPECT_NEAR(shared_solid_angle(radius, 0.5 * pi, 0.5 * pi) / (2.0 * pi * half * half), 1.0,
                1e-9);
    EXPECT_NEAR(covered_half_arc(radius, 0.5 * pi, 0.5 * pi), 0.5 * pi, 1e-9);
  }
}

TEST(TwoDiscs, OneWithinTheOtherIsSharedWhole) {
  EXPECT_NEAR(shared_solid_angle(0.2, 0.5, 0.1), 2.0 * pi * (1.0 - std::cos(0.2)), 1e-14);
  EXPECT_EQ(covered_half_arc(0.2, 0.5, 0.1), pi);
  EXPECT_EQ(covered_half_arc(0.5, 0.2, 0.1), 0.0);
  EXPECT_EQ(shared_solid_angle(0.2, 0.5, 0.7), 0.0);
}

TEST(TwoDiscs, ASunAroundTheEarthKeepsItsRing) {
  // 1 - (1 - cos 0.1 deg) / (1 - cos 0.2666 deg), also if the centres coincide and the direction
  // between them is undefined.
  const Scene scene = eclipse(0.2666, 0.1, 0.0);
  const double all = 1.0 - std::cos(base::radians(0.2666));
  EXPECT_NEAR(visible_sun_share(scene), 1.0 - (1.0 - std::cos(base::radians(0.1))) / all, 1e-9);
  for (const double u : {0.0, 0.3, 0.999}) {
    const Vec3 direction = SunDirections(scene)(u, u);
    EXPECT_NEAR(glm::length(direction), 1.0, 1e-12);
    EXPECT_LT(direction.z, std::cos(base::radians(0.0999)));
  }
}

TEST(TwoDiscs, DirectionsAreSpreadOverWhatTheEarthLeaves) {
  // SunDirections samples like uniform directions on the whole Sun that miss the Earth. The shares
  // below a plane through the Sun's middle and within 0.7 of its radius agree within four standard
  // errors of 40 000 draws, and so does the share of misses.
  constexpr int draws = 40'000;
  for (const Scene& scene :
       {eclipse(0.2666, 69.6, 69.7), eclipse(20.0, 60.0, 65.0), eclipse(10.0, 4.0, 5.0)}) {
    base::Rng rng(base::Key(7, base::Stream::Test, 51));
    const double radius = base::radians(scene.sun->angular_radius_deg);
    const Vec3 slant = glm::normalize(Vec3(1.0, 0.5, 0.0));
    const auto below = [&](const Vec3& direction) { return glm::dot(direction, slant) < 0.0; };
    const auto inner = [&](const Vec3& direction) { return direction.z > std::cos(0.7 * radius); };
    const SunDirections sun(scene);
    double missed = 0.0, missed_below = 0.0, missed_inner = 0.0, drawn_below = 0.0,
           drawn_inner = 0.0;
    for (int k = 0; k < draws; ++k) {
      const Vec3 any = sample_cone(scene.sun->direction, radius, rng.next(), rng.next());
      if (glm::dot(any, scene.earth->direction) <
          std::cos(base::radians(scene.earth->half_angle_deg))) {
        missed += 1.0;
        missed_below += below(any) ? 1.0 : 0.0;
        missed_inner += inner(any) ? 1.0 : 0.0;
      }
      const Vec3 left = sun(rng.next(), rng.next());
      EXPECT_LT(glm::dot(left, scene.earth->direction),
                std::cos(base::radians(scene.earth->half_angle_deg)) + 1e-12);
      drawn_below += below(left) ? 1.0 : 0.0;
      drawn_inner += inner(left) ? 1.0 : 0.0;
    }
    const double share = visible_sun_share(scene);
    EXPECT_NEAR(missed / draws, share, 4.0 * std::sqrt(share * (1.0 - share) / draws));
    const auto alike = [&](double of_missed, double of_drawn) {
      const double p = of_missed / missed, q = of_drawn / draws;
      EXPECT_NEAR(p, q, 4.0 * std::sqrt(p * (1.0 - p) / missed + q * (1.0 - q) / draws));
    };
    alike(missed_below, drawn_below);
    alike(missed_inner, drawn_inner);
  }
}

}  // namespace
}  // namespace earthshine::scenes
