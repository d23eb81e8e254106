// SPDX-License-Identifier: Apache-2.0
// Time scales, frames, Sun and Moon against published values.
#include "scenes/time/astronomy.h"

#include <gtest/gtest.h>

#include <cmath>

namespace earthshine::scenes {
namespace {

Instant of_tt(const char* text) { return *read_instant(text, TimeSystem::Tt); }
Instant of_utc(const char* text) { return *read_instant(text, TimeSystem::Utc); }

double apart_deg(const Vec3& a, const Vec3& b) {
  return base::degrees(2.0 * std::atan2(glm::length(a - b), glm::length(a + b)));
}
Vec3 of_angles(double right_ascension_deg, double declination_deg) {
  const double ra = base::radians(right_ascension_deg), dec = base::radians(declination_deg);
  return {std::cos(dec) * std::cos(ra), std::cos(dec) * std::sin(ra), std::sin(dec)};
}
// In the true equator and equinox of date, as in almanacs.
Vec3 of_date(const Vec3& d, Instant t) {
  return glm::transpose(to_gcrs(Frame::Tod, t, {})) * glm::normalize(d);
}

TEST(Astronomy, SunStandsWhereTheAlmanacHasIt) {
  // 1992 October 13, 0h TT: right ascension 13h 13m 30.763s, declination -7 deg 47' 01.74"
  // (Astronomical Almanac 1992, in Meeus, "Astronomical algorithms", example 25.b).
  const Instant t = of_tt("1992-10-13T00:00:00");
  const Vec3 almanac = of_angles(15.0 * (13.0 + 13.0 / 60.0 + 30.763 / 3600.0),
                                 -(7.0 + 47.0 / 60.0 + 1.74 / 3600.0));
  EXPECT_LT(apart_deg(of_date(sun_direction(t), t), almanac), 1.0 / 3600.0);
  // Equinox, to the minute: the Sun's right ascension and declination are 0. It moves 0.0007 deg a
  // minute (US Naval Observatory, "Earth's seasons": 2024 March 20 03:06, 2026 March 20 14:46 UT).
  for (const char* equinox : {"2024-03-20T03:06", "2026-03-20T14:46"}) {
    const Instant at = of_utc(equinox);
    EXPECT_LT(apart_deg(of_date(sun_direction(at), at), {1.0, 0.0, 0.0}), 0.001) << equinox;
  }
}

// The Astronomical Almanac's low-precision formulas for the Sun (page C5), within 0.01 deg from
// 1950 to 2050, each month of two years: n days from J2000, mean longitude L and anomaly g,
// longitude L + 1.915 sin g + 0.020 sin 2g; distance 1.00014 - 0.01671 cos g - 0.00014 cos 2g au,
// within 0.0003.
TEST(Astronomy, SunAgreesWithTheAlmanacsLowPrecisionFormulas) {
  const Instant j2000 = of_tt("2000-01-01T12:00:00");
  for (const char* first : {"1992-01-15T00:00:00", "2026-01-15T00:00:00"}) {
    for (int month = 0; month < 12; ++month) {
      const Instant t = of_tt(first) + 30.4 * 86400.0 * month;
      const double n = (t - j2000) / 86400.0;
      const double g = base::radians(357.528 + 0.9856003 * n);
      const double longitude =
          base::radians(280.460 + 0.9856474 * n + 1.915 * std::sin(g) + 0.020 * std::sin(2.0 * g));
      const double obliquity = base::radians(23.439 - 0.0000004 * n);
      const Vec3 formula(std::cos(longitude), std::cos(obliquity) * std::sin(longitude),
                         std::sin(obliquity) * std::sin(longitude));
      EXPECT_LT(apart_deg(of_date(sun_direction(t), t), formula), 0.011) << first << month;
      const double au = 1.00014 - 0.01671 * std::cos(g) - 0.00014 * std::cos(2.0 * g);
      EXPECT_NEAR(sun_distance_m(t) / 149597870700.0, au, 3e-4) << first << month;
    }
  }
}

TEST(Astronomy, MoonStandsWhereTheAlmanacHasIt) {
  // 1992 April 12, 0h TT: right ascension 134.68847 deg, declination 13.76837 deg, distance
  // 368409.7 km (Meeus, example 47.a).
  const Instant t = of_tt("1992-04-12T00:00:00");
  const Vec3 moon = moon_position_m(t);
  EXPECT_LT(apart_deg(of_date(moon, t), of_angles(134.688470, 13.768368)), 0.001);
  EXPECT_NEAR(glm::length(moon) / 1e3, 368409.7, 20.0);
  // New Moon of the eclipse of 2024 April 8, 18:21 UT (US Naval Observatory): its longitude equals
  // the Sun's and increases by 0.008 deg a minute relative to it.
  const Instant at = of_utc("2024-04-08T18:21");
  const double obliquity = base::radians(23.4385);
  const auto longitude_deg = [&](const Vec3& direction) {
    const Vec3 d = of_date(direction, at);
    return base::degrees(std::atan2(d.y * std::cos(obliquity) + d.z * std::sin(obliquity), d.x));
  };
  EXPECT_NEAR(longitude_deg(moon_position_m(at)), longitude_deg(sun_direction(at)), 0.01);
}

// Vallado, "Fundamentals of astrodynamics and applications", 4th ed., examples 3-14 and 3-15: a
// state of 2004 April 6, 07:51:28.386009 UTC in several frames, km. Neglected here: polar motion,
// 0.36" or 18 m at that distance. The book's TEME and TOD use the nutation of 1980, a difference of
// some 0.1".
TEST(Astronomy, FramesAgreeWithPublishedStates) {
  const Instant t = of_utc("2004-04-06T07:51:28.386009");
  const EarthClock clock{-0.4399619};
  const Vec3 gcrf = 1e3 * Vec3(5102.508958, 6123.011401, 6378.136928);
  const struct {
    Frame frame;
    Vec3 km;
    double allowed_m;
  } published[] = {{Frame::Itrf, {-1033.4793830, 7901.2952754, 6380.3565958}, 20.0},
                   {Frame::Teme, {5094.18016210, 6127.64465950, 6380.34453270}, 10.0},
                   {Frame::Tod, {5094.51478040, 6127.36646120, 6380.34453280}, 10.0},
                   {Frame::Eme2000, {5102.50960000, 6123.01152000, 6378.13630000}, 2.0},
                   {Frame::Gcrf, {5102.508958, 6123.011401, 6378.136928}, 1e-6}};
  for (const auto& one : published) {
    EXPECT_LT(glm::length(to_gcrs(one.frame, t, clock) * (1e3 * one.km) - gcrf), one.allowed_m)
        << one.km.x;
  }
  // Velocities: relative to the ground in ITRF, 3.225636520 km/s etc.
  const State state = to_gcrs(State{1e3 * Vec3(-1033.4793830, 7901.2952754, 6380.3565958),
                                    1e3 * Vec3(-3.225636520, -2.872451450, 5.531924446)},
                              Frame::Itrf, t, clock);
  EXPECT_LT(glm::length(state.velocity_m_s - 1e3 * Vec3(-4.743220161, 0.790536497, 5.533755728)),
            0.05);
}

TEST(Astronomy, BothDateFormsAndAllTimeSystemsNameOneMoment) {
  const Instant t = of_utc("2026-03-01T12:00:00.25");
  EXPECT_EQ(read_instant("2026-060T12:00:00.25Z", TimeSystem::Utc), t);
  EXPECT_EQ(read_instant("2024-366T00:00", TimeSystem::Utc), of_utc("2024-12-31"));
  // TAI - UTC = 37 s since 2017; TT = TAI + 32.184 s; GPS = TAI - 19 s.
  EXPECT_EQ(tai_minus_utc_s(t), 37.0);
  EXPECT_NEAR(*read_instant("2026-03-01T12:00:37.25", TimeSystem::Tai) - t, 0.0, 1e-6);
  EXPECT_NEAR(*read_instant("2026-03-01T12:01:09.434", TimeSystem::Tt) - t, 0.0, 1e-6);
  EXPECT_NEAR(*read_instant("2026-03-01T12:00:18.25", TimeSystem::Gps) - t, 0.0, 1e-6);
  EXPECT_NEAR(*read_instant("2026-03-01T12:00:00.45", TimeSystem::Ut1, {0.2}) - t, 0.0, 1e-6);
  EXPECT_NEAR(*instant_of_mjd(61100.0, 43200.25, TimeSystem::Utc) - t, 0.0, 1e-6);
  EXPECT_EQ(utc_text(t), "2026-03-01T12:00:00.25Z");
  EXPECT_EQ(utc_text(of_utc("1999-12-31T23:59:59.9996")), "2000-01-01T00:00:00Z");
}

TEST(Astronomy, LeapSecondsAreMoments) {
  // 2016 ended with 23:59:60.
  const Instant before = of_utc("2016-12-31T23:59:59"), leap = of_utc("2016-12-31T23:59:60"),
                after = of_utc("2017-01-01T00:00:00");
  EXPECT_NEAR(leap - before, 1.0, 1e-6);
  EXPECT_NEAR(after - before, 2.0, 1e-6);
  EXPECT_EQ(utc_text(leap), "2016-12-31T23:59:60Z");
  EXPECT_FALSE(read_instant("2015-12-31T23:59:60", TimeSystem::Utc));
}

TEST(Astronomy, WhatIsNoDateIsNotRead) {
  for (const char* text :
       {"", "2026", "2026-13-01", "2026-02-30T00:00:00", "2026-366T00:00:00", "2026-3-1T00:00:00",
        "2026-03-01 12:00:00", "2026-03-01T24:00:00", "2026-03-01T12:60:00", "2026-03-01T12:00:61",
        "1971-12-31T00:00:00", "2026-03-01T12:00:0x", "2026-03-01T12:00:00+01:00", "nan",
        "2026-03-01T", "2026-03-01T12", "-026-03-01T12:00:00"}) {
    EXPECT_FALSE(read_instant(text, TimeSystem::Utc)) << text;
  }
}

TEST(Astronomy, GroundPointOfTheZeroMeridian) {
  const Instant t = of_utc("2026-03-01T12:00:00");
  // At the equator the ellipsoid's radius is 6378137 m.
  const Vec3 above = to_gcrs(Frame::Itrf, t, {}) * Vec3(6778137.0, 0.0, 0.0);
  const GroundPoint point = point_below(above, t, {});
  EXPECT_NEAR(point.latitude_deg, 0.0, 1e-9);
  EXPECT_NEAR(point.longitude_deg, 0.0, 1e-9);
  EXPECT_NEAR(point.height_m, 400e3, 1e-3);
}

// To the nearest millisecond, also over the end of a day and of a leap second.
TEST(Astronomy, DatesAreRoundedOnce) {
  const std::pair<const char*, const char*> rounded[] = {
      {"2026-03-01T12:00:00.123456", "2026-03-01T12:00:00.123Z"},
      {"2026-03-01T12:00:00.123499", "2026-03-01T12:00:00.123Z"},
      {"2026-03-01T12:00:00.123501", "2026-03-01T12:00:00.124Z"},
      {"2026-03-01T12:00:00.0996", "2026-03-01T12:00:00.1Z"},
      {"2026-03-01T12:00:00.000499", "2026-03-01T12:00:00Z"},
      {"2026-03-01T23:59:59.9996", "2026-03-02T00:00:00Z"},
      {"2016-12-31T23:59:59.9996", "2016-12-31T23:59:60Z"},
      {"2016-12-31T23:59:60.4994", "2016-12-31T23:59:60.499Z"},
      {"2016-12-31T23:59:60.9996", "2017-01-01T00:00:00Z"}};
  for (const auto& [exact, text] : rounded) EXPECT_EQ(utc_text(of_utc(exact)), text) << exact;
}

}  // namespace
}  // namespace earthshine::scenes
