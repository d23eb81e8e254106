// SPDX-License-Identifier: Apache-2.0
#include "scenes/sky/sky.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "scenes/read/mission.h"
#include "scenes/read/scene_parts.h"
#include "scenes/sky/albedo_grid.h"
#include "scenes/sky/attitude_file.h"
#include "scenes/sky/moon.h"
#include "scenes/sky/orbit.h"

namespace earthshine::scenes {
namespace {

constexpr std::string_view sun_keys[] = {"direction", "illuminance", "angular_radius_deg"};
constexpr std::string_view earth_keys[] = {
    "direction", "altitude_km", "albedo",    "model",     "radiance", "half_angle_deg",
    "albedo_by", "albedo_a0",   "albedo_a1", "albedo_a2", "north",    "albedo_grid"};
constexpr std::string_view moon_keys[] = {"direction", "phase_deg"};
constexpr std::string_view models[] = {"lambert", "uniform"};
constexpr std::string_view albedo_laws[] = {"mean", "latitude", "grid"};
constexpr std::string_view latitude_keys[] = {"albedo_a0", "albedo_a1", "albedo_a2", "north"};
constexpr std::string_view example_direction = "direction = [x, y, z]";

// Rejects keys that [orbit] determines.
void refuse_beside_orbit(const TableReader& table, std::string_view key) {
  if (!table.has(key)) return;
  table.fail(key, "cannot be combined with [orbit]", "[orbit] already determines it",
             "Remove the key, or [orbit]");
}

Sun read_sun(const TableReader& table, bool by_orbit) {
  Sun sun;
  if (by_orbit) {
    refuse_beside_orbit(table, "direction");
  } else {
    sun.direction = table.required(table.direction("direction"), "direction", example_direction);
  }
  sun.illuminance_lx = table.colour("illuminance").value_or(sun.illuminance_lx);
  sun.angular_radius_deg =
      table.number("angular_radius_deg", {0.0, 45.0}).value_or(sun.angular_radius_deg);
  return sun;
}

void read_disc(Earth& earth, const TableReader& table, bool by_orbit) {
  if (by_orbit) {
    refuse_beside_orbit(table, "altitude_km");
    refuse_beside_orbit(table, "half_angle_deg");
    return;  // set by the movement along the orbit
  } else if (earth.model == EarthModel::Uniform && table.has("half_angle_deg")) {
    if (table.has("altitude_km")) {
      table.fail("half_angle_deg", "cannot be combined with \"altitude_km\"",
                 "the disc is given by one of the two");
    }
    earth.half_angle_deg = *table.number("half_angle_deg", {0.0, 90.0, true, true});
    return;
  } else {
    if (table.has("half_angle_deg")) {
      table.fail("half_angle_deg", "belongs to model \"uniform\"",
                 "the lit sphere of model \"lambert\" needs altitude_km");
    }
    earth.altitude_m =
        1e3 * table.required(table.number("altitude_km", altitudes_km), "altitude_km",
                             "altitude_km = ..., the height over the ground");
  }
  earth.half_angle_deg = base::degrees(earth_half_angle_rad(earth.altitude_m));
}

// The share of the light that a Lambert Earth gives back.
void read_albedo(Scene& scene, Earth& earth, const TableReader& table, bool by_orbit) {
  const std::string law_named = table.choice("albedo_by", albedo_laws).value_or("mean");
  if (law_named != "grid" && table.has("albedo_grid")) {
    table.fail("albedo_grid", "belongs to albedo_by = \"grid\"");
  }
  if (law_named != "latitude") {
    for (const std::string_view key : latitude_keys) {
      if (!table.has(key)) continue;
      table.fail(key, "belongs to albedo_by = \"latitude\"",
                 fmt::format("albedo_by = \"{}\" has no such law", law_named),
                 "Write albedo_by = \"latitude\", or remove the key");
    }
  }
  if (law_named == "mean") {
    earth.albedo = table.colour("albedo", share).value_or(earth.albedo);
    return;
  }
  if (law_named == "grid") {
    if (mission_of(scene) == nullptr) {
      table.fail("albedo_by", "is \"grid\", and the scene has no dates to turn the Earth by", {},
                 "Write [orbit] with trajectory = \"FILE.oem\"");
    }
    const std::string named =
        table.required(table.text("albedo_grid"), "albedo_grid", "albedo_grid = \"FILE.csv\"");
    earth.grid = std::make_shared<const AlbedoGrid>(read_albedo_grid(
        scene.files.emplace_back(scene.path.parent_path() / named), table.where("albedo_grid")));
    earth.albedo = table.colour("albedo", share).value_or(Rgb(1.0));
    return;
  }
  LatitudeAlbedo law;
  law.a0 = table.number("albedo_a0", share).value_or(law.a0);
  law.a1 = table.number("albedo_a1", {-1.0, 1.0}).value_or(law.a1);
  law.a2 = table.number("albedo_a2", {-1.0, 1.0}).value_or(law.a2);
  if (by_orbit) {
    refuse_beside_orbit(table, "north");
  } else {
    law.north = table.required(table.direction("north"), "north",
                               "north = [x, y, z], toward the Earth's north pole");
  }
  earth.by_latitude = law;
  earth.albedo = table.colour("albedo", share).value_or(Rgb(1.0));
}

Earth read_earth(Scene& scene, const TableReader& table, bool by_orbit) {
  Earth earth;
  if (table.choice("model", models).value_or("lambert") == "uniform")
    earth.model = EarthModel::Uniform;
  if (by_orbit) {
    refuse_beside_orbit(table, "direction");
  } else {
    earth.direction = table.required(table.direction("direction"), "direction", example_direction);
  }
  read_disc(earth, table, by_orbit);
  if (earth.model == EarthModel::Uniform) {
    for (const std::string_view key :
         {"albedo", "albedo_by", "albedo_a0", "albedo_a1", "albedo_a2", "north", "albedo_grid"}) {
      if (!table.has(key)) continue;
      table.fail(key, "belongs to model \"lambert\"", "model \"uniform\" has radiance");
    }
    earth.radiance =
        table.required(table.colour("radiance"), "radiance", "radiance = ... (cd/m^2)");
  } else {
    if (table.has("radiance")) {
      table.fail("radiance", "belongs to model \"uniform\"", "model \"lambert\" has albedo",
                 "Write model = \"uniform\", or remove the key");
    }
    read_albedo(scene, earth, table, by_orbit);
  }
  return earth;
}

// With a trajectory the date gives the Moon's direction and brightness, otherwise the keys do.
void read_moon(Scene& scene, const TableReader& table) {
  scene.moon = Moon();
  if (mission_of(scene) != nullptr) {
    for (const std::string_view key : moon_keys) {
      if (table.has(key))
        table.fail(key, "cannot be combined with a trajectory", "the date determines it");
    }
    return;
  }
  scene.moon->direction =
      table.required(table.direction("direction"), "direction", example_direction);
  scene.moon->phase_deg = table.number("phase_deg", {0.0, 180.0}).value_or(0.0);
  scene.moon->illuminance_lx =
      moon_illuminance_lx(scene.sun ? scene.sun->illuminance_lx : Sun().illuminance_lx,
                          scene.moon->phase_deg, mean_moon_distance_m, astronomical_unit_m);
}

constexpr std::string_view orbit_keys[] = {
    "altitude_km", "beta_deg",        "position_deg",    "attitude",         "attitude_table",
    "inertial_as", "inertial_at_deg", "inclination_deg", "noon_argument_deg"};
constexpr std::string_view attitudes[] = {"bay-to-earth", "bay-to-space", "bay-to-sun", "tail-down",
                                          inertial_attitude};
static_assert(std::size(attitudes) == std::size(orbit_attitudes) + 1);
constexpr Range position_range_deg{-360.0, 360.0};
constexpr double obliquity_deg = 23.44;  // of the ecliptic

void read_attitude(Scene& scene, Orbit& orbit, const TableReader& table) {
  const auto attitude = table.choice("attitude", attitudes);
  if (const auto file = table.text("attitude_table")) {
    if (attitude) {
      table.fail("attitude_table", "cannot be combined with \"attitude\"",
                 "the attitude is given by one of the two");
    }
    orbit.attitude.clear();
    orbit.files = std::make_shared<const OrbitFiles>(
        OrbitFiles{read_attitudes(scene.files.emplace_back(scene.path.parent_path() / *file),
                                  table.where("attitude_table"), scene.warnings),
                   nullptr});
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
  orbit.inertial_at_deg = table.number("inertial_at_deg", position_range_deg).value_or(0.0);
}

// The Sun's declination follows from the orbital plane: sin = cos beta sin i sin u + sin beta cos
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

void read_sky(Scene& scene, const SkyTables& tables) {
  auto [sun, earth, orbit, time, moon] = tables;
  const bool by_orbit = orbit != nullptr;
  if (by_orbit && names_trajectory(*orbit)) {
    const auto given = [&, at = sun](std::string_view key) {
      const auto* table = at == nullptr ? nullptr : std::get_if<TomlTable>(&at->value);
      return table != nullptr && find_entry(*table, key) != nullptr;
    };
    scene.orbit =
        read_mission(scene, *orbit, time, {given("illuminance"), given("angular_radius_deg")});
  } else if (time != nullptr) {
    throw base::Error(base::Blame::Input, time->where, "[time] needs a trajectory",
                      "positions on a circle have no date",
                      "Write [orbit] with trajectory = \"FILE.oem\", or remove [time]");
  } else if (by_orbit) {
    scene.orbit = read_orbit(scene, *orbit);
  }
  // With [orbit], Sun and Earth exist; an absent table has default values.
  const TomlNode nothing{by_orbit ? orbit->where : base::Location{}, TomlTable{}};
  if (by_orbit && sun == nullptr) sun = &nothing;
  if (by_orbit && earth == nullptr) earth = &nothing;
  if (sun != nullptr) scene.sun = read_sun(TableReader(*sun, "[sun]", sun_keys), by_orbit);
  if (moon != nullptr) read_moon(scene, TableReader(*moon, "[moon]", moon_keys));
  if (earth == nullptr) return;
  const TableReader table(*earth, "[earth]", earth_keys);
  scene.earth = read_earth(scene, table, by_orbit);
  if (const Mission* mission = mission_of(scene)) {
    move_to_moment(scene, mission->moment);
  } else if (scene.orbit) {
    move_along_orbit(scene, scene.orbit->position_deg);
  }
  if (scene.earth->model == EarthModel::Lambert && !scene.sun) {
    throw base::Error(
        base::Blame::Input, table.where("model"),
        "[earth] of model \"lambert\" is lit by the Sun, and the scene has none", {},
        "Add [sun] or [orbit], or write model = \"uniform\" and radiance = ... (cd/m^2)");
  }
}

Orbit read_orbit(Scene& scene, const TomlNode& node) {
  const TableReader table(node, "[orbit]", orbit_keys);
  Orbit orbit;
  orbit.altitude_m = 1e3 * table.required(table.number("altitude_km", altitudes_km), "altitude_km",
                                          "altitude_km = ..., the height over the ground");
  orbit.beta_deg = table.number("beta_deg", {-90.0, 90.0}).value_or(0.0);
  orbit.position_deg = table.number("position_deg", position_range_deg).value_or(0.0);
  orbit.inclination_deg = table.number("inclination_deg", {0.0, 180.0}).value_or(0.0);
  orbit.noon_argument_deg = table.number("noon_argument_deg", position_range_deg).value_or(0.0);
  read_attitude(scene, orbit, table);
  if (table.has("inclination_deg") || table.has("noon_argument_deg")) {
    check_declination(scene, orbit);
  }
  return orbit;
}

}  // namespace earthshine::scenes
