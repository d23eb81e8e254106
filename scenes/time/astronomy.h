// SPDX-License-Identifier: Apache-2.0
// Time scales, reference frames, and positions of Sun and Moon: the only user of ERFA (Essential
// Routines for Fundamental Astronomy, the IAU's SOFA routines).
//
// Directions and positions are in GCRS axes (equal to ICRF's) from the Earth's centre unless stated
// otherwise. UT1 - UTC is below 0.9 s and given by EarthClock; polar motion, below 0.3 arc seconds,
// is neglected.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "base/units.h"

namespace earthshine::scenes {

// A time, as seconds of TAI since 2000-01-01T00:00:00 TAI: no leap seconds, resolution 0.1 us.
struct Instant {
  double tai_s = 0.0;
  [[nodiscard]] auto operator<=>(const Instant&) const = default;
};
[[nodiscard]] inline Instant operator+(Instant t, double s) { return {t.tai_s + s}; }
[[nodiscard]] inline double operator-(Instant a, Instant b) { return a.tai_s - b.tai_s; }

enum class TimeSystem { Utc, Tai, Tt, Gps, Tdb, Ut1 };
// By its CCSDS name; no value for an unknown name.
[[nodiscard]] std::optional<TimeSystem> time_system_named(std::string_view name);
[[nodiscard]] std::string time_system_names();

// UT1 - UTC, s, from IERS Bulletin A. The default 0 has an error of the Earth's rotation up to
// 0.004 deg.
struct EarthClock {
  double ut1_minus_utc_s = 0.0;
};

// "2026-03-01T12:00:00.5" or "2026-060T12:00:00.5", optionally with Z; second 60 if UTC has it.
// Seconds or the time of day may be omitted. No value for invalid dates and years outside 1972 to
// 2199.
[[nodiscard]] std::optional<Instant> read_instant(std::string_view text, TimeSystem system,
                                                  EarthClock clock = {});
// A Modified Julian Date and seconds of the day, as in CIC files.
[[nodiscard]] std::optional<Instant> instant_of_mjd(double day, double seconds, TimeSystem system,
                                                    EarthClock clock = {});
// "2026-03-01T12:00:00Z", with up to three decimals of the second.
[[nodiscard]] std::string utc_text(Instant t);
[[nodiscard]] double tai_minus_utc_s(Instant t);
// Whether leap seconds may have been announced after ERFA's table was made.
[[nodiscard]] bool leap_seconds_uncertain(Instant t);

enum class Frame {
  Gcrf,     // ICRF, GCRF: GCRS axes
  Eme2000,  // mean equator and equinox of J2000: 0.02 arc seconds from GCRF
  Teme,     // true equator, mean equinox of date, as used by SGP4
  Tod,      // true equator and equinox of date
  Itrf      // rotates with the Earth
};
[[nodiscard]] std::optional<Frame> frame_named(std::string_view name);
[[nodiscard]] std::string frame_names();

struct State {
  Vec3 position_m{0.0}, velocity_m_s{0.0};
};
// Transforms components in `frame` at a time to GCRS; velocity in ITRF is relative to the ground.
[[nodiscard]] glm::dmat3 to_gcrs(Frame frame, Instant t, EarthClock clock);
[[nodiscard]] State to_gcrs(const State& state, Frame frame, Instant t, EarthClock clock);

// Apparent direction of the Sun from the Earth: with light time and annual aberration.
[[nodiscard]] Vec3 sun_direction(Instant t);
[[nodiscard]] double sun_distance_m(Instant t);
[[nodiscard]] Vec3 moon_position_m(Instant t);

// The WGS 84 ellipsoid (NIMA TR8350.2, 2000).
inline constexpr double earth_equator_m = 6378137.0, earth_flattening = 1.0 / 298.257223563;

// The subpoint on the WGS 84 ellipsoid.
struct GroundPoint {
  double latitude_deg = 0.0, longitude_deg = 0.0;  // geodetic; east
  double height_m = 0.0;
};
[[nodiscard]] GroundPoint point_below(const Vec3& position_m, Instant t, EarthClock clock);

}  // namespace earthshine::scenes
