// SPDX-License-Identifier: Apache-2.0
#include "scenes/time/attitude_history.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/scenes/scene_text.h"

namespace earthshine::scenes {
namespace {

using test::holds;

constexpr double any_gap = 1e9;
const Instant noon = *read_instant("2026-03-01T12:00:00", TimeSystem::Utc);

std::string aem(const std::string& meta, const std::string& rows, const char* version = "1.0",
                const char* a = "GCRF", const char* b = "SC_BODY_1") {
  return fmt::format(
      "CCSDS_AEM_VERS = {}\nCREATION_DATE = 2026-01-01T00:00:00\nORIGINATOR = TEST\nMETA_START\n"
      "OBJECT_NAME = TEST\nOBJECT_ID = 2026-001A\nREF_FRAME_A = {}\nREF_FRAME_B = {}\n"
      "TIME_SYSTEM = UTC\nSTART_TIME = 2026-03-01T12:00:00\nSTOP_TIME = 2026-03-01T12:00:00\n"
      "{}META_STOP\nDATA_START\n{}DATA_STOP\n",
      version, a, b, meta, rows);
}

class AttitudeMessage : public ::testing::Test {
 protected:
  AttitudeHistory read(const std::string& text, std::optional<ScalarPlace> scalar = std::nullopt) {
    folder.put("a.aem", text);
    return read_attitude_history(folder.path() / "a.aem", {}, scalar,
                                 base::Location{"scene.toml", 3, 1}, warnings);
  }
  std::string refusal(const std::string& text, std::optional<ScalarPlace> scalar = std::nullopt) {
    try {
      (void)read(text, scalar).at(noon, any_gap);
    } catch (const base::Error& error) {
      return error.what();
    }
    return "was not refused";
  }
  test::SceneFolder folder;
  std::vector<std::string> warnings;
};

const Vec3 X(1, 0, 0), Y(0, 1, 0), Z(0, 0, 1);
struct RightAngleTurn {
  Vec3 axis;
  double angle_deg;
  Vec3 x, y;  // rotated axes x and y; z follows
};
// The 24 rotations of a cube: identity, about faces, edges and corners.
const RightAngleTurn turns[] = {{Z, 0, X, Y},
                                {X, 90, X, Z},
                                {X, 180, X, -Y},
                                {X, 270, X, -Z},
                                {Y, 90, -Z, Y},
                                {Y, 180, -X, Y},
                                {Y, 270, Z, Y},
                                {Z, 90, Y, -X},
                                {Z, 180, -X, -Y},
                                {Z, 270, -Y, X},
                                {{1, 1, 0}, 180, Y, X},
                                {{1, -1, 0}, 180, -Y, -X},
                                {{1, 0, 1}, 180, Z, -Y},
                                {{1, 0, -1}, 180, -Z, -Y},
                                {{0, 1, 1}, 180, -X, Z},
                                {{0, 1, -1}, 180, -X, -Z},
                                {{1, 1, 1}, 120, Y, Z},
                                {{1, 1, 1}, -120, Z, X},
                                {{1, 1, -1}, 120, -Z, X},
                                {{1, 1, -1}, -120, Y, -Z},
                                {{1, -1, 1}, 120, Z, -X},
                                {{1, -1, 1}, -120, -Y, -Z},
                                {{-1, 1, 1}, 120, -Z, -X},
                                {{-1, 1, 1}, -120, -Y, Z}};

// The body's axes are the rotated frame axes, in every form that a file may use.
TEST_F(AttitudeMessage, QuaternionsOfThe24RightAngleTurns) {
  for (const RightAngleTurn& turn : turns) {
    const double half = 0.5 * base::radians(turn.angle_deg);
    const Vec3 v = glm::normalize(turn.axis) * std::sin(half);
    const double c = std::cos(half);
    const auto row = [&](bool first, double sign) {
      const Vec3 w = sign * v;
      return first ? fmt::format("2026-03-01T12:00:00 {} {} {} {}\n", c, w.x, w.y, w.z)
                   : fmt::format("2026-03-01T12:00:00 {} {} {} {}\n", w.x, w.y, w.z, c);
    };
    const std::string type = "ATTITUDE_TYPE = QUATERNION\n";
    const std::string ways[] = {
        aem(type + "QUATERNION_TYPE = FIRST\nATTITUDE_DIR = A2B\n", row(true, 1.0)),
        aem(type + "QUATERNION_TYPE = LAST\nATTITUDE_DIR = A2B\n", row(false, 1.0)),
        aem(type + "QUATERNION_TYPE = LAST\nATTITUDE_DIR = B2A\n", row(false, -1.0)),
        aem(type + "QUATERNION_TYPE = FIRST\nATTITUDE_DIR = B2A\n", row(true, 1.0), "1.0",
            "SC_BODY", "ICRF"),
        aem(type, row(false, 1.0), "2.0"),
        aem(type, row(false, -1.0), "2.0", "SC_BODY_1", "GCRF")};
    for (const std::string& way : ways) {
      const glm::dquat q = read(way).at(noon, any_gap);
      EXPECT_LT(glm::length(q * X - turn.x), 1e-12) << turn.angle_deg << way;
      EXPECT_LT(glm::length(q * Y - turn.y), 1e-12) << turn.angle_deg << way;
      EXPECT_LT(glm::length(q * Z - glm::cross(turn.x, turn.y)), 1e-12) << turn.angle_deg << way;
    }
  }
}

// Components along axes rotated by `angle` about one of them, the standard's M1, M2, M3.
glm::dmat3 elementary(int axis, double angle_deg) {
  const double c = std::cos(base::radians(angle_deg)), s = std::sin(base::radians(angle_deg));
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  glm::dmat3 m(0.0);  // m[column][row]
  m[axis][axis] = 1.0;
  m[i][i] = m[j][j] = c;
  m[j][i] = s;
  m[i][j] = -s;
  return m;
}

TEST_F(AttitudeMessage, EulerAnglesAreMatricesMultiplied) {
  const std::array<double, 3> angles = {30.0, -50.0, 70.0};
  for (const std::string sequence : {"321", "123", "313", "312", "ZYX", "XYX", "231"}) {
    int axis[3];
    for (std::size_t k = 0; k < 3; ++k) {
      axis[k] = sequence[k] >= 'X' ? sequence[k] - 'X' : sequence[k] - '1';
    }
    const glm::dmat3 wanted = elementary(axis[2], angles[2]) * elementary(axis[1], angles[1]) *
                              elementary(axis[0], angles[0]);
    const glm::dquat q =
        read(aem("ATTITUDE_TYPE = EULER_ANGLE\nATTITUDE_DIR = A2B\nEULER_ROT_SEQ = " + sequence +
                     "\n",
                 "2026-03-01T12:00:00 30 -50 70\n"))
            .at(noon, any_gap);
    for (const Vec3& v : {X, Y, Z}) {
      EXPECT_LT(glm::length(glm::conjugate(q) * v - wanted * v), 1e-12) << sequence;
    }
  }
}

// 7.3 deg/s are 438 deg in the minute between the rows: 78 deg modulo full revolutions.
TEST_F(AttitudeMessage, SpinGoesOnAtItsRateBetweenRows) {
  std::string text = aem("ATTITUDE_TYPE = SPIN\nATTITUDE_DIR = A2B\n",
                         "2026-03-01T12:00:00 120 35 10 7.3\n2026-03-01T12:01:00 120 35 88 7.3\n");
  const AttitudeHistory history = read(text);
  const double ra = base::radians(120.0), dec = base::radians(35.0);
  const Vec3 axis(std::cos(dec) * std::cos(ra), std::cos(dec) * std::sin(ra), std::sin(dec));
  const glm::dquat begin = history.at(noon, any_gap), later = history.at(noon + 10.0, any_gap);
  EXPECT_LT(glm::length(begin * Z - axis), 1e-12);
  EXPECT_LT(glm::length(later * Z - axis), 1e-12);
  const Vec3 x = begin * X, turned = later * X;
  EXPECT_NEAR(base::degrees(std::atan2(glm::dot(glm::cross(x, turned), axis), glm::dot(x, turned))),
              73.0, 1e-9);
  // The node of the sequence is at right ascension + 90 deg, the body's x 10 deg past it.
  const Vec3 node(-std::sin(ra), std::cos(ra), 0.0);
  EXPECT_NEAR(glm::dot(x, node), std::cos(base::radians(10.0)), 1e-12);
}

TEST_F(AttitudeMessage, WhereTheScalarIsIsNeverGuessed) {
  const std::string type = "ATTITUDE_TYPE = QUATERNION\nATTITUDE_DIR = A2B\n";
  const std::string silent = aem(type, "2026-03-01T12:00:00 1 0 0 0\n");
  // Scalar first: identity, z is unchanged. Scalar last: half a turn about x.
  EXPECT_TRUE(holds(refusal(silent),
                    {"a.aem:4", "do not say",
                     "scalar first: z at (0.000, 0.000, "
                     "1.000)",
                     "scalar last: z at (0.000, 0.000, -1.000)", "quaternion = \"scalar-first\""}))
      << refusal(silent);
  EXPECT_LT(glm::length(read(silent, ScalarPlace::First).at(noon, any_gap) * Z - Z), 1e-12);
  EXPECT_LT(glm::length(read(silent, ScalarPlace::Last).at(noon, any_gap) * Z + Z), 1e-12);
  const std::string says = aem(type + "QUATERNION_TYPE = FIRST\n", "2026-03-01T12:00:00 1 0 0 0\n");
  EXPECT_TRUE(holds(refusal(says, ScalarPlace::Last), {"a.aem:14", "scalar first", "other"}));
  std::string cic = silent;
  cic.replace(0, 20, "CIC_AEM_VERS = 2.0");
  cic.replace(cic.find("2026-03-01T12:00:00 1"), 19, "61100 43200.0");
  EXPECT_TRUE(holds(refusal(cic), {"do not say"})) << refusal(cic);
  EXPECT_LT(glm::length(read(cic, ScalarPlace::First).at(noon, any_gap) * Z - Z), 1e-12);
}

TEST_F(AttitudeMessage, BetweenRowsTheTurnIsEvenWhateverTheSigns) {
  const double s = std::sqrt(0.5);
  // Half way between the identity and 90 deg about z; the second row has reversed signs.
  const AttitudeHistory history = read(aem(
      "ATTITUDE_TYPE = QUATERNION\n",
      fmt::format("2026-03-01T12:00:00 0 0 0 1\n2026-03-01T12:01:00 0 0 {0} {0}\n", -s), "2.0"));
  const Vec3 x = history.at(noon + 30.0, any_gap) * X;
  EXPECT_LT(glm::length(x - Vec3(s, s, 0.0)), 1e-12);
}

// Rows of 12:00, 12:10 and 12:20: 600 s exceed a longest gap of 599 s, not one of 601 s.
TEST_F(AttitudeMessage, GapsAreRefusedWhereAnAttitudeIsAskedForUnlessItIsHeld) {
  const std::string type = "ATTITUDE_TYPE = EULER_ANGLE\nATTITUDE_DIR = A2B\nEULER_ROT_SEQ = 321\n";
  const AttitudeHistory history = read(aem(type,
                                           "2026-03-01T12:00:00 0 0 0\n2026-03-01T12:10:00 9 0 0\n"
                                           "2026-03-01T12:20:00 9 0 0\n"));
  const auto said = [&](double at_s, double longest_gap_s) -> std::string {
    try {
      (void)history.at(noon + at_s, longest_gap_s);
    } catch (const base::Error& error) {
      return error.what();
    }
    return "was not refused";
  };
  EXPECT_TRUE(holds(said(300.0, 599.0), {"a.aem:18", "gap of 600 s", "12:10:00Z", "36 deg"}))
      << said(300.0, 599.0);
  EXPECT_EQ(said(300.0, 601.0), "was not refused");
  for (const double at_s : {0.0, 600.0, 900.0, 1200.0}) {
    EXPECT_EQ(said(at_s, 599.0), "was not refused") << at_s;  // a row, or one attitude
  }
}

// One row of 20 is turned by 61 deg: neither of the two jumps is ten times the other.
TEST_F(AttitudeMessage, ASingleRowThatJumpsIsNamed) {
  const std::string type = "ATTITUDE_TYPE = EULER_ANGLE\nATTITUDE_DIR = A2B\nEULER_ROT_SEQ = 321\n";
  for (const int off : {-1, 0, 1, 7, 19}) {  // -1: none
    std::string rows;
    for (int k = 0; k < 20; ++k) {
      rows += fmt::format("2026-03-01T12:{:02}:00 {} 0 0\n", k, k + (k == off ? 60 : 0));
    }
    warnings.clear();
    (void)read(aem(type, rows));
    EXPECT_EQ(warnings.size(), off < 0 ? 0U : 1U) << off;
  }
  // A slew of 12 deg from row to row begins, goes on and ends without a warning.
  std::string rows;
  for (int k = 0; k < 20; ++k) {
    rows += fmt::format("2026-03-01T12:{:02}:00 {} 0 0\n", k, 12 * std::clamp(k - 5, 0, 5));
  }
  warnings.clear();
  (void)read(aem(type, rows));
  EXPECT_TRUE(warnings.empty());
}

TEST_F(AttitudeMessage, JumpsAreNamedAndBadFilesRefused) {
  const std::string type = "ATTITUDE_TYPE = EULER_ANGLE\nATTITUDE_DIR = A2B\nEULER_ROT_SEQ = 321\n";
  std::string rows;
  for (int k = 0; k < 6; ++k) {
    rows += fmt::format("2026-03-01T12:0{}:00 {} 0 0\n", k, k < 3 ? k : k + 60);
  }
  (void)read(aem(type, rows));
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(holds(warnings[0], {"jumps by 61 deg", "12:02:00Z to 2026-03-01T12:03:00Z"}));
  const std::string row = "2026-03-01T12:00:00 10 20 30\n", good = aem(type, row);
  const auto with = [](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  const struct {
    std::string text;
    std::vector<std::string> says;
  } bad[] = {
      {with(good, "SC_BODY_1", "EME2000"), {"a.aem:8", "between \"GCRF\" and \"EME2000\""}},
      {with(good, "= GCRF", "= LVLH"), {"a.aem:7", "REF_FRAME_A is \"LVLH\"", "EME2000"}},
      {with(good, "= 321", "= 331"), {"a.aem:14", "331", "no two neighbours alike"}},
      {with(good, "EULER_ANGLE", "SPIN/NUTATION"), {"a.aem:12", "SPIN/NUTATION", "QUATERNION"}},
      {with(good, "DATA_STOP\n", ""), {"a.aem:16", "no DATA_STOP"}},
      {with(good, " 30\n", "\n"), {"a.aem:17", "2 numbers", "three angles"}},
      {with(good, row, row + row), {"a.aem:18", "rises"}},
      {with(good, "STOP_TIME = 2026-03-01T12:00", "STOP_TIME = 2026-03-01T13:00"),
       {"a.aem:11", "cut off"}},
      {with(good, "= A2B", "= A"), {"a.aem:13", "A2B and B2A"}},
      {aem("ATTITUDE_TYPE = QUATERNION\n", "2026-03-01T12:00:00 0 0 1 1\n", "2.0"),
       {"a.aem:15", "length 1.41421"}},
      {with(good, "12:00:00 10", "12:30:00 10"), {"no attitude at 2026-03-01T12:00:00Z"}},
  };
  for (const auto& one : bad) {
    const std::string said = refusal(one.text);
    EXPECT_TRUE(holds(said, one.says)) << said;
  }
}

}  // namespace
}  // namespace earthshine::scenes
