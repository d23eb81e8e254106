// SPDX-License-Identifier: Apache-2.0
// An orbit in astronomical elements: inclination, node, argument of latitude in the equatorial
// inertial frame (x to the vernal equinox, z to the north pole), and the Sun by right ascension and
// declination. It shares no algebra with scenes/sky/orbit.cpp, which uses the local vertical only.
#pragma once

#include <cmath>
#include <string_view>

#include "scenes/sky/orbit.h"

namespace earthshine::test {

struct EquatorialOrbit {
  double inclination_deg, node_deg, sun_right_ascension_deg, sun_declination_deg;

  [[nodiscard]] static Vec3 about_z(const Vec3& d, double deg) {
    const double c = std::cos(base::radians(deg)), s = std::sin(base::radians(deg));
    return {c * d.x - s * d.y, s * d.x + c * d.y, d.z};
  }
  [[nodiscard]] static Vec3 about_x(const Vec3& d, double deg) {
    const double c = std::cos(base::radians(deg)), s = std::sin(base::radians(deg));
    return {d.x, c * d.y - s * d.z, s * d.y + c * d.z};
  }
  // From the plane of the orbit, x to the ascending node.
  [[nodiscard]] Vec3 in_space(const Vec3& d) const {
    return about_z(about_x(d, inclination_deg), node_deg);
  }
  // Unit vectors; u is the argument of latitude.
  [[nodiscard]] Vec3 position(double u_deg) const { return in_space(about_z({1, 0, 0}, u_deg)); }
  [[nodiscard]] Vec3 velocity(double u_deg) const { return in_space(about_z({0, 1, 0}, u_deg)); }
  [[nodiscard]] Vec3 pole() const { return in_space({0, 0, 1}); }
  [[nodiscard]] Vec3 sun() const {
    const double declination = base::radians(sun_declination_deg);
    return about_z({std::cos(declination), 0.0, std::sin(declination)}, sun_right_ascension_deg);
  }

  // Argument of latitude where the Sun is highest above the spacecraft's horizon.
  [[nodiscard]] double noon_argument_deg() const {
    double best = 0.0;
    for (double u = 0.0; u < 360.0; u += 1.0) {
      if (glm::dot(position(u), sun()) > glm::dot(position(best), sun())) best = u;
    }
    // There the velocity is perpendicular to the Sun: bisects the sign change.
    double low = best - 1.5, high = best + 1.5;
    for (int step = 0; step < 80; ++step) {
      const double middle = 0.5 * (low + high);
      (glm::dot(velocity(middle), sun()) > 0.0 ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }

  [[nodiscard]] scenes::Orbit as_scene_orbit(double altitude_m, std::string_view attitude) const {
    scenes::Orbit orbit;
    orbit.altitude_m = altitude_m;
    orbit.beta_deg = 90.0 - base::degrees(std::acos(glm::dot(pole(), sun())));
    orbit.attitude = attitude;
    orbit.inclination_deg = inclination_deg;
    orbit.noon_argument_deg = noon_argument_deg();
    return orbit;
  }

  // Directions of nose and bay in inertial space.
  struct Pose {
    Vec3 nose, bay;
    [[nodiscard]] Vec3 in_body(const Vec3& d) const {  // x aft, y starboard, z out of the bay
      return {-glm::dot(d, nose), glm::dot(d, glm::cross(nose, bay)), glm::dot(d, bay)};
    }
  };
  [[nodiscard]] Pose pose(std::string_view attitude, double u_deg) const {
    const Vec3 up = position(u_deg), forward = velocity(u_deg);
    if (attitude == "bay-to-earth") return {forward, -up};
    if (attitude == "bay-to-space") return {forward, up};
    if (attitude == "tail-down") return {up, forward};
    // bay-to-sun, with the nose as close to the orbit's north as possible
    const Vec3 side = glm::normalize(glm::cross(pole(), sun()));
    return {glm::cross(sun(), side), sun()};
  }
};

// STS-46 in its first days: 28.5 deg, the Sun some 17 deg north.
inline constexpr EquatorialOrbit sts46_like{28.5, 140.0, 134.0, 17.2};
// High inclinations, a retrograde orbit, the Sun in the south.
inline constexpr EquatorialOrbit some_orbits[] = {
    sts46_like, {51.6, 310.0, 250.0, -22.0}, {98.2, 75.0, 10.0, 4.0}, {5.0, 200.0, 300.0, -20.1}};

}  // namespace earthshine::test
