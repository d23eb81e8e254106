// SPDX-License-Identifier: Apache-2.0
#include "scenes/sky/orbit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenes/read/scene_parts.h"
#include "scenes/sky/attitude_file.h"

namespace earthshine::scenes {
namespace {

constexpr std::string_view orbit_keys[] = {
    "altitude_km", "beta_deg",        "position_deg",    "attitude",         "attitude_table",
    "inertial_as", "inertial_at_deg", "inclination_deg", "noon_argument_deg"};
constexpr std::string_view attitudes[] = {"bay-to-earth", "bay-to-space", "bay-to-sun", "tail-down",
                                          inertial_attitude};
static_assert(std::size(attitudes) == std::size(orbit_attitudes) + 1);
constexpr Range one_turn{-360.0, 360.0};
constexpr double obliquity_deg = 23.44;  // of the ecliptic

void read_attitude(Scene& scene, Orbit& orbit, const TableReader& table) {
  const auto attitude = table.choice("attitude", attitudes);
  if (const auto file = table.text("attitude_table")) {
    if (attitude) {
      table.fail("attitude_table", "stands beside \"attitude\"",
                 "the attitude is given by one of the two");
    }
    orbit.attitude.clear();
    orbit.table = std::make_shared<const AttitudeTable>(read_attitudes(
        scene.files.emplace_back(scene.path.parent_path() / *file), table.where("attitude_table")));
  }
  if (attitude) orbit.attitude = *attitude;
  if (orbit.attitude != inertial_attitude) {
    for (const char* key : {"inertial_as", "inertial_at_deg"}) {
      if (table.has(key)) {
        table.fail(key, "belongs to attitude \"inertial\"", "no other attitude has this key",
                   "Write attitude = \"inertial\", or remove the key");
      }
    }
  }
  orbit.inertial_as = table.choice("inertial_as", orbit_attitudes).value_or(orbit.inertial_as);
  orbit.inertial_at_deg = table.number("inertial_at_deg", one_turn).value_or(0.0);
}

// The Sun's declination follows from the orbit's plane: sin = cos beta sin i sin u + sin beta cos
// i, u the argument of latitude at orbit noon.
void check_declination(Scene& scene, const Orbit& orbit) {
  const double beta = base::radians(orbit.beta_deg), i = base::radians(orbit.inclination_deg);
  const double sine =
      std::cos(beta) * std::sin(i) * std::sin(base::radians(orbit.noon_argument_deg)) +
      std::sin(beta) * std::cos(i);
  const double declination_deg = base::degrees(std::asin(std::clamp(sine, -1.0, 1.0)));
  if (std::abs(declination_deg) <= obliquity_deg) return;
  scene.warnings.push_back(fmt::format(
      "[orbit]: beta_deg, inclination_deg and noon_argument_deg put the Sun {:.4g} deg from the "
      "equator, and it never stands more than {} deg from it",
      std::abs(declination_deg), obliquity_deg));
}

}  // namespace

Orbit read_orbit(Scene& scene, const TomlNode& node) {
  const TableReader table(node, "[orbit]", orbit_keys);
  Orbit orbit;
  orbit.altitude_m = 1e3 * table.required(table.number("altitude_km", altitudes_km), "altitude_km",
                                          "altitude_km = ..., the height over the ground");
  orbit.beta_deg = table.number("beta_deg", {-90.0, 90.0}).value_or(0.0);
  orbit.position_deg = table.number("position_deg", one_turn).value_or(0.0);
  orbit.inclination_deg = table.number("inclination_deg", {0.0, 180.0}).value_or(0.0);
  orbit.noon_argument_deg = table.number("noon_argument_deg", one_turn).value_or(0.0);
  read_attitude(scene, orbit, table);
  if (table.has("inclination_deg") || table.has("noon_argument_deg")) {
    check_declination(scene, orbit);
  }
  return orbit;
}

}  // namespace earthshine::scenes
