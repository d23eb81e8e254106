// SPDX-License-Identifier: Apache-2.0
// Trajectory and attitude as functions of time in scenes.
#include "scenes/time/mission.h"

#include <cmath>

#include "scenes/sky/sky.h"
#include "tests/scenes/scene_text.h"
#include "tests/scenes/time/oem_text.h"

namespace earthshine::scenes {
namespace {

using test::Ellipse;
using test::holds;
using test::oem_of;
using test::oem_row;

const Instant epoch = *read_instant("2026-03-01T12:00:00", TimeSystem::Utc);

constexpr const char* mission_scene =
    "format = 1\n[time]\nstart = \"2026-03-01T12:00:00\"\nstop = \"2026-060T15:00:00\"\nstep = "
    "600\n"
    "[orbit]\ntrajectory = \"t.oem\"\n";

class MissionScene : public ::testing::Test {
 protected:
  MissionScene() { folder.put("t.oem", oem_of(circle, epoch, 60.0, 200)); }
  Scene read(const std::string& more = "") { return folder.read(mission_scene + more); }
  Ellipse circle;
  test::SceneFolder folder;
};

// Sun, orbital plane and position from the test's own vectors.
struct Sky {
  double beta, position;  // rad
};
Sky sky_of(const Ellipse& circle, double s) {
  const State state = circle.at(s);
  const Vec3 r = glm::normalize(state.position_m);
  const Vec3 n = glm::normalize(glm::cross(state.position_m, state.velocity_m_s));
  const Vec3 sun = sun_direction(epoch + s);
  return {std::asin(glm::dot(sun, n)),
          std::atan2(-glm::dot(sun, glm::cross(n, r)), glm::dot(sun, r))};
}

// Closed form of a circular orbit: the Sun's disc of radius rho touches the Earth's, of half angle
// h, at pi -+ acos(cos(h + rho) / cos beta) from orbit noon, and disappears with h - rho. In half a
// revolution the Sun moves by 0.6 s of orbital motion, so that the position at the time itself
// counts.
TEST_F(MissionScene, EclipsesOfACircleAreWhereTheClosedFormHasThem) {
  const Scene scene = read("earth_shape = \"sphere\"\n");
  const Mission& mission = *mission_of(scene);
  const double rho = base::radians(scene.sun->angular_radius_deg);
  const double h = std::asin(base::earth_radius_m / circle.semi_major_m);
  const double period = 2.0 * base::pi / circle.mean_motion_rad_s();
  const auto eclipses = eclipses_between(mission, mission.time.start, mission.time.stop,
                                         scene.sun->angular_radius_deg);
  ASSERT_EQ(eclipses.size(), 2U);
  const auto check = [&](std::optional<Instant> found, double limit, double side) {
    ASSERT_TRUE(found);
    const double s = *found - epoch;
    const Sky sky = sky_of(circle, s);
    const double eta = std::acos(std::cos(limit) / std::cos(sky.beta));
    const double off = std::remainder(sky.position - (base::pi + side * eta), 2.0 * base::pi);
    EXPECT_NEAR(off / circle.mean_motion_rad_s(), 0.0, 1.0);
  };
  for (const EclipseTimes& eclipse : eclipses) {
    check(eclipse.penumbra_begin, h + rho, -1.0);
    check(eclipse.umbra_begin, h - rho, -1.0);
    check(eclipse.umbra_end, h - rho, 1.0);
    check(eclipse.penumbra_end, h + rho, 1.0);
  }
  // In one revolution the Sun moves 0.065 deg, 1 s of orbital motion.
  EXPECT_NEAR(*eclipses[1].umbra_begin - *eclipses[0].umbra_begin, period + 1.0, 0.5);
}

// The Sun's visible share in a scene moved to those times agrees with them.
TEST_F(MissionScene, TheScenesOwnSunGoesOutAtThoseTimes) {
  Scene scene = read();
  const Mission mission = *mission_of(scene);
  const EclipseTimes eclipse = eclipses_between(mission, mission.time.start, mission.time.stop,
                                                scene.sun->angular_radius_deg)[0];
  const auto share_at = [&](Instant t) {
    move_to_moment(scene, t);
    return visible_sun_share(scene);
  };
  EXPECT_EQ(share_at(*eclipse.penumbra_begin + -0.1), 1.0);
  EXPECT_LT(share_at(*eclipse.penumbra_begin + 0.5), 1.0);
  EXPECT_GT(share_at(*eclipse.umbra_begin + -0.5), 0.0);
  EXPECT_EQ(share_at(*eclipse.umbra_begin + 0.1), 0.0);
  EXPECT_GT(share_at(*eclipse.umbra_end + 0.5), 0.0);
}

TEST_F(MissionScene, StandsOverTheGroundAndTheSunAsItsOwnVectorsSay) {
  const Scene scene = read();
  const MissionState state = mission_state(*mission_of(scene), epoch + 1234.0);
  const Sky sky = sky_of(circle, 1234.0);
  EXPECT_NEAR(state.beta_deg, base::degrees(sky.beta), 0.003);  // the Sun from the spacecraft
  EXPECT_NEAR(std::remainder(state.position_deg - base::degrees(sky.position), 360.0), 0.0, 0.003);
  EXPECT_NEAR(state.distance_m, circle.semi_major_m, 0.01);
  // Geocentric latitude asin(sin i sin u); the geodetic latitude is up to 0.2 deg larger.
  const double u = circle.mean_motion_rad_s() * 1234.0;
  const double latitude =
      base::degrees(std::asin(std::sin(base::radians(circle.inclination_deg)) * std::sin(u)));
  EXPECT_NEAR(state.below.latitude_deg, latitude, 0.35);
}

// For a known local vertical, each attitude has the Earth in its named direction.
TEST_F(MissionScene, NamedAttitudesPointWhereTheySay) {
  const auto earth_of = [&](const std::string& attitude, double s) {
    Scene scene = read("attitude = \"" + attitude + "\"\n");
    move_to_moment(scene, epoch + s);
    return scene;
  };
  for (const double s : {0.0, 1500.0, 4000.0}) {
    EXPECT_LT(glm::length(earth_of("bay-to-earth", s).earth->direction - Vec3(0, 0, 1)), 1e-12);
    EXPECT_LT(glm::length(earth_of("bay-to-space", s).earth->direction - Vec3(0, 0, -1)), 1e-12);
    EXPECT_LT(glm::length(earth_of("tail-down", s).earth->direction - Vec3(1, 0, 0)), 1e-12);
    EXPECT_LT(glm::length(earth_of("bay-to-sun", s).sun->direction - Vec3(0, 0, 1)), 1e-12);
    // Inertial: equals bay-to-earth at the start. Then the Earth moves about the orbit's normal,
    // opposite to the scene's y, and the Sun is fixed except for its 1 deg per day.
    const Scene kept = earth_of("inertial", s);
    const double u = circle.mean_motion_rad_s() * s;
    EXPECT_LT(glm::length(kept.earth->direction - Vec3(std::sin(u), 0.0, std::cos(u))), 1e-6) << s;
    EXPECT_LT(glm::length(kept.sun->direction - earth_of("inertial", 0.0).sun->direction), 2e-3);
  }
}

// Identity with GCRF: the scene's axes are the frame's axes, through body_axes.
TEST_F(MissionScene, AttitudeFilesTurnTheSkyByTheirBodyAxes) {
  folder.put("a.aem",
             "CCSDS_AEM_VERS = 2.0\nMETA_START\nREF_FRAME_A = GCRF\nREF_FRAME_B = SC_BODY\n"
             "TIME_SYSTEM = UTC\nATTITUDE_TYPE = QUATERNION\nMETA_STOP\n"
             "2026-03-01T12:00:00 0 0 0 1\n2026-03-01T16:00:00 0 0 0 1\n");
  const Vec3 sun =
      glm::normalize(sun_direction(epoch) * sun_distance_m(epoch) - circle.at(0.0).position_m);
  const std::string file = "attitude = \"a.aem\"\nbody_axes = ";
  EXPECT_LT(glm::length(read(file + "[\"x\", \"y\", \"z\"]\n").sun->direction - sun), 1e-9);
  EXPECT_LT(glm::length(read(file + "[\"-x\", \"y\", \"-z\"]\n").sun->direction -
                        Vec3(-sun.x, sun.y, -sun.z)),
            1e-9);
  // The file's x along the scene's y, its y along z, its z along x.
  EXPECT_LT(glm::length(read(file + "[\"y\", \"z\", \"x\"]\n").sun->direction -
                        Vec3(sun.z, sun.x, sun.y)),
            1e-9);
  EXPECT_TRUE(holds(folder.refusal(std::string(mission_scene) + "attitude = \"a.aem\"\n"),
                    {"scene.toml:8:1", "no body_axes", "nose, starboard and belly"}));
  EXPECT_TRUE(holds(folder.refusal(mission_scene + file + "[\"x\", \"y\", \"-z\"]\n"),
                    {"scene.toml:9:1", "left-handed"}));
}

TEST_F(MissionScene, MomentsGoFromStartToStop) {
  const Scene scene = read();
  const TimeSpan& time = mission_of(scene)->time;
  EXPECT_EQ(time.count(), 19U);
  EXPECT_EQ(utc_text(time.at(18)), "2026-03-01T15:00:00Z");
  // Without [time]: at the start of the trajectory.
  folder.put("late.oem", oem_of(circle, epoch + 30.0, 60.0, 20));
  const Scene late = folder.read("format = 1\n[orbit]\ntrajectory = \"late.oem\"\n");
  EXPECT_EQ(utc_text(mission_of(late)->time.start), "2026-03-01T12:00:30Z");
  EXPECT_EQ(mission_of(late)->time.count(), 1U);
}

// From the perigee on: k / 2 periods are k half revolutions, in which the speed changes 6.4 times,
// (1 + e) / (1 - e). Vis-viva has the period from every state.
TEST_F(MissionScene, RevolutionsOfAnEllipseAreThoseOfItsOwnPeriod) {
  for (const double eccentricity : {0.0, 0.73}) {
    const Ellipse ellipse{24400e3, eccentricity, 7.0, 100.0};
    const double period = 2.0 * base::pi / ellipse.mean_motion_rad_s();
    folder.put("t.oem", oem_of(ellipse, epoch, 60.0, 1600));
    const Scene scene = folder.read("format = 1\n[orbit]\ntrajectory = \"t.oem\"\n");
    const Mission& mission = *mission_of(scene);
    for (int k = 0; k <= 5; ++k) {
      EXPECT_NEAR(revolved_deg(mission, epoch, epoch + 0.5 * k * period), 180.0 * k, 1e-3);
      EXPECT_NEAR(*period_at(mission, epoch + 0.4 * k * period), period, 0.05);
    }
    EXPECT_NEAR(revolved_deg(mission, epoch + 0.7 * period, epoch + 1.7 * period), 360.0, 1e-3);
  }
}

// A long ellipse is slow almost everywhere: with e = 0.95 half of the revolution takes 1/50 of the
// period, far less than the 36 deg of its apogee's rate.
TEST_F(MissionScene, RevolutionsOfALongEllipseAreCounted) {
  const Ellipse ellipse{150000e3, 0.95, 28.5, 0.0};
  const double period = 2.0 * base::pi / ellipse.mean_motion_rad_s();
  folder.put("t.oem", oem_of(ellipse, epoch, 300.0, 4000));
  const Scene scene = folder.read("format = 1\n[orbit]\ntrajectory = \"t.oem\"\n");
  for (const double start : {0.0, 0.3, 0.5, 0.9}) {
    EXPECT_NEAR(
        revolved_deg(*mission_of(scene), epoch + start * period, epoch + (start + 1.0) * period),
        360.0, 0.01)
        << start;
  }
}

// States 2.3 revolutions apart, in two segments or in one.
TEST_F(MissionScene, RevolutionsInGapsFollowFromThePeriod) {
  const double period = 2.0 * base::pi / circle.mean_motion_rad_s();
  const double gap = std::round(2.3 * period), expected = 360.0 * (120.0 + gap) / period;
  const auto rows = [&](double from) {
    std::string text;
    for (const double s : {from, from + 60.0}) text += oem_row(utc_text(epoch + s), circle.at(s));
    return text;
  };
  const std::string start = utc_text(epoch), stop = utc_text(epoch + (120.0 + gap));
  const std::string pieces[] = {test::oem_meta(start, utc_text(epoch + 60.0)) + rows(0.0) +
                                    test::oem_meta(utc_text(epoch + (60.0 + gap)), stop) +
                                    rows(60.0 + gap),
                                test::oem_meta(start, stop) + rows(0.0) + rows(60.0 + gap)};
  for (const std::string& piece : pieces) {
    folder.put("t.oem", test::oem_head + piece);
    const Scene scene = folder.read("format = 1\n[orbit]\ntrajectory = \"t.oem\"\n");
    EXPECT_NEAR(revolved_deg(*mission_of(scene), epoch, epoch + (120.0 + gap)), expected, 1e-3);
  }
}

// 12 km/s at 7000 km, where sqrt(2 GM / r) = 10.67 km/s is enough to leave.
TEST_F(MissionScene, AHyperbolaHasNoPeriod) {
  folder.put("t.oem", test::oem_head +
                          test::oem_meta("2026-03-01T12:00:00", "2026-03-01T12:00:00") +
                          oem_row("2026-03-01T12:00:00", {{7e6, 0.0, 0.0}, {0.0, 12e3, 0.0}}));
  const Scene scene = folder.read("format = 1\n[orbit]\ntrajectory = \"t.oem\"\n");
  EXPECT_FALSE(period_at(*mission_of(scene), epoch));
}

TEST_F(MissionScene, DatesOfTomlAreUtc) {
  const char* const orbit = "format = 1\n[orbit]\ntrajectory = \"t.oem\"\n[time]\n";
  for (const char* date :
       {"2026-03-01T12:00:30", "2026-03-01T12:00:30Z", "\"2026-060T12:00:30\""}) {
    const Scene scene = folder.read(fmt::format("{}start = {}\n", orbit, date));
    EXPECT_EQ(mission_of(scene)->time.start, epoch + 30.0) << date;
  }
  const Scene set = folder.read(orbit + std::string("start = 2026-03-01T12:00:00\n"),
                                {"time.start=2026-03-01T12:00:30"});
  EXPECT_EQ(mission_of(set)->time.start, epoch + 30.0);
}

TEST_F(MissionScene, BadKeysAreRefused) {
  const std::string orbit = "[orbit]\ntrajectory = \"t.oem\"\n";
  const struct {
    std::string text;
    std::vector<std::string> says;
  } bad[] = {
      {"[time]\nstart = \"2026-03-01T12:00:00\"\n", {"scene.toml:2:1", "needs a trajectory"}},
      {"[time]\nstart = \"1 March 2026\"\n" + orbit, {"scene.toml:3:1", "1 March 2026", "UTC"}},
      {"[time]\nstart = 2026-03-01T12:00:00+01:00\n" + orbit, {"scene.toml:3:1", "+01:00", "UTC"}},
      {"[time]\nstart = \"2026-03-01T12:00:00\"\nstop = \"2026-03-01T13:00:00\"\n" + orbit,
       {"\"step\"", "missing"}},
      {"[time]\nstart = \"2026-03-01T12:00:00\"\nstop = \"2026-03-01T11:00:00\"\nstep = 60\n" +
           orbit,
       {"stop comes after start"}},
      {"[time]\nstart = \"2026-03-01T12:00:00\"\nstop = \"2026-03-01T13:00:00\"\nstep = 0.1\n" +
           orbit,
       {"more than 3600 moments"}},
      {"[time]\nstart = \"2026-03-02T12:00:00\"\n" + orbit,
       {"t.oem", "no state at 2026-03-02T12:00:00Z", "2026-03-01T12:00:00Z to"}},
      {orbit + "altitude_km = 400\n", {"scene.toml:4:1", "altitude_km"}},
      {orbit + "quaternion = \"scalar-first\"\n", {"belongs to an attitude from a file"}},
      {orbit + "attitude = \"nose-up\"\n", {"nose-up", "bay-to-earth", "inertial"}},
      {"[orbit]\ntrajectory = \"none.oem\"\n", {"scene.toml:3:1", "none.oem"}},
  };
  for (const auto& one : bad) {
    const std::string said = folder.refusal("format = 1\n" + one.text);
    EXPECT_TRUE(holds(said, one.says)) << said;
  }
}

}  // namespace
}  // namespace earthshine::scenes
