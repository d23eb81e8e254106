// SPDX-License-Identifier: Apache-2.0
#include "scenes/time/astronomy.h"

#include <erfa.h>
#include <erfam.h>
#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>

namespace earthshine::scenes {
namespace {

constexpr double day_s = 86400.0;
constexpr double jd_2000 = 2451544.5;                   // 2000-01-01T00:00:00
constexpr double astronomical_unit_m = 1.495978707e11;  // IAU 2012 resolution B2
constexpr double light_au_per_day = 173.144632674;      // 299792458 m/s
constexpr double tt_minus_tai_s = 32.184;
constexpr double tai_minus_gps_s = 19.0;
constexpr double earth_rate_rad_s = 7.292115e-5;  // WGS 84

constexpr std::pair<std::string_view, TimeSystem> time_systems[] = {
    {"UTC", TimeSystem::Utc}, {"TAI", TimeSystem::Tai}, {"TT", TimeSystem::Tt},
    {"GPS", TimeSystem::Gps}, {"TDB", TimeSystem::Tdb}, {"UT1", TimeSystem::Ut1}};
constexpr std::pair<std::string_view, Frame> frames[] = {
    {"EME2000", Frame::Eme2000}, {"J2000", Frame::Eme2000}, {"ICRF", Frame::Gcrf},
    {"GCRF", Frame::Gcrf},       {"TEME", Frame::Teme},     {"TEMEOFDATE", Frame::Teme},
    {"TOD", Frame::Tod},         {"TOD_EARTH", Frame::Tod}, {"ITRF", Frame::Itrf}};

std::string upper_case(std::string_view text) {
  std::string upper(text);
  for (char& c : upper) {
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  }
  return upper;
}

template <class Table>
auto named(const Table& table, std::string_view name)
    -> std::optional<decltype(std::begin(table)->second)> {
  for (const auto& [known, value] : table) {
    if (known == name) return value;
  }
  return std::nullopt;
}

template <class Table>
std::string names_of(const Table& table) {
  std::string text;
  for (const auto& [name, value] : table) text += (text.empty() ? "" : ", ") + std::string(name);
  return text;
}

// Julian dates in two parts; the first one is an integer or half-integer.
struct Date {
  double whole, rest;
};
Date tai_date(Instant t) {
  const double days = std::floor(t.tai_s / day_s);
  return {jd_2000 + days, (t.tai_s - days * day_s) / day_s};
}
Date tt_date(Instant t) { return tai_date(t + tt_minus_tai_s); }
Date utc_date(Instant t) {
  const Date tai = tai_date(t);
  Date utc{};
  eraTaiutc(tai.whole, tai.rest, &utc.whole, &utc.rest);
  return utc;
}
Date ut1_date(Instant t, EarthClock clock) {
  const Date utc = utc_date(t);
  Date ut1{};
  eraUtcut1(utc.whole, utc.rest, clock.ut1_minus_utc_s, &ut1.whole, &ut1.rest);
  return ut1;
}

// ERFA's matrices are stored by rows, GLM's by columns.
glm::dmat3 matrix_of(const double rows[3][3]) {
  glm::dmat3 m;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) m[column][row] = rows[row][column];
  }
  return m;
}
Vec3 vector_of(const double v[3]) { return {v[0], v[1], v[2]}; }

// Calendar date in the given scale to TAI.
std::optional<Instant> instant_of(int year, int month, int day, int hour, int minute, double second,
                                  TimeSystem system, EarthClock clock) {
  Date date{};
  const char* const scale = system == TimeSystem::Utc ? "UTC" : "TAI";
  // Negative status: the date does not exist. +1 and +2: a distant year, or a time after the day's
  // end.
  const int status =
      eraDtf2d(scale, year, month, day, hour, minute, second, &date.whole, &date.rest);
  if (status < 0 || status == 2 || status == 3) return std::nullopt;
  if (system == TimeSystem::Utc) {
    Date tai{};
    if (eraUtctai(date.whole, date.rest, &tai.whole, &tai.rest) < 0) return std::nullopt;
    date = tai;
  }
  const Instant read{(date.whole - jd_2000) * day_s + date.rest * day_s};
  switch (system) {
    case TimeSystem::Utc:
    case TimeSystem::Tai:
      return read;
    case TimeSystem::Tt:
    case TimeSystem::Tdb:
      return read + -tt_minus_tai_s;  // TDB is within 2 ms of TT
    case TimeSystem::Gps:
      return read + tai_minus_gps_s;
    case TimeSystem::Ut1: {
      const auto utc = instant_of(year, month, day, hour, minute, second, TimeSystem::Utc, clock);
      if (!utc) return std::nullopt;
      return *utc + -clock.ut1_minus_utc_s;
    }
  }
  return std::nullopt;
}

// "2026-03-01" or "2026-060".
struct Day {
  int year = 0, month = 0, day = 0;
};
std::optional<int> digits(std::string_view text, std::size_t from, std::size_t count) {
  if (text.size() < from + count) return std::nullopt;
  int value = 0;
  const char* const first = text.data() + from;
  const auto [end, error] = std::from_chars(first, first + count, value);
  if (error != std::errc() || end != first + count || *first == '-') return std::nullopt;
  return value;
}
std::optional<Day> read_day(std::string_view text) {
  const auto year = digits(text, 0, 4);
  if (!year || *year < 1972 || *year > 2199 || text.size() < 8 || text[4] != '-') {
    return std::nullopt;
  }
  if (text.size() == 10 && text[7] == '-') {
    const auto month = digits(text, 5, 2), day = digits(text, 8, 2);
    if (!month || !day) return std::nullopt;
    return Day{*year, *month, *day};
  }
  const auto of_year = digits(text, 5, 3);
  const bool leap = *year % 4 == 0 && (*year % 100 != 0 || *year % 400 == 0);
  if (text.size() != 8 || !of_year || *of_year < 1 || *of_year > (leap ? 366 : 365)) {
    return std::nullopt;
  }
  double first = 0.0, zero = 0.0, fraction = 0.0;
  Day day;
  if (eraCal2jd(*year, 1, 1, &zero, &first) != 0) return std::nullopt;
  eraJd2cal(zero, first + *of_year - 1, &day.year, &day.month, &day.day, &fraction);
  return day;
}

}  // namespace

std::optional<TimeSystem> time_system_named(std::string_view name) {
  return named(time_systems, upper_case(name));
}
std::string time_system_names() { return names_of(time_systems); }

std::optional<Frame> frame_named(std::string_view name) {
  const std::string upper = upper_case(name);
  if (const auto frame = named(frames, upper)) return frame;
  // Realisations differ by centimetres: ITRF2014, ITRF-97, ICRF3.
  for (const std::string_view start : {"ITRF", "ICRF", "GCRF"}) {
    if (!upper.starts_with(start)) continue;
    std::string_view rest = std::string_view(upper).substr(4);
    if (rest.starts_with('-')) rest.remove_prefix(1);
    if (!rest.empty() && rest.size() <= 4 &&
        rest.find_first_not_of("0123456789") == std::string_view::npos) {
      return named(frames, start);
    }
  }
  return std::nullopt;
}
std::string frame_names() { return names_of(frames) + ", ITRF and ICRF of a year"; }

std::optional<Instant> read_instant(std::string_view text, TimeSystem system, EarthClock clock) {
  if (text.ends_with('Z')) text.remove_suffix(1);
  const std::size_t t = text.find('T');
  const auto day = read_day(text.substr(0, t));
  if (!day) return std::nullopt;
  int hour = 0, minute = 0;
  double second = 0.0;
  if (t != std::string_view::npos) {
    const std::string_view time = text.substr(t + 1);
    const auto h = digits(time, 0, 2), m = digits(time, 3, 2);
    if (!h || !m || time[2] != ':') return std::nullopt;
    hour = *h;
    minute = *m;
    if (time.size() != 5) {
      if (time.size() < 8 || time[5] != ':' || !digits(time, 6, 2)) return std::nullopt;
      const char* const end = time.data() + time.size();
      const auto read = std::from_chars(time.data() + 6, end, second, std::chars_format::fixed);
      if (read.ec != std::errc() || read.ptr != end) return std::nullopt;
    }
  }
  return instant_of(day->year, day->month, day->day, hour, minute, second, system, clock);
}

std::optional<Instant> instant_of_mjd(double day, double seconds, TimeSystem system,
                                      EarthClock clock) {
  if (!(day >= 41317.0 && day <= 124957.0) || std::floor(day) != day) return std::nullopt;
  if (!(seconds >= 0.0 && seconds < day_s + 1.0)) return std::nullopt;
  int year = 0, month = 0, day_of_month = 0;
  double fraction = 0.0;
  eraJd2cal(2400000.5, day, &year, &month, &day_of_month, &fraction);
  const int hour = std::min(23, static_cast<int>(seconds / 3600.0));
  const int minute = std::min(59, static_cast<int>((seconds - 3600.0 * hour) / 60.0));
  return instant_of(year, month, day_of_month, hour, minute,
                    seconds - 3600.0 * hour - 60.0 * minute, system, clock);
}

std::string utc_text(Instant t) {
  const Date utc = utc_date(t);
  int year = 0, month = 0, day = 0;
  int part[4] = {};
  eraD2dtf("UTC", 3, utc.whole, utc.rest, &year, &month, &day, part);  // rounds
  std::string text = fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}", year, month, day, part[0],
                                 part[1], part[2]);
  const int milliseconds = part[3];
  if (milliseconds > 0) text += fmt::format(".{:03}", milliseconds);
  while (milliseconds > 0 && text.back() == '0') text.pop_back();
  return text + "Z";
}

double tai_minus_utc_s(Instant t) {
  const Date utc = utc_date(t);
  int year = 0, month = 0, day = 0;
  double fraction = 0.0, difference = 0.0;
  eraJd2cal(utc.whole, utc.rest, &year, &month, &day, &fraction);
  eraDat(year, month, day, 0.0, &difference);
  return difference;
}

bool leap_seconds_uncertain(Instant t) {
  const Date utc = utc_date(t);
  int year = 0, month = 0, day = 0;
  double fraction = 0.0, difference = 0.0;
  eraJd2cal(utc.whole, utc.rest, &year, &month, &day, &fraction);
  return eraDat(year, month, day, 0.0, &difference) > 0;
}

glm::dmat3 to_gcrs(Frame frame, Instant t, EarthClock clock) {
  const Date tt = tt_date(t);
  double m[3][3];
  switch (frame) {
    case Frame::Gcrf:
      return glm::dmat3(1.0);
    case Frame::Eme2000: {
      double precession[3][3], both[3][3];
      eraBp06(tt.whole, tt.rest, m, precession, both);  // m: frame bias, GCRS to J2000
      return glm::transpose(matrix_of(m));
    }
    case Frame::Tod:
      eraPnm06a(tt.whole, tt.rest, m);
      return glm::transpose(matrix_of(m));
    case Frame::Teme: {
      // The mean equinox lies east of the true one, along the true equator, by the equation of the
      // equinoxes: Vallado, "Fundamentals of astrodynamics and applications", 4th ed., 3.7.
      eraPnm06a(tt.whole, tt.rest, m);
      eraRz(eraEe06a(tt.whole, tt.rest), m);
      return glm::transpose(matrix_of(m));
    }
    case Frame::Itrf: {
      const Date ut1 = ut1_date(t, clock);
      eraC2t06a(tt.whole, tt.rest, ut1.whole, ut1.rest, 0.0, 0.0, m);
      return glm::transpose(matrix_of(m));
    }
  }
  return glm::dmat3(1.0);
}

State to_gcrs(const State& state, Frame frame, Instant t, EarthClock clock) {
  const glm::dmat3 rotation = to_gcrs(frame, t, clock);
  Vec3 velocity = state.velocity_m_s;
  if (frame == Frame::Itrf) {
    velocity += glm::cross(Vec3(0.0, 0.0, earth_rate_rad_s), state.position_m);
  }
  return {rotation * state.position_m, rotation * velocity};
}

Vec3 sun_direction(Instant t) {
  const Date tt = tt_date(t);
  double heliocentric[2][3], barycentric[2][3], seen[3];
  eraEpv00(tt.whole, tt.rest, heliocentric, barycentric);  // of the Earth, au and au/day
  const Vec3 sun = -vector_of(heliocentric[0]);
  const double distance = glm::length(sun);
  const Vec3 direction = sun / distance, velocity = vector_of(barycentric[1]) / light_au_per_day;
  double natural[3] = {direction.x, direction.y, direction.z};
  double speed[3] = {velocity.x, velocity.y, velocity.z};
  eraAb(natural, speed, distance, std::sqrt(1.0 - glm::dot(velocity, velocity)), seen);
  return glm::normalize(vector_of(seen));
}

double sun_distance_m(Instant t) {
  const Date tt = tt_date(t);
  double heliocentric[2][3], barycentric[2][3];
  eraEpv00(tt.whole, tt.rest, heliocentric, barycentric);
  return glm::length(vector_of(heliocentric[0])) * astronomical_unit_m;
}

Vec3 moon_position_m(Instant t) {
  const Date tt = tt_date(t);
  double geocentric[2][3];
  eraMoon98(tt.whole, tt.rest, geocentric);
  return vector_of(geocentric[0]) * astronomical_unit_m;
}

GroundPoint point_below(const Vec3& position_m, Instant t, EarthClock clock) {
  const Vec3 fixed = glm::transpose(to_gcrs(Frame::Itrf, t, clock)) * position_m;
  double xyz[3] = {fixed.x, fixed.y, fixed.z};
  double longitude = 0.0, latitude = 0.0, height = 0.0;
  eraGc2gd(ERFA_WGS84, xyz, &longitude, &latitude, &height);
  return {base::degrees(latitude), base::degrees(longitude), height};
}

}  // namespace earthshine::scenes
