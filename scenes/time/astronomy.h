// SPDX-License-Identifier: Apache-2.0
// Time scales, reference frames, and where Sun and Moon are: the only user of ERFA (Essential
// Routines for Fundamental Astronomy, the IAU's SOFA routines).
//
// Directions and positions are in GCRS axes (the same as ICRF's) from the Earth's centre unless
// said otherwise. UT1 - UTC is below 0.9 s and taken as given by EarthClock; polar motion, below
// 0.3 arc seconds, is left out.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "base/units.h"

namespace earthshine::scenes {

// A moment, as seconds of TAI since 2000-01-01T00:00:00 TAI: without leap seconds, to 0.1 us.
struct Instant {
  double tai_s = 0.0;
  [[nodiscard]] auto operator<=>(const Instant&) const = default;
};
[[nodiscard]] inline Instant operator+(Instant t, double s) { return {t.tai_s + s}; }
[[nodiscard]] inline double operator-(Instant a, Instant b) { return a.tai_s - b.tai_s; }

enum class TimeSystem { Utc, Tai, Tt, Gps, Tdb, Ut1 };
// By its CCSDS name; nothing for one that is not known.
[[nodiscard]] std::optional<TimeSystem> time_system_named(std::string_view name);
[[nodiscard]] std::string time_system_names();

// UT1 - UTC, s. IERS Bulletin A gives it; 0 leaves the Earth's rotation up to 0.004 deg off.
struct EarthClock {
  double ut1_minus_utc_s = 0.0;
};

// "2026-03-01T12:00:00.5" or "2026-060T12:00:00.5", a Z or none, second 60 where UTC has one. The
// seconds may be left out, or the whole time of day. Nothing for what is no date of the years 1972
// to 2199.
[[nodiscard]] std::optional<Instant> read_instant(std::string_view text, TimeSystem system,
                                                  EarthClock clock = {});
// A Modified Julian Date and seconds of its day, as CIC files have them.
[[nodiscard]] std::optional<Instant> instant_of_mjd(double day, double seconds, TimeSystem system,
                                                    EarthClock clock = {});
// "2026-03-01T12:00:00Z", with as many digits of the second as are needed for a millisecond.
[[nodiscard]] std::string utc_text(Instant t);
[[nodiscard]] double tai_minus_utc_s(Instant t);
// Whether leap seconds may have been announced since ERFA's table was made.
[[nodiscard]] bool leap_seconds_uncertain(Instant t);

enum class Frame {
  Gcrf,     // ICRF, GCRF: GCRS axes
  Eme2000,  // mean equator and equinox of J2000: 0.02 arc seconds from GCRF
  Teme,     // true equator, mean equinox of date, as SGP4 has it
  Tod,      // true equator and equinox of date
  Itrf      // turns with the Earth
};
[[nodiscard]] std::optional<Frame> frame_named(std::string_view name);
[[nodiscard]] std::string frame_names();

struct State {
  Vec3 position_m{0.0}, velocity_m_s{0.0};
};
// Components in `frame` at that moment to GCRS; the velocity in ITRF is relative to the ground.
[[nodiscard]] glm::dmat3 to_gcrs(Frame frame, Instant t, EarthClock clock);
[[nodiscard]] State to_gcrs(const State& state, Frame frame, Instant t, EarthClock clock);

// Toward the Sun as it is seen from the Earth: with light time and annual aberration.
[[nodiscard]] Vec3 sun_direction(Instant t);
[[nodiscard]] double sun_distance_m(Instant t);
[[nodiscard]] Vec3 moon_position_m(Instant t);

// The point below, on the ellipsoid of WGS 84.
struct GroundPoint {
  double latitude_deg = 0.0, longitude_deg = 0.0;  // geodetic; east
  double height_m = 0.0;
};
[[nodiscard]] GroundPoint point_below(const Vec3& position_m, Instant t, EarthClock clock);

}  // namespace earthshine::scenes
