// SPDX-License-Identifier: Apache-2.0
// Orbit ephemeris messages of two-body orbits, for tests.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "scenes/sky/orbit.h"
#include "scenes/time/astronomy.h"

namespace earthshine::test {

// An ellipse about the Earth in GCRS axes.
struct Ellipse {
  double semi_major_m = 6771e3;
  double eccentricity = 0.0;
  double inclination_deg = 51.6;
  double node_deg = 40.0;

  [[nodiscard]] double mean_motion_rad_s() const {
    return std::sqrt(scenes::earth_gm_m3_s2 / semi_major_m) / semi_major_m;
  }
  // Seconds after the perigee, which is at the ascending node; by Kepler's equation.
  [[nodiscard]] scenes::State at(double s) const {
    const double mean = mean_motion_rad_s() * s, e = eccentricity;
    double anomaly = mean;
    for (int step = 0; step < 50; ++step) {
      anomaly -= (anomaly - e * std::sin(anomaly) - mean) / (1.0 - e * std::cos(anomaly));
    }
    const double rate = mean_motion_rad_s() / (1.0 - e * std::cos(anomaly));
    const double across = std::sqrt(1.0 - e * e), a = semi_major_m;
    const double node = base::radians(node_deg), i = base::radians(inclination_deg);
    const Vec3 p(std::cos(node), std::sin(node), 0.0);
    const Vec3 q(-std::sin(node) * std::cos(i), std::cos(node) * std::cos(i), std::sin(i));
    return {a * ((std::cos(anomaly) - e) * p + across * std::sin(anomaly) * q),
            a * rate * (-std::sin(anomaly) * p + across * std::cos(anomaly) * q)};
  }
};

inline std::string oem_row(const std::string& date, const scenes::State& state) {
  const Vec3 r = state.position_m / 1e3, v = state.velocity_m_s / 1e3;
  return fmt::format("{} {:.9f} {:.9f} {:.9f} {:.12f} {:.12f} {:.12f}\n", date, r.x, r.y, r.z, v.x,
                     v.y, v.z);
}

inline std::string oem_meta(const std::string& start, const std::string& stop,
                            const std::string& frame = "GCRF", const std::string& more = "") {
  return fmt::format(
      "META_START\nOBJECT_NAME = TEST\nOBJECT_ID = 2026-001A\nCENTER_NAME = EARTH\n"
      "REF_FRAME = {}\nTIME_SYSTEM = UTC\nSTART_TIME = {}\nSTOP_TIME = {}\n{}META_STOP\n",
      frame, start, stop, more);
}

inline constexpr const char* oem_head =
    "CCSDS_OEM_VERS = 2.0\nCREATION_DATE = 2026-01-01T00:00:00\nORIGINATOR = TEST\n";

// `count` states of the ellipse every `step_s` from `start` on. `start` has integer seconds.
inline std::string oem_of(const Ellipse& ellipse, scenes::Instant start, double step_s, int count,
                          const std::string& more = "") {
  std::string rows, last;
  for (int k = 0; k < count; ++k) {
    last = scenes::utc_text(start + step_s * k);
    rows += oem_row(last, ellipse.at(step_s * k));
  }
  return oem_head + oem_meta(scenes::utc_text(start), last, "GCRF", more) + rows;
}

}  // namespace earthshine::test
