// SPDX-License-Identifier: Apache-2.0
#include "scenes/sky/attitude_file.h"

#include <sys/stat.h>

#include <cmath>

#include "scenes/sky/orbit.h"
#include "tests/scenes/scene_text.h"

namespace earthshine::scenes {
namespace {

using test::holds;

constexpr const char* scene_text =
    "format = 1\n[orbit]\naltitude_km = 425\nbeta_deg = 20\nattitude_table = \"turns.csv\"\n";

class AttitudeFile : public ::testing::Test {
 protected:
  Orbit orbit(const std::string& csv) {
    folder.put("turns.csv", csv);
    return *folder.read(scene_text).orbit;
  }
  std::string refusal(const std::string& csv) {
    folder.put("turns.csv", csv);
    return folder.refusal(scene_text);
  }
  static void expect_same(const OrbitState& a, const OrbitState& b, const std::string& what) {
    EXPECT_LT(glm::length(a.sun - b.sun), 1e-12) << what;
    EXPECT_LT(glm::length(a.earth - b.earth), 1e-12) << what;
  }

  test::SceneFolder folder;
};

// A full roll in two rows is no rotation: slerp takes the shorter way. No warning for rows that
// only wrap from 360 to 0 or from 180 to -180 deg, or that represent a small rotation near the
// zenith by large angles.
TEST_F(AttitudeFile, RowsHalfATurnApartAreNamed) {
  const auto warnings = [&](const std::string& rows) {
    std::string csv = "position_deg, yaw_deg, pitch_deg, roll_deg\n";
    int at = 0;
    for (std::size_t begin = 0; begin < rows.size(); at += 60) {
      const std::size_t end = std::min(rows.find(';', begin), rows.size());
      csv += std::to_string(at) + "," + rows.substr(begin, end - begin) + "\n";
      begin = end + 1;
    }
    folder.put("turns.csv", csv);
    return folder.read(scene_text).warnings;
  };
  for (const char* wide : {"0,0,0;0,0,360", "0,0,0;0,0,180", "0,0,0;0,0,270", "0,0,0;0,0,-200",
                           "0,0,0;0,0,350", "0,0,0;300,0,0", "0,0,0;0,200,0", "-180,0,0;180,0,0",
                           "0,0,0;0,0,0;360,0,0;360,0,0", "0,0,0;0,0,10;0,0,200"}) {
    const std::vector<std::string> found = warnings(wide);
    ASSERT_EQ(found.size(), 1U) << wide;
    EXPECT_TRUE(holds(found[0], {"turns.csv", "lines", "less than 180 deg"})) << found[0];
  }
  for (const char* meant :
       {"0,0,0;0,0,179", "0,0,0;0,0,120;0,0,240;0,0,360", "0,0,160;0,0,170;0,0,-180;0,0,-170",
        "350,0,0;0,0,0;10,0,0", "20,0,0;10,0,0;0,0,0;350,0,0", "0,0,0;0,0,120;0,0,-120;0,0,0",
        "0,80,0;180,85,180", "0,0,179.9;0,0,-179.9;0,0,179.8", "120,0,170"}) {
    EXPECT_TRUE(warnings(meant).empty()) << meant;
  }
  // With quaternions only the rotation itself counts; q and -q are the same attitude.
  folder.put("turns.csv", "time_s,qw,qx,qy,qz\n0,1,0,0,0\n6000,0,1,0,0\n");
  ASSERT_EQ(folder.read(scene_text).warnings.size(), 1U);
  folder.put("turns.csv", "time_s,qw,qx,qy,qz\n0,1,0,0,0\n6000,-1,0,0,0\n");
  EXPECT_TRUE(folder.read(scene_text).warnings.empty());
}

TEST_F(AttitudeFile, NamedAttitudesAreTurnsOfTheLocalVertical) {
  struct Row {
    const char* attitude;
    const char* csv;
  };
  const Row rows[] = {{"bay-to-space", "time_s,qw,qx,qy,qz\n0,1,0,0,0\n"},
                      {"bay-to-earth", "time_s,qw,qx,qy,qz\n0,0,1,0,0\n"},
                      {"bay-to-space", "position_deg,yaw_deg,pitch_deg,roll_deg\n0,0,0,0\n"},
                      {"bay-to-earth", "position_deg,yaw_deg,pitch_deg,roll_deg\n0,0,0,180\n"},
                      {"tail-down", "position_deg,yaw_deg,pitch_deg,roll_deg\n0,180,90,0\n"}};
  for (const Row& row : rows) {
    Orbit named;
    named.altitude_m = 425e3;
    named.beta_deg = 20.0;
    named.attitude = row.attitude;
    for (const double position : {-30.0, 0.0, 100.0}) {
      expect_same(orbit_state(orbit(row.csv), position), orbit_state(named, position), row.csv);
    }
  }
}

TEST_F(AttitudeFile, AnglesTurnByTheAerospaceMatrix) {
  // Rows of the matrix from the local vertical to the spacecraft's axes for the sequence yaw,
  // pitch, roll (Kuipers 1999, Quaternions and Rotation Sequences, 4.4). Its third column is the
  // nadir, its first the velocity, where the Sun of beta 0 is at -90 deg.
  const double yaw = 0.7, pitch = -0.4, roll = 2.1;
  const double cy = std::cos(yaw), sy = std::sin(yaw), cp = std::cos(pitch), sp = std::sin(pitch),
               cr = std::cos(roll), sr = std::sin(roll);
  const Vec3 forward(cp * cy, sr * sp * cy - cr * sy, cr * sp * cy + sr * sy);
  const Vec3 nadir(-sp, sr * cp, cr * cp);
  const auto in_scene = [](const Vec3& d) { return Vec3(-d.x, d.y, -d.z); };
  Orbit turned =
      orbit("position_deg, roll_deg, yaw_deg, pitch_deg  # any order\n\n-90, " +
            std::to_string(base::degrees(roll)) + ", " + std::to_string(base::degrees(yaw)) + ", " +
            std::to_string(base::degrees(pitch)) + "\n");
  turned.beta_deg = 0.0;
  const OrbitState state = orbit_state(turned, -90.0);
  EXPECT_LT(glm::length(state.sun - in_scene(forward)), 1e-7);  // std::to_string: six decimals
  EXPECT_LT(glm::length(state.earth - in_scene(nadir)), 1e-7);
}

TEST_F(AttitudeFile, BetweenRowsTheTurnIsEven) {
  // A roll of 90 deg in 60 deg of the orbit: after a third of it the starboard side is 30 deg down.
  const Orbit rolling = orbit("position_deg,yaw_deg,pitch_deg,roll_deg\n-60,0,0,0\n0,0,0,90\n");
  EXPECT_NEAR(orbit_state(rolling, -40.0).earth.y, std::sin(base::radians(30.0)), 1e-12);
  EXPECT_NEAR(orbit_state(rolling, -60.0).earth.z, -1.0, 1e-12);
  EXPECT_NEAR(orbit_state(rolling, 0.0).earth.y, 1.0, 1e-12);
  // From yaw 350 to yaw 10 the shorter way passes 0; q and -q are the same rotation.
  const Orbit yawing = orbit("position_deg,yaw_deg,pitch_deg,roll_deg\n0,350,0,0\n10,10,0,0\n");
  const Orbit still = orbit("position_deg,qw,qx,qy,qz\n0,1,0,0,0\n10,-1,0,0,0\n");
  expect_same(orbit_state(yawing, 5.0), orbit_state(still, 5.0), "yaw");
}

TEST_F(AttitudeFile, TimeRunsFromOrbitNoon) {
  const double quarter_s = orbit_period_s(425e3) / 4.0;
  const Orbit by_time = orbit("time_s,yaw_deg,pitch_deg,roll_deg\n0,0,0,0\n" +
                              std::to_string(quarter_s) + ",0,0,90\n");
  const Orbit by_place = orbit("position_deg,yaw_deg,pitch_deg,roll_deg\n0,0,0,0\n90,0,0,90\n");
  for (const double position : {0.0, 20.0, 80.0}) {
    EXPECT_NEAR(orbit_state(by_time, position).earth.y, orbit_state(by_place, position).earth.y,
                1e-8);
  }
}

TEST_F(AttitudeFile, BeyondItsRowsThereIsNoAttitude) {
  const Orbit turning = orbit("time_s,qw,qx,qy,qz\n-10,1,0,0,0\n500,0,1,0,0\n600,1,0,0,0\n");
  EXPECT_NO_THROW(static_cast<void>(orbit_state(turning, 30.0)));
  for (const double position : {-1.0, 90.0}) {
    try {
      static_cast<void>(orbit_state(turning, position));
      ADD_FAILURE() << "was not refused";
    } catch (const base::Error& error) {
      EXPECT_TRUE(holds(error.what(),
                        {"turns.csv", "which is time_s = ", "from time_s -10 to 600", "Add rows"}));
    }
  }
  // Likewise a scene whose own position is there.
  EXPECT_TRUE(holds(
      refusal("position_deg,qw,qx,qy,qz\n10,1,0,0,0\n500,0,1,0,0\n"),
      {"turns.csv", "no attitude at position_deg = 0; its rows go from position_deg 10 to 500"}));
  // A single row is valid everywhere.
  EXPECT_NO_THROW(static_cast<void>(orbit_state(orbit("time_s,qw,qx,qy,qz\n7,1,0,0,0\n"), 999.0)));
}

TEST_F(AttitudeFile, BrokenTablesAreRefusedAtTheirPlace) {
  const std::string head = "time_s,qw,qx,qy,qz\n";
  const std::string angles = "time_s,yaw_deg,pitch_deg,roll_deg\n";
  struct Case {
    std::string csv;
    std::vector<std::string> says;
  };
  const Case cases[] = {
      {"", {"turns.csv: has no lines", "a header names"}},
      {"# nothing\n\n", {"turns.csv: has no lines"}},
      {head, {"turns.csv: has a header and no rows", "Give one row"}},
      {"0,1,0,0,0\n", {"turns.csv:1:1:", "\"0\"", "no header", "Begin with it"}},
      {"time,qw,qx,qy,qz\n", {"turns.csv:1:1:", "unknown column \"time\"", "time_s"}},
      {"time_s,qw,qx,qy,qz,\n", {"turns.csv:1:20:", "unknown column \"\""}},
      {"time_s,qw,qx,qy\n0,1,0,0\n", {"turns.csv:1:1:", "no column qz"}},
      {"time_s,yaw_deg,roll_deg\n", {"no column pitch_deg"}},
      {"time_s\n", {"no column yaw_deg"}},
      {"qw,qx,qy,qz\n", {"no column time_s or position_deg"}},
      {"time_s,position_deg,qw,qx,qy,qz\n", {"both time_s and position_deg"}},
      {"time_s,qw,qx,qy,qz,yaw_deg\n", {"both a quaternion and angles"}},
      {"time_s,qw,qw,qy,qz\n", {"turns.csv:1:11:", "the column qw is there twice"}},
      {head + "0,1,0,0\n", {"turns.csv:2:", "a row of 4 columns", "the header names 5"}},
      {head + "0,1,0,0,0,0\n", {"turns.csv:2:", "a row of 6 columns"}},
      {head + "0,1,0,,0\n", {"turns.csv:2:7:", "qy is \"\""}},
      {head + "0,1,0,0,0\n1,1, nan,0,0\n", {"turns.csv:3:6:", "qx is \"nan\""}},
      {head + "inf,1,0,0,0\n", {"turns.csv:2:1:", "time_s is \"inf\""}},
      {head + "1e300,1,0,0,0\n", {"turns.csv:2:1:", "time_s is \"1e300\"", "1000000000"}},
      {head + "0,1,0,0,0 0\n", {"turns.csv:2:9:", "qz is \"0 0\""}},
      {angles + "0,361,0,0\n", {"turns.csv:2:3:", "yaw_deg is \"361\"", "360"}},
      {head + "0,0,0,0,0\n", {"turns.csv:2:", "the quaternion has length 0", "length 1"}},
      {head + "0,1,1,0,0\n", {"turns.csv:2:", "length 1.41421"}},
      {head + "5,1,0,0,0\n4,1,0,0,0\n", {"turns.csv:3:1:", "time_s is 4 after 5", "Sort"}},
      {head + "5,1,0,0,0\n5,1,0,0,0\n", {"turns.csv:3:1:", "time_s is 5 after 5"}},
      {std::string("\x7F\x45LF\0\x01\xFF,\x02", 9), {"turns.csv:1:1:", "unknown column", "\\x"}},
  };
  for (const Case& broken : cases)
    EXPECT_TRUE(holds(refusal(broken.csv), broken.says)) << broken.csv;
}

TEST_F(AttitudeFile, WhatCannotBeReadIsRefusedInTheScene) {
  EXPECT_TRUE(holds(folder.refusal(scene_text), {"scene.toml:5:", "turns.csv", "cannot open"}));
  EXPECT_TRUE(holds(refusal(std::string((16 << 20) + 1, ' ')), {"scene.toml:5:", "larger than"}));
  std::filesystem::remove(folder.path() / "turns.csv");
  std::filesystem::create_directory(folder.path() / "turns.csv");
  EXPECT_TRUE(holds(folder.refusal(scene_text), {"scene.toml:5:", "is a folder"}));
  std::filesystem::remove(folder.path() / "turns.csv");
  ASSERT_EQ(::mkfifo((folder.path() / "turns.csv").c_str(), 0600), 0);
  EXPECT_TRUE(holds(folder.refusal(scene_text), {"scene.toml:5:", "a pipe or a device"}));
}

TEST_F(AttitudeFile, LinesMayEndAsElsewhere) {
  expect_same(orbit_state(orbit("\xEF\xBB\xBFtime_s,qw,qx,qy,qz\r\n0,0,1,0,0\r\n"), 0.0),
              orbit_state(orbit("time_s,qw,qx,qy,qz\n0,0,1,0,0"), 0.0), "CR LF");
}

}  // namespace
}  // namespace earthshine::scenes
