// SPDX-License-Identifier: Apache-2.0
#include "scenes/time/trajectory.h"

#include <algorithm>
#include <cmath>

#include "tests/scenes/scene_text.h"
#include "tests/scenes/time/oem_text.h"

namespace earthshine::scenes {
namespace {

using test::Ellipse;
using test::holds;
using test::oem_head;
using test::oem_meta;
using test::oem_of;
using test::oem_row;

const Instant start = *read_instant("2026-03-01T12:00:00", TimeSystem::Utc);

class TrajectoryFile : public ::testing::Test {
 protected:
  Trajectory read(const std::string& text) {
    folder.put("t.oem", text);
    return read_trajectory(folder.path() / "t.oem", {}, base::Location{"scene.toml", 3, 1},
                           warnings);
  }
  // The error for the file, or for a state of it.
  std::string refusal(const std::string& text, std::optional<Instant> at = std::nullopt) {
    try {
      const Trajectory read_one = read(text);
      if (at) (void)read_one.at(*at);
    } catch (const base::Error& error) {
      return error.what();
    }
    return "was not refused";
  }
  test::SceneFolder folder;
  std::vector<std::string> warnings;
};

// Rounding of a row: 1e-6 m and 1e-9 m/s.
TEST_F(TrajectoryFile, GivesItsOwnStates) {
  const Ellipse ellipse;
  const Trajectory read_one = read(oem_of(ellipse, start, 240.0, 24));
  for (const int k : {0, 1, 12, 23}) {
    const State found = read_one.at(start + 240.0 * k), wanted = ellipse.at(240.0 * k);
    EXPECT_LT(glm::length(found.position_m - wanted.position_m), 1e-2) << k;
    EXPECT_LT(glm::length(found.velocity_m_s - wanted.velocity_m_s), 1e-5) << k;
  }
}

// The error of a polynomial through n + 1 nodes is (R w^(n+1) / (n+1)!) prod |t - node|. With a
// step of h = 240 s = 0.271 rad of a circle of 6771 km: in the middle of four Hermite nodes R h^8
// (1/2 1/2 3/2 3/2)^2 / 8! = 0.0016 m, of eight Lagrange nodes R h^8 (1/2 3/2 5/2 7/2)^2 / 8! =
// 0.21 m, of two Lagrange nodes R h^2 / 8 = 62 km. The error of the velocity is at most 8 and 2
// times this, divided by the step: times w / h.
TEST_F(TrajectoryFile, InterpolatesAsTheFileAsks) {
  const Ellipse circle;
  const struct {
    const char* ask;
    double least_m, most_m;
  } asked[] = {{"", 0.0, 0.002},
               {"INTERPOLATION = HERMITE\nINTERPOLATION_DEGREE = 7\n", 0.0, 0.002},
               {"INTERPOLATION = Lagrange\nINTERPOLATION_DEGREE = 7\n", 0.01, 0.25},
               {"INTERPOLATION = HERMITE\nINTERPOLATION_DEGREE = 3\n", 1.0, 110.0},
               {"INTERPOLATION = LINEAR\n", 1e4, 63e3}};
  for (const auto& one : asked) {
    const Trajectory read_one = read(oem_of(circle, start, 240.0, 24, one.ask));
    const double middle = 240.0 * 11.5;
    const State found = read_one.at(start + middle), wanted = circle.at(middle);
    const double off = glm::length(found.position_m - wanted.position_m);
    EXPECT_LE(off, one.most_m) << one.ask;
    EXPECT_GE(off, one.least_m) << one.ask;
    EXPECT_LT(glm::length(found.velocity_m_s - wanted.velocity_m_s), 8.0 * one.most_m / 240.0)
        << one.ask;
  }
}

TEST_F(TrajectoryFile, AnEllipseIsMetBetweenItsStates) {
  const Ellipse ellipse{7500e3, 0.1, 63.4, 200.0};
  const Trajectory read_one = read(oem_of(ellipse, start, 60.0, 120));
  for (double s = 15.0; s < 7000.0; s += 613.0) {
    EXPECT_LT(glm::length(read_one.at(start + s).position_m - ellipse.at(s).position_m), 1e-3) << s;
  }
}

// The second segment follows another ellipse: it is valid at the common time, the first one just
// before. Interpolation does not cross segments.
TEST_F(TrajectoryFile, NothingIsInterpolatedAcrossSegments) {
  const Ellipse before, after{6771e3, 0.0, 51.6, 43.0};
  std::string text = oem_of(before, start, 60.0, 11);
  std::string second = oem_of(after, start + 600.0, 60.0, 11);
  text += second.substr(second.find("META_START"));
  const Trajectory read_one = read(text);
  EXPECT_LT(glm::length(read_one.at(start + 599.0).position_m - before.at(599.0).position_m), 0.01);
  EXPECT_LT(glm::length(read_one.at(start + 600.0).position_m - after.at(0.0).position_m), 0.01);
  EXPECT_LT(glm::length(read_one.at(start + 601.0).position_m - after.at(1.0).position_m), 0.01);

  second = oem_of(after, start + 700.0, 60.0, 11);
  text = oem_of(before, start, 60.0, 11) + second.substr(second.find("META_START"));
  EXPECT_TRUE(holds(refusal(text, start + 650.0),
                    {"t.oem", "no state at 2026-03-01T12:10:50Z", "nothing is interpolated",
                     "2026-03-01T12:00:00Z to 2026-03-01T12:10:00Z"}));
}

// XML and CIC's form give exactly the states of the same message in KVN.
TEST_F(TrajectoryFile, OtherFormsHoldTheSameStates) {
  const Ellipse ellipse;
  const Trajectory kvn = read(oem_of(ellipse, start, 60.0, 8));
  std::string xml =
      "<?xml version=\"1.0\"?>\n<!-- a test -->\n<oem id=\"CCSDS_OEM_VERS\" version=\"2.0\">\n"
      "<header><ORIGINATOR>T</ORIGINATOR></header><body><segment><metadata>\n";
  for (const auto& [key, value] : {std::pair{"OBJECT_NAME", "TEST"},
                                   {"OBJECT_ID", "2026-001A"},
                                   {"CENTER_NAME", "EARTH"},
                                   {"REF_FRAME", "GCRF"},
                                   {"TIME_SYSTEM", "UTC"},
                                   {"START_TIME", "2026-060T12:00:00"},
                                   {"STOP_TIME", "2026-060T12:07:00"}}) {
    xml += fmt::format("<{0}>{1}</{0}>\n", key, value);
  }
  xml += "</metadata><data>\n";
  std::string cic = "CIC_OEM_VERS = 2.0\n" + oem_meta("2026-03-01T12:00:00", "2026-03-01T12:07:00");
  for (int k = 0; k < 8; ++k) {
    const std::string row = oem_row("", ellipse.at(60.0 * k));
    cic += fmt::format("61100 {}{}", 43200 + 60 * k, row);
    xml += fmt::format("<stateVector><EPOCH>2026-060T12:{:02}:00</EPOCH>", k);
    std::string_view rest = row;
    for (const char* name : {"X", "Y", "Z", "X_DOT", "Y_DOT", "Z_DOT"}) {
      rest.remove_prefix(rest.find_first_not_of(" \n"));
      const std::string_view word = rest.substr(0, rest.find_first_of(" \n"));
      const char* const unit = std::string_view(name).size() == 1 ? "km" : "km/s";
      xml += fmt::format("<{0} units=\"{1}\">{2}</{0}>", name, unit, word);
      rest.remove_prefix(word.size());
    }
    xml += "</stateVector>\n";
  }
  xml += "</data></segment></body></oem>\n";
  for (const std::string& other : {xml, cic}) {
    const Trajectory found = read(other);
    for (const double s : {0.0, 30.0, 100.0, 420.0}) {
      EXPECT_EQ(found.at(start + s).position_m, kvn.at(start + s).position_m) << s;
    }
  }
  EXPECT_TRUE(holds(refusal(xml.substr(0, xml.size() - 40)), {"t.oem:", "cut off"}));
  std::string metres = xml;
  metres.replace(metres.find("units=\"km\""), 10, "units=\"m\"");
  EXPECT_TRUE(holds(refusal(metres), {"t.oem:13", "X is in \"m\"", "km"}));
}

TEST_F(TrajectoryFile, BadFilesAreRefusedInOneLine) {
  const std::string good = oem_of(Ellipse{}, start, 60.0, 5);
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  };
  const std::size_t row = good.find("2026-03-01T12:02:00Z ", good.find("META_STOP"));
  const struct {
    std::string text;
    std::vector<std::string> says;
  } bad[] = {
      {good.substr(0, good.size() - 60), {"t.oem:17", "numbers behind its date", "X Y Z in km"}},
      {good.substr(0, good.rfind("2026-03-01T12:04:00Z")),
       {"t.oem:11", "STOP_TIME is 2026-03-01T12:04:00Z", "cut off"}},
      {good.substr(0, good.find("META_STOP")), {"t.oem:4", "no META_STOP"}},
      {with("EARTH", "MARS"), {"t.oem:7", "MARS", "EARTH"}},
      {with("= GCRF", "= MOD"), {"t.oem:8", "REF_FRAME is \"MOD\"", "EME2000", "TEME", "ITRF"}},
      {with("= UTC", "= SCLK"), {"t.oem:9", "TIME_SYSTEM is \"SCLK\"", "UTC, TAI, TT, GPS"}},
      {with("OEM_VERS = 2.0", "OEM_VERS = 4.0"), {"t.oem:1", "4.0", "1.0, 2.0 and 3.0"}},
      {with("CCSDS_OEM", "CCSDS_OPM"), {"t.oem:1", "CCSDS_OPM_VERS", "begins with CCSDS_OEM_VERS"}},
      {good.substr(0, row) + good.substr(row).replace(0, 19, "2026-03-01T11:02:00"),
       {"t.oem:15", "11:02:00Z stands after that of 2026-03-01T12:01:00Z", "rises"}},
      {good.substr(0, row) + "2026-03-01T12:02:00 nan" + good.substr(good.find(' ', row + 21)),
       {"t.oem:15", "\"nan\" is no number"}},
      {good.substr(0, row) + "2026-13-01T12:02:00" + good.substr(row + 19),
       {"t.oem:15", "is no date", "2026-060T12:00:00"}},
      {with("STOP_TIME = 2026", "INTERPOLATION = PROPAGATE\nSTOP_TIME = 2026"),
       {"t.oem:11", "PROPAGATE", "LINEAR, LAGRANGE and HERMITE"}},
      {with("STOP_TIME = 2026",
            "INTERPOLATION = LAGRANGE\nINTERPOLATION_DEGREE = 7\nSTOP_TIME = 2026"),
       {"t.oem:4", "has 5 states", "degree 7 needs 8"}},
      {oem_head + oem_meta("2026-03-01T12:00:00", "2026-03-01T12:00:00") +
           oem_row("2026-03-01T12:00:00", {Vec3(6.771e9, 0, 0), Vec3(0, 7.5e6, 0)}),
       {"t.oem:13", "6.771e+06 km from the Earth's centre", "km and km/s"}},
      {oem_head + oem_meta("2026-03-01T12:00:00", "2026-03-01T12:00:00") +
           oem_row("2026-03-01T12:00:00", {Vec3(6.771e6, 0, 0), Vec3(-7.5e3, 0, 0)}),
       {"t.oem:13", "no part across the position"}},
      // Above the polar radius of 6357 km and below the equatorial one of 6378 km.
      {oem_head + oem_meta("2026-03-01T12:00:00", "2026-03-01T12:00:00") +
           oem_row("2026-03-01T12:00:00", {Vec3(6.36e6, 0, 0), Vec3(0, 7.5e3, 0)}),
       {"t.oem:13", "6360 km from the Earth's centre", "from the ground"}},
      {good.substr(0, row) + "2026-03-01T12:02:00 1 " + good.substr(row + 21),
       {"t.oem:15", "a row with 7 numbers", "with or without accelerations"}},
      {good + good.substr(good.find("META_START")), {"t.oem:18", "before", "follow each other"}},
      {good + oem_meta("2026-03-01T12:04:00", "2026-03-01T12:04:00", "TEME") +
           good.substr(good.rfind("2026-03-01T12:04:00Z")),
       {"t.oem:22", "REF_FRAME is TEME after GCRF", "one frame"}},
      {"", {"t.oem", "no lines"}},
  };
  for (const auto& one : bad) {
    const std::string said = refusal(one.text);
    EXPECT_TRUE(holds(said, one.says)) << said;
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 0) << said;
  }
}

// 36 deg of a circle of 6771 km are 554 s.
TEST_F(TrajectoryFile, GapsAreRefusedWhereAStateIsAskedFor) {
  std::string text = oem_of(Ellipse{}, start, 60.0, 40);
  const std::size_t rows = text.find("META_STOP");
  const std::size_t from = text.find("2026-03-01T12:10:00Z", rows);
  const std::size_t to = text.find("2026-03-01T12:20:00Z", rows);
  text.erase(from, to - from);
  EXPECT_EQ(refusal(text, start + 480.0), "was not refused");
  EXPECT_TRUE(
      holds(refusal(text, start + 700.0), {"t.oem:23", "gap of 660 s", "12:09:00Z", "36 deg"}));
}

// An ellipse of eccentricity 0.7 and 37 000 s with states every 2500 s. Around its apogee 2500 s
// are less than 36 deg; the last step before the perigee begins slowly and ends fast.
TEST_F(TrajectoryFile, GapsBeforeAPerigeeAreRefused) {
  Ellipse ellipse;
  ellipse.semi_major_m = 24000e3;
  ellipse.eccentricity = 0.7;
  const double period = 2.0 * base::pi / ellipse.mean_motion_rad_s();
  const std::string text = oem_of(ellipse, start, 2500.0, 16);
  EXPECT_EQ(refusal(text, start + 0.5 * period), "was not refused");
  const double last = 2500.0 * std::floor(period / 2500.0);
  EXPECT_LT(last - 2500.0, period);
  EXPECT_TRUE(holds(refusal(text, start + (last - 100.0)), {"t.oem", "gap of 2500 s", "36 deg"}));
}

TEST_F(TrajectoryFile, UnknownKeywordsAreNamed) {
  (void)read(oem_of(Ellipse{}, start, 60.0, 5, "SOLAR_FLUX = 120\n"));
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(holds(warnings[0], {"t.oem", "SOLAR_FLUX"}));
}

}  // namespace
}  // namespace earthshine::scenes
