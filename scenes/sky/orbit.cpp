// SPDX-License-Identifier: Apache-2.0
#include "scenes/sky/orbit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenes/sky/sky.h"

namespace earthshine::scenes {
namespace {

// Components of vectors along (velocity, normal, zenith): a right-handed frame.
const Vec3 velocity(1.0, 0.0, 0.0), normal(0.0, 1.0, 0.0), zenith(0.0, 0.0, 1.0);

Vec3 sun_at(double beta_deg, double position_deg) {
  const double beta = base::radians(beta_deg);
  const double position = base::radians(position_deg);
  return {-std::cos(beta) * std::sin(position), std::sin(beta),
          std::cos(beta) * std::cos(position)};
}

// Transforms from the local-vertical frame at one position to the frame at another: it rotates
// about the normal, velocity away from the zenith, by the angle that the spacecraft travels.
Vec3 carried(const Vec3& d, double from_deg, double to_deg) {
  const double angle = base::radians(to_deg - from_deg);
  const double cosine = std::cos(angle), sine = std::sin(angle);
  return {cosine * d.x - sine * d.z, d.y, sine * d.x + cosine * d.z};
}

glm::dquat rotation_at(const AttitudeTable& table, double at, double position_deg) {
  if (table.at.size() == 1) return table.rotations[0];
  if (!(at >= table.at.front() && at <= table.at.back())) {
    const char* const column = table.by_time ? "time_s" : "position_deg";
    throw base::Error(
        base::Blame::Input, table.file,
        fmt::format("no attitude at position_deg = {:.10g}{}", position_deg,
                    table.by_time ? fmt::format(", which is time_s = {:.10g}", at) : ""),
        fmt::format("its rows go from {} {:.10g} to {:.10g}", column, table.at.front(),
                    table.at.back()),
        "Add rows, or keep to positions between them");
  }
  const auto after = std::upper_bound(table.at.begin() + 1, table.at.end() - 1, at);
  const auto row = static_cast<std::size_t>(after - table.at.begin());
  const double share = (at - table.at[row - 1]) / (table.at[row] - table.at[row - 1]);
  return glm::normalize(glm::slerp(table.rotations[row - 1], table.rotations[row], share));
}

// An attitude rotates the axes (nose, starboard, belly) from (velocity, -normal, -zenith) to their
// directions.
BodyAxes rotated_axes(const glm::dquat& rotation) {
  const auto local = [&rotation](const Vec3& d) {
    const Vec3 there = rotation * d;
    return Vec3(there.x, -there.y, -there.z);
  };
  return {-local({1.0, 0.0, 0.0}), -local({0.0, 0.0, 1.0})};
}

BodyAxes axes_at(const Orbit& orbit, double position_deg, double time_s) {
  if (orbit.files && orbit.files->attitudes) {
    const AttitudeTable& table = *orbit.files->attitudes;
    return rotated_axes(rotation_at(table, table.by_time ? time_s : position_deg, position_deg));
  }
  if (orbit.attitude == inertial_attitude) {
    const double from = orbit.inertial_at_deg;
    const BodyAxes kept = named_axes(orbit.inertial_as, sun_at(orbit.beta_deg, from));
    return {carried(kept.aft, from, position_deg), carried(kept.out_of_bay, from, position_deg)};
  }
  return named_axes(orbit.attitude, sun_at(orbit.beta_deg, position_deg));
}

// Half of the arc, deg, on which the Sun is within limit_rad of the Earth's centre; no value if it
// never is.
std::optional<double> half_arc_deg(double beta_deg, double limit_rad) {
  const double highest = std::cos(base::radians(beta_deg)), limit = std::cos(limit_rad);
  if (limit >= highest) return std::nullopt;
  if (limit <= -highest) return 180.0;
  return base::degrees(std::acos(limit / highest));
}

}  // namespace

Vec3 BodyAxes::in_scene(const Vec3& d) const {
  const Vec3 starboard = glm::cross(out_of_bay, aft);
  return glm::normalize(Vec3(glm::dot(d, aft), glm::dot(d, starboard), glm::dot(d, out_of_bay)));
}

BodyAxes named_axes(std::string_view attitude, const Vec3& sun) {
  if (attitude == "bay-to-earth") return {-velocity, -zenith};
  if (attitude == "bay-to-space") return {-velocity, zenith};
  if (attitude == "tail-down") return {-zenith, velocity};
  if (attitude == "bay-to-sun") {
    Vec3 north = normal - glm::dot(normal, sun) * sun;
    if (glm::dot(north, north) < 1e-12) north = zenith;  // Sun at the orbit's pole
    return {-glm::normalize(north), sun};
  }
  throw base::Error(base::Blame::Input, "orbit",
                    "unknown attitude \"" + std::string(attitude) + "\"",
                    "allowed: bay-to-earth, bay-to-space, bay-to-sun, tail-down");
}

double orbit_period_s(double altitude_m) {
  const double a = base::earth_radius_m + altitude_m;
  return 2.0 * base::pi * a * std::sqrt(a / earth_gm_m3_s2);
}

OrbitState orbit_state(const Orbit& orbit, double position_deg) {
  OrbitState state;
  state.position_deg = position_deg;
  state.time_s = position_deg / 360.0 * orbit_period_s(orbit.altitude_m);
  const BodyAxes axes = axes_at(orbit, position_deg, state.time_s);
  state.sun = axes.in_scene(sun_at(orbit.beta_deg, position_deg));
  state.earth = axes.in_scene(-zenith);
  state.velocity = axes.in_scene(velocity);
  // The pole is sin i along the motion's northernmost direction, 90 deg past the ascending node,
  // and cos i along the normal.
  const double i = base::radians(orbit.inclination_deg);
  const double u = base::radians(orbit.noon_argument_deg + position_deg);
  const Vec3 north(std::sin(i) * std::cos(u), std::cos(i), std::sin(i) * std::sin(u));
  state.north = axes.in_scene(north);
  state.latitude_deg = base::degrees(std::asin(std::clamp(north.z, -1.0, 1.0)));
  return state;
}

void move_along_orbit(Scene& scene, double position_deg) {
  if (!scene.orbit) {
    throw base::Error(base::Blame::Input, scene.path.string(), "the scene has no [orbit]", {},
                      "Add [orbit] with altitude_km = ...");
  }
  const OrbitState state = orbit_state(*scene.orbit, position_deg);
  scene.orbit->position_deg = position_deg;
  if (scene.sun) scene.sun->direction = state.sun;
  if (!scene.earth) return;
  scene.earth->direction = state.earth;
  scene.earth->altitude_m = scene.orbit->altitude_m;
  scene.earth->half_angle_deg = base::degrees(earth_half_angle_rad(scene.orbit->altitude_m));
  if (scene.earth->by_latitude) scene.earth->by_latitude->north = state.north;
}

Eclipse find_eclipse(const Orbit& orbit, double sun_angular_radius_deg) {
  const double period_s = orbit_period_s(orbit.altitude_m);
  const double earth_rad =
      std::asin(base::earth_radius_m / (base::earth_radius_m + orbit.altitude_m));
  const double sun_rad = base::radians(sun_angular_radius_deg);
  const auto span = [&](double limit_rad) -> std::optional<ShadowSpan> {
    const auto half = half_arc_deg(orbit.beta_deg, limit_rad);
    if (!half) return std::nullopt;
    const double begin = 180.0 - *half, end = 180.0 + *half;
    return ShadowSpan{begin, end, begin / 360.0 * period_s, end / 360.0 * period_s};
  };
  Eclipse eclipse;
  eclipse.penumbra = span(earth_rad + sun_rad);
  if (sun_rad < earth_rad) eclipse.umbra = span(earth_rad - sun_rad);
  return eclipse;
}

}  // namespace earthshine::scenes
