// SPDX-License-Identifier: Apache-2.0
// [time], and [orbit] with a trajectory.
#include "scenes/read/mission.h"

#include <fmt/format.h>

#include <algorithm>

#include "scenes/sky/orbit.h"
#include "scenes/text/message_text.h"

namespace earthshine::scenes {
namespace {

constexpr std::string_view time_keys[] = {"start", "stop", "step", "moment"};
constexpr KeyList study_time_keys = KeyList(time_keys).first(3);
constexpr std::string_view trajectory_keys[] = {"trajectory", "attitude",   "inertial_as",
                                                "body_axes",  "quaternion", "ut1_minus_utc_s",
                                                "earth_shape"};
constexpr std::string_view shapes_of_earth[] = {"ellipsoid", "sphere"};
constexpr std::string_view scalar_words[] = {"scalar-first", "scalar-last"};
constexpr std::string_view axis_words[] = {"x", "y", "z", "-x", "-y", "-z"};
constexpr const char* dates =
    "allowed is UTC such as 2026-03-01T12:00:00 or 2026-060T12:00:00, of the years 1972 to 2199";

// Converts "-x" to a unit vector along a scene axis.
Vec3 axis_named(std::string_view word) {
  Vec3 axis(0.0);
  const double sign = word.front() == '-' ? -1.0 : 1.0;
  axis[word.back() - 'x'] = sign;
  return axis;
}

void read_mission_attitude(Scene& scene, Mission& mission, const TableReader& table) {
  const auto attitude = table.text("attitude");
  const bool is_file = attitude && attitude->find('.') != std::string::npos;
  for (const char* key : {"body_axes", "quaternion"}) {
    if (is_file || !table.has(key)) continue;
    table.fail(key, "belongs to an attitude from a file", "no file is named",
               "Write attitude = \"FILE.aem\", or remove the key");
  }
  if (is_file) {
    mission.attitude.clear();
    mission.body_axes = read_body_axes(table);
    mission.history = std::make_shared<const AttitudeHistory>(read_attitude_history(
        scene.files.emplace_back(scene.path.parent_path() / *attitude), mission.clock,
        read_scalar_place(table), table.where("attitude"), scene.warnings));
  } else if (attitude) {
    std::vector<std::string_view> words(std::begin(orbit_attitudes), std::end(orbit_attitudes));
    words.push_back(inertial_attitude);
    mission.attitude = *table.choice("attitude", words);
  }
  if (mission.attitude != inertial_attitude && table.has("inertial_as")) {
    table.fail("inertial_as", "belongs to attitude \"inertial\"", {},
               "Write attitude = \"inertial\", or remove the key");
  }
  mission.inertial_as = table.choice("inertial_as", orbit_attitudes).value_or("bay-to-earth");
}

}  // namespace

glm::dmat3 read_body_axes(const TableReader& table) {
  constexpr const char* wanted =
      "allowed are three axes of the scene, right-handed, along which the file's body axes x, y "
      "and z point: [\"x\", \"y\", \"z\"] where they are the same, [\"-x\", \"y\", \"-z\"] where "
      "the file's are nose, starboard and belly";
  const TomlEntry* entry = table.find("body_axes");
  if (entry == nullptr) {
    table.fail("attitude", "names a file, and there is no body_axes", wanted);
  }
  const auto* items = std::get_if<TomlArray>(&entry->node.value);
  glm::dmat3 axes(0.0);
  bool good = items != nullptr && items->size() == 3;
  for (int k = 0; good && k < 3; ++k) {
    const auto* word = std::get_if<std::string>(&(*items)[static_cast<std::size_t>(k)].value);
    good = word != nullptr &&
           std::find(std::begin(axis_words), std::end(axis_words), *word) != std::end(axis_words);
    if (good) axes[k] = axis_named(*word);
  }
  if (!good || !(glm::determinant(axes) > 0.5)) {
    table.fail("body_axes", good ? "is left-handed" : "is " + describe(entry->node), wanted);
  }
  return axes;
}

std::optional<ScalarPlace> read_scalar_place(const TableReader& table) {
  const auto word = table.choice("quaternion", scalar_words);
  if (!word) return std::nullopt;
  return *word == "scalar-first" ? ScalarPlace::First : ScalarPlace::Last;
}

bool names_trajectory(const TomlNode& orbit) {
  const auto* table = std::get_if<TomlTable>(&orbit.value);
  return table != nullptr && find_entry(*table, "trajectory") != nullptr;
}

std::optional<Instant> read_moment(const TableReader& table, std::string_view key) {
  const TomlEntry* entry = table.find(key);
  if (entry == nullptr) return std::nullopt;
  const auto* date = std::get_if<TomlDate>(&entry->node.value);
  const auto* text = std::get_if<std::string>(&entry->node.value);
  if (date == nullptr && text == nullptr) table.fail(key, "is " + describe(entry->node), dates);
  const std::string& given = date != nullptr ? date->text : *text;
  const auto read = read_instant(given, TimeSystem::Utc);
  if (!read) table.fail(key, fmt::format("is {}", in_quotes(given)), dates);
  return read;
}

namespace {

TimeSpan read_span(const TableReader& table) {
  TimeSpan span;
  span.start =
      table.required(read_moment(table, "start"), "start", "start = \"2026-03-01T12:00:00\"");
  span.stop = read_moment(table, "stop").value_or(span.start);
  const bool many = table.has("stop");
  if (many != table.has("step")) {
    table.fail(many ? "step" : "stop",
               many ? "is missing beside \"stop\""
                    : "is missing beside "
                      "\"step\"",
               "moments go from start to stop by step seconds; start alone is one");
  }
  if (!many) return span;
  if (!(span.stop > span.start)) {
    table.fail("stop", fmt::format("is {}, start {}", utc_text(span.stop), utc_text(span.start)),
               "stop comes after start");
  }
  span.step_s = *table.number("step", {0.0, 1e9, true});
  if ((span.stop - span.start) / span.step_s >= static_cast<double>(most_moments)) {
    table.fail("step", fmt::format("makes more than {} moments", most_moments), {},
               "Take a longer step, or less time");
  }
  return span;
}

}  // namespace

TimeSpan read_time(const TomlNode& node) {
  return read_span(TableReader(node, "[time]", study_time_keys));
}

Orbit read_mission(Scene& scene, const TomlNode& node, const TomlNode* time, const SunKeys& given) {
  const TableReader table(node, "[orbit]", trajectory_keys);
  auto mission = std::make_shared<Mission>();
  mission->sun_illuminance_by_date = !given.illuminance;
  mission->sun_radius_by_date = !given.angular_radius_deg;
  mission->clock.ut1_minus_utc_s = table.number("ut1_minus_utc_s", {-1.0, 1.0}).value_or(0.0);
  mission->ellipsoid =
      table.choice("earth_shape", shapes_of_earth).value_or("ellipsoid") == "ellipsoid";
  const std::string named =
      table.required(table.text("trajectory"), "trajectory", "trajectory = \"FILE.oem\"");
  mission->trajectory = std::make_shared<const Trajectory>(
      read_trajectory(scene.files.emplace_back(scene.path.parent_path() / named), mission->clock,
                      table.where("trajectory"), scene.warnings));
  read_mission_attitude(scene, *mission, table);
  mission->time.start = mission->time.stop = mission->trajectory->first();
  mission->moment = mission->time.start;
  if (time != nullptr) {
    const TableReader span(*time, "[time]", time_keys);
    mission->time = read_span(span);
    mission->has_span = mission->time.step_s > 0.0;
    mission->moment = read_moment(span, "moment").value_or(mission->time.start);
  }
  if (leap_seconds_uncertain(mission->time.stop)) {
    scene.warnings.push_back(fmt::format(
        "{}: leap seconds are known to five years behind the last one in the program's table, and "
        "this is later; TAI - UTC = {:g} s is used",
        utc_text(mission->time.stop), tai_minus_utc_s(mission->time.stop)));
  }
  Orbit orbit;
  orbit.attitude = mission->attitude;
  orbit.files = std::make_shared<const OrbitFiles>(OrbitFiles{{}, std::move(mission)});
  return orbit;
}

}  // namespace earthshine::scenes
