// SPDX-License-Identifier: Apache-2.0
#include "scenes/sky/orbit.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "tests/scenes/equatorial_orbit.h"

namespace earthshine::scenes {
namespace {

using test::EquatorialOrbit;
using test::some_orbits;

constexpr double low_orbit_m = 425e3;
constexpr double positions_deg[] = {-200.0, -90.0, -17.0, 0.0,   33.0,
                                    90.0,   141.0, 180.0, 265.0, 400.0};

void expect_near(const Vec3& found, const Vec3& wanted, const std::string& what) {
  EXPECT_LT(glm::length(found - wanted), 1e-9)
      << what << ": " << found.x << " " << found.y << " " << found.z << " for " << wanted.x << " "
      << wanted.y << " " << wanted.z;
}

OrbitState named_state(double beta_deg, double position_deg, std::string_view attitude) {
  Orbit orbit;
  orbit.altitude_m = low_orbit_m;
  orbit.beta_deg = beta_deg;
  orbit.attitude = attitude;
  return orbit_state(orbit, position_deg);
}

TEST(Orbit, BayToEarthAtNoonHasTheSunBehindTheBellyAndTheEarthOverTheBay) {
  const OrbitState d = named_state(0.0, 0.0, "bay-to-earth");
  EXPECT_NEAR(glm::length(d.earth - Vec3(0, 0, 1)), 0.0, 1e-15);
  EXPECT_NEAR(glm::length(d.sun - Vec3(0, 0, -1)), 0.0, 1e-15);
}

TEST(Orbit, EveryAttitudeKeepsTheAngleBetweenSunAndEarth) {
  // cos(angle from zenith to Sun) = cos(beta) cos(position), for any attitude.
  for (const std::string_view attitude : orbit_attitudes) {
    for (const double position : {0.0, 35.0, 90.0, 200.0}) {
      const OrbitState d = named_state(20.0, position, attitude);
      EXPECT_NEAR(-glm::dot(d.sun, d.earth),
                  std::cos(base::radians(20.0)) * std::cos(base::radians(position)), 1e-12)
          << attitude << " " << position;
      EXPECT_NEAR(glm::length(d.sun), 1.0, 1e-12);
    }
  }
}

TEST(Orbit, NoseForwardPutsTheMorningSunAheadOfNoonAndTheEveningSunBehind) {
  // After noon the Sun sinks opposite to the motion: with the nose forward that is aft, +x.
  EXPECT_GT(named_state(0.0, 45.0, "bay-to-space").sun.x, 0.5);
  EXPECT_LT(named_state(0.0, -45.0, "bay-to-space").sun.x, -0.5);
  EXPECT_GT(named_state(0.0, 45.0, "bay-to-earth").sun.x, 0.5);
}

TEST(Orbit, BayToSunPointsTheBayAtTheSun) {
  const OrbitState d = named_state(20.0, 70.0, "bay-to-sun");
  EXPECT_NEAR(glm::length(d.sun - Vec3(0, 0, 1)), 0.0, 1e-12);
}

TEST(Orbit, TailDownHasTheEarthAft) {
  const OrbitState d = named_state(0.0, 0.0, "tail-down");
  EXPECT_NEAR(glm::length(d.earth - Vec3(1, 0, 0)), 0.0, 1e-12);
}

TEST(Orbit, SunEarthAndPoleAreWhereTheEquatorialFrameHasThem) {
  for (const EquatorialOrbit& sky : some_orbits) {
    for (const std::string_view attitude : orbit_attitudes) {
      const Orbit orbit = sky.as_scene_orbit(low_orbit_m, attitude);
      for (const double position : positions_deg) {
        const double u = sky.noon_argument_deg() + position;
        const EquatorialOrbit::Pose pose = sky.pose(attitude, u);
        const OrbitState state = orbit_state(orbit, position);
        const std::string what = std::string(attitude) + " at " + std::to_string(position);
        expect_near(state.sun, pose.in_body(sky.sun()), what + ", Sun");
        expect_near(state.earth, pose.in_body(-sky.position(u)), what + ", Earth");
        expect_near(state.north, pose.in_body({0, 0, 1}), what + ", pole");
        EXPECT_NEAR(state.latitude_deg, 90.0 - base::degrees(std::acos(sky.position(u).z)), 1e-6);
      }
    }
  }
}

TEST(Orbit, AnInertialAttitudeIsThePoseOfItsMomentKeptInSpace) {
  for (const EquatorialOrbit& sky : some_orbits) {
    for (const std::string_view as : orbit_attitudes) {
      for (const double at : {0.0, -70.0, 200.0}) {
        Orbit orbit = sky.as_scene_orbit(low_orbit_m, inertial_attitude);
        orbit.inertial_as = as;
        orbit.inertial_at_deg = at;
        const double noon = sky.noon_argument_deg();
        const EquatorialOrbit::Pose pose = sky.pose(as, noon + at);
        for (const double position : positions_deg) {
          const OrbitState state = orbit_state(orbit, position);
          const std::string what = std::string(as) + " of " + std::to_string(at);
          expect_near(state.sun, pose.in_body(sky.sun()), what + ", Sun");
          expect_near(state.earth, pose.in_body(-sky.position(noon + position)), what + ", Earth");
          expect_near(state.north, pose.in_body({0, 0, 1}), what + ", pole");
        }
      }
    }
  }
}

TEST(Orbit, ThePeriodIsOneSiderealDayAtTheGeostationaryRadius) {
  // a = 42164.17 km, one revolution of the Earth in 86164.09 s.
  EXPECT_NEAR(orbit_period_s(42164.17e3 - base::earth_radius_m), 86164.09, 0.1);
  // Time is proportional to the position, 360 deg in a period.
  Orbit orbit;
  orbit.altitude_m = low_orbit_m;
  EXPECT_NEAR(orbit_state(orbit, -90.0).time_s, -orbit_period_s(low_orbit_m) / 4.0, 1e-9);
  EXPECT_NEAR(orbit_period_s(low_orbit_m), 92.9 * 60.0, 3.0);  // 3.87 deg a minute
}

TEST(Orbit, LatitudeNeverExceedsTheInclination) {
  Orbit orbit;
  orbit.altitude_m = low_orbit_m;
  orbit.inclination_deg = 28.5;
  orbit.noon_argument_deg = 30.0;
  EXPECT_NEAR(orbit_state(orbit, 60.0).latitude_deg, 28.5, 1e-6);
  EXPECT_NEAR(orbit_state(orbit, 240.0).latitude_deg, -28.5, 1e-6);
  EXPECT_NEAR(orbit_state(orbit, 150.0).latitude_deg, 0.0, 1e-9);
  EXPECT_GT(orbit_state(orbit, -29.0).latitude_deg, 0.0);  // northward through the node at -30
  EXPECT_LT(orbit_state(orbit, -31.0).latitude_deg, 0.0);
}

TEST(Orbit, MovingASceneSetsSunEarthAndPole) {
  Scene scene;
  scene.sun.emplace();
  scene.earth.emplace().by_latitude.emplace();
  EXPECT_THROW(move_along_orbit(scene, 10.0), base::Error);
  scene.orbit = test::sts46_like.as_scene_orbit(low_orbit_m, "tail-down");
  move_along_orbit(scene, 123.0);
  const OrbitState state = orbit_state(*scene.orbit, 123.0);
  EXPECT_EQ(scene.sun->direction, state.sun);
  EXPECT_EQ(scene.earth->direction, state.earth);
  EXPECT_EQ(scene.earth->by_latitude->north, state.north);
  EXPECT_EQ(scene.orbit->position_deg, 123.0);
}

}  // namespace
}  // namespace earthshine::scenes
