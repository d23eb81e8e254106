// SPDX-License-Identifier: Apache-2.0
#include "app/dataset/recipe.h"

#include <fmt/format.h>

#include <cmath>

#include "base/numbers/digest.h"
#include "base/numbers/random.h"
#include "scenes/read/scene_parts.h"
#include "scenes/text/table_reader.h"

namespace earthshine::app {
namespace {

using scenes::Range;
using scenes::TableReader;
using scenes::TomlArray;
using scenes::TomlEntry;
using scenes::TomlNode;

constexpr std::string_view root_keys[] = {"format", "name", "scene", "set",    "images", "seed",
                                          "error",  "cctv", "white", "camera", "target", "vary"};
constexpr std::string_view camera_keys[] = {
    "name", "from",   "center",  "radius",         "azimuth_deg", "elevation_deg", "low",
    "high", "points", "look_at", "look_at_target", "jitter",      "roll_deg",      "clearance"};
constexpr std::string_view target_keys[] = {"name", "low", "high", "turns", "point"};
constexpr std::string_view point_keys[] = {"name", "position"};
constexpr std::string_view vary_keys[] = {"key", "uniform", "log_uniform", "choice", "direction"};
constexpr std::string_view from_words[] = {"scene", "shell", "box", "path"};
constexpr std::string_view units[] = {"m", "cm", "mm", "ft", "in"};
constexpr double metres_per_unit[] = {1.0, 0.01, 0.001, 0.3048, 0.0254};
constexpr int most_images = 1'000'000;

std::vector<std::string> texts(const TableReader& table, std::string_view key) {
  std::vector<std::string> all;
  const TomlEntry* entry = table.find(key);
  if (entry == nullptr) return all;
  const auto* items = std::get_if<TomlArray>(&entry->node.value);
  if (items == nullptr) table.fail(key, "is " + describe(entry->node), "it is a list of texts");
  for (const TomlNode& item : *items) {
    const auto* text = std::get_if<std::string>(&item.value);
    if (text == nullptr) table.fail(key, "holds " + describe(item), "it is a list of texts");
    all.push_back(*text);
  }
  return all;
}

// [low, high]: numbers, or vectors of one length.
std::vector<Bounds> read_bounds(const TableReader& table, std::string_view key,
                                const Range& range = scenes::any_number) {
  const TomlEntry* entry = table.find(key);
  if (entry == nullptr) return {};
  const auto* ends = std::get_if<TomlArray>(&entry->node.value);
  std::vector<Bounds> bounds;
  if (ends != nullptr && ends->size() == 2) {
    const std::vector<double> low = scenes::numbers_of((*ends)[0]),
                              high = scenes::numbers_of((*ends)[1]);
    for (std::size_t k = 0; low.size() == high.size() && k < low.size(); ++k) {
      if (low[k] <= high[k] && range.holds(low[k]) && range.holds(high[k])) {
        bounds.push_back({low[k], high[k]});
      }
    }
    if (bounds.size() != low.size()) bounds.clear();
  }
  if (bounds.empty()) {
    table.fail(
        key, "is " + describe(entry->node),
        "it is [low, high], numbers or vectors with low at most high, each " + to_string(range));
  }
  return bounds;
}

Bounds one_range(const TableReader& table, std::string_view key, Bounds otherwise,
                 const Range& range = scenes::any_number) {
  const std::vector<Bounds> found = read_bounds(table, key, range);
  if (found.size() > 1) table.fail(key, "has vectors", "it is [low, high] in numbers");
  return found.empty() ? otherwise : found.front();
}

std::string toml_of(const TomlNode& node) {
  if (const auto* text = std::get_if<std::string>(&node.value)) return Json(*text).dump();
  if (const auto* flag = std::get_if<bool>(&node.value)) return *flag ? "true" : "false";
  if (const auto* whole = std::get_if<std::int64_t>(&node.value)) return fmt::format("{}", *whole);
  if (const auto* number = std::get_if<double>(&node.value)) return fmt::format("{}", *number);
  std::vector<std::string> items;
  if (const auto* list = std::get_if<TomlArray>(&node.value)) {
    for (const TomlNode& item : *list) items.push_back(toml_of(item));
  }
  return fmt::format("[{}]", fmt::join(items, ", "));
}

DrawnCamera read_camera_draw(const TomlNode& node) {
  const TableReader table(node, "[camera]", camera_keys);
  DrawnCamera camera;
  camera.name = table.text("name").value_or("");
  const std::string from = table.choice("from", from_words).value_or("scene");
  const auto point = [&](std::string_view key) {
    return table.required(table.position(key, 1.0), key, std::string(key) + " = [x, y, z]  # m");
  };
  if (from == "shell") {
    camera.from = DrawnCamera::From::Shell;
    camera.center = point("center");
    camera.radius = one_range(table, "radius", {1.0, 1.0}, scenes::above_zero);
    camera.azimuth_deg = one_range(table, "azimuth_deg", camera.azimuth_deg);
    camera.elevation_deg = one_range(table, "elevation_deg", camera.elevation_deg, {-90.0, 90.0});
  } else if (from == "box") {
    camera.from = DrawnCamera::From::Box;
    camera.low = point("low");
    camera.high = point("high");
  } else if (from == "path") {
    camera.from = DrawnCamera::From::Path;
    camera.points =
        table.required(table.points("points"), "points", "points = [[x, y, z], [x, y, z]]");
    if (camera.points.size() < 2) table.fail("points", "has one point", "a path has at least two");
  }
  camera.look_at = table.position("look_at", 1.0);
  camera.look_at_target = table.text("look_at_target").value_or("");
  camera.jitter_m = table.length("jitter", 1.0, scenes::at_least_zero).value_or(0.0);
  camera.roll_deg = one_range(table, "roll_deg", camera.roll_deg);
  camera.clearance_m = table.length("clearance", 1.0, scenes::at_least_zero).value_or(0.0);
  if (camera.look_at && !camera.look_at_target.empty()) {
    table.fail("look_at", "cannot be combined with \"look_at_target\"",
               "a camera looks at one of them");
  }
  return camera;
}

DrawnTarget read_target(const TomlNode& node) {
  TableReader table(node, "[[target]]", target_keys);
  DrawnTarget target;
  target.name = table.read_name();
  target.moves = table.has("low") || table.has("high");
  target.random_attitude = table.flag("turns").value_or(false);
  if (target.moves) {
    target.low = table.required(table.position("low", 1.0), "low", "low = [x, y, z]  # m");
    target.high = table.required(table.position("high", 1.0), "high", "high = [x, y, z]  # m");
  } else if (target.random_attitude) {
    table.fail("turns", "is given without \"low\" and \"high\"",
               "a target that turns has a place too, which may be one point");
  }
  for (const TomlNode* entry : named_entries(table, "point")) {
    TableReader named(*entry, "[[target.point]]", point_keys);
    KeyPoint point;
    point.name = named.read_name();
    point.position =
        named.required(named.position("position", 1.0), "position", "position = [x, y, z]  # m");
    target.points.push_back(point);
  }
  return target;
}

Varied read_varied(const TomlNode& node) {
  const TableReader table(node, "[[vary]]", vary_keys);
  Varied varied;
  varied.key = table.required(table.text("key"), "key", "key = \"light.key.flux\"");
  int laws = 0;
  for (const char* law : {"uniform", "log_uniform", "choice", "direction"}) {
    laws += table.has(law) ? 1 : 0;
  }
  if (laws != 1) {
    table.fail("key", "has not one law",
               "one of uniform, log_uniform, choice and direction = true");
  }
  varied.bounds = read_bounds(table, "uniform");
  if (table.has("log_uniform")) {
    varied.law = Varied::Law::LogUniform;
    varied.bounds = read_bounds(table, "log_uniform", scenes::above_zero);
  } else if (table.has("direction")) {
    varied.law = Varied::Law::Direction;
  } else if (const TomlEntry* entry = table.find("choice")) {
    varied.law = Varied::Law::Choice;
    const auto* items = std::get_if<TomlArray>(&entry->node.value);
    if (items == nullptr || items->empty()) table.fail("choice", "is no list of values");
    for (const TomlNode& item : *items) varied.words.push_back(toml_of(item));
  }
  return varied;
}

// The labels follow the poses that [[target]] draws.
void check_varied(const TomlNode& node, const Varied& varied,
                  const std::vector<DrawnTarget>& targets) {
  const TableReader table(node, "[[vary]]", vary_keys);
  if (varied.key == "unit") table.fail("key", "sets the unit", "[[target]] reads the scene file's");
  for (const DrawnTarget& target : targets) {
    const std::string own = fmt::format("object.{}.", target.name);
    if (!varied.key.starts_with(own)) continue;
    const std::string key = varied.key.substr(own.size());
    if (key == "material" || key == "velocity" || key == "spin" || key == "spin_about") continue;
    table.fail("key", "sets the pose or the shape of a target",
               "[[target]] draws its pose, with low and high; its shape is that of the model");
  }
}

double unit_of(const std::filesystem::path& scene) {
  const TomlNode root = scenes::read_toml(scene);
  const TomlEntry* unit = find_entry(std::get<scenes::TomlTable>(root.value), "unit");
  for (std::size_t k = 0; unit != nullptr && k < std::size(units); ++k) {
    const auto* text = std::get_if<std::string>(&unit->node.value);
    if (text != nullptr && *text == units[k]) return metres_per_unit[k];
  }
  return 1.0;
}

// Draws of one thing of one image: other things do not change them.
base::Rng draws_of(const Recipe& recipe, std::size_t image, std::string_view thing) {
  base::Digest digest;
  digest.add(thing);
  return base::Rng(base::Key(recipe.seed, base::Stream::Dataset, image).with(digest.value()));
}

double within(base::Rng& rng, const Bounds& bounds) {
  return bounds[0] + rng.next() * (bounds[1] - bounds[0]);
}
double log_within(base::Rng& rng, const Bounds& bounds) {
  return std::exp(within(rng, {std::log(bounds[0]), std::log(bounds[1])}));
}
Vec3 within(base::Rng& rng, const Vec3& low, const Vec3& high) {
  const double x = rng.next(), y = rng.next(), z = rng.next();
  return low + Vec3(x, y, z) * (high - low);
}
Vec3 on_sphere(base::Rng& rng) {
  const double z = 2.0 * rng.next() - 1.0, phi = 2.0 * base::pi * rng.next();
  const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
  return {r * std::cos(phi), r * std::sin(phi), z};
}

// An attitude, all equally likely (Shoemake, Graphics Gems III, 1992), as angles of
// R_z R_y R_x.
Vec3 any_attitude(base::Rng& rng) {
  const double u = rng.next(), a = 2.0 * base::pi * rng.next(), b = 2.0 * base::pi * rng.next();
  const glm::dmat3 m =
      glm::mat3_cast(glm::dquat(std::sqrt(u) * std::cos(b), std::sqrt(1.0 - u) * std::sin(a),
                                std::sqrt(1.0 - u) * std::cos(a), std::sqrt(u) * std::sin(b)));
  const double y = std::asin(std::clamp(-m[0][2], -1.0, 1.0));
  return {base::degrees(std::atan2(m[1][2], m[2][2])), base::degrees(y),
          base::degrees(std::atan2(m[0][1], m[0][0]))};
}

std::string vector_text(const Vec3& v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); }

std::string value_of(const Varied& varied, base::Rng& rng) {
  switch (varied.law) {
    case Varied::Law::Direction:
      return vector_text(on_sphere(rng));
    case Varied::Law::Choice: {
      const auto count = static_cast<double>(varied.words.size());
      return varied.words[static_cast<std::size_t>(rng.next() * count)];
    }
    case Varied::Law::Uniform:
    case Varied::Law::LogUniform:
      break;
  }
  std::vector<double> numbers;
  for (const Bounds& bounds : varied.bounds) {
    numbers.push_back(varied.law == Varied::Law::Uniform ? within(rng, bounds)
                                                         : log_within(rng, bounds));
  }
  if (numbers.size() == 1) return fmt::format("{}", numbers.front());
  return fmt::format("[{}]", fmt::join(numbers, ", "));
}

}  // namespace

Recipe read_recipe(const std::filesystem::path& path) {
  const TomlNode root = scenes::read_toml(path);
  const TableReader table(root, "the data set", root_keys);
  scenes::check_format(table);
  Recipe recipe;
  recipe.path = path;
  recipe.scene =
      path.parent_path() / table.required(table.text("scene"), "scene", "scene = \"bay.toml\"");
  recipe.overrides = texts(table, "set");
  recipe.images = static_cast<std::size_t>(
      table.required(table.whole("images", 1, most_images), "images", "images = 200"));
  recipe.seed = static_cast<std::uint64_t>(table.whole("seed", 0, 1 << 30).value_or(1));
  recipe.error = table.number("error", {0.0, 1.0, true}).value_or(recipe.error);
  recipe.cctv = table.flag("cctv").value_or(false);
  if (table.has("white")) {
    recipe.white_cd_m2 = one_range(table, "white", {}, scenes::above_zero);
    if (recipe.cctv) {
      table.fail("white", "cannot be combined with cctv = true",
                 "a CCTV camera has an exposure of its own");
    }
  }
  for (const std::string& setting : recipe.overrides) {
    if (setting.starts_with("unit"))
      table.fail("set", "sets the unit", "[[target]] reads the scene file's");
  }
  recipe.unit_m = unit_of(recipe.scene);
  if (const TomlEntry* entry = table.find("camera")) recipe.camera = read_camera_draw(entry->node);
  for (const TomlNode* entry : named_entries(table, "target")) {
    recipe.targets.push_back(read_target(*entry));
  }
  for (const TomlNode* entry : named_entries(table, "vary")) {
    recipe.varied.push_back(read_varied(*entry));
    check_varied(*entry, recipe.varied.back(), recipe.targets);
  }
  const std::string& looked_at = recipe.camera.look_at_target;
  const bool known = std::ranges::any_of(
      recipe.targets, [&](const DrawnTarget& target) { return target.name == looked_at; });
  if (!looked_at.empty() && !known) {
    throw base::Error(base::Blame::Input, path.string(),
                      "look_at_target = \"" + looked_at + "\" is no [[target]]");
  }
  return recipe;
}

Draw draw_values(const Recipe& recipe, std::size_t image) {
  Draw draw;
  draw.overrides = recipe.overrides;
  draw.seed = base::mix64(base::Key(recipe.seed, base::Stream::Dataset, image).value) >> 11;
  draw.overrides.push_back(fmt::format("quality.error={}", recipe.error));
  for (const DrawnTarget& target : recipe.targets) {
    Draw::Pose pose;
    if (target.moves) {
      base::Rng rng = draws_of(recipe, image, "target " + target.name);
      pose.translate_m = within(rng, target.low, target.high);
      if (target.random_attitude) pose.rotate_deg = any_attitude(rng);
      draw.overrides.push_back(fmt::format("object.{}.translate={}", target.name,
                                           vector_text(pose.translate_m / recipe.unit_m)));
      draw.overrides.push_back(
          fmt::format("object.{}.rotate={}", target.name, vector_text(pose.rotate_deg)));
    }
    draw.overrides.push_back(fmt::format("object.{}.target=true", target.name));
    draw.poses.push_back(pose);
  }
  for (const Varied& varied : recipe.varied) {
    base::Rng rng = draws_of(recipe, image, "vary " + varied.key);
    draw.overrides.push_back(varied.key + "=" + value_of(varied, rng));
  }
  if (recipe.white_cd_m2) {
    base::Rng rng = draws_of(recipe, image, "white");
    draw.white_cd_m2 = log_within(rng, *recipe.white_cd_m2);
  }
  return draw;
}

CameraPose draw_camera(const Recipe& recipe, std::size_t image, std::size_t attempt,
                       const CameraPose& scene_pose, const std::optional<Vec3>& target) {
  const DrawnCamera& camera = recipe.camera;
  base::Rng rng = draws_of(recipe, image, fmt::format("camera {}", attempt));
  CameraPose pose = scene_pose;
  switch (camera.from) {
    case DrawnCamera::From::Scene:
      break;
    case DrawnCamera::From::Shell: {
      // Evenly over the shell's volume.
      const Bounds cubes{std::pow(camera.radius[0], 3.0), std::pow(camera.radius[1], 3.0)};
      const double radius = std::cbrt(within(rng, cubes));
      const double phi = base::radians(within(rng, camera.azimuth_deg));
      const double z = within(rng, {std::sin(base::radians(camera.elevation_deg[0])),
                                    std::sin(base::radians(camera.elevation_deg[1]))});
      const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
      pose.position = camera.center + radius * Vec3(r * std::cos(phi), r * std::sin(phi), z);
      break;
    }
    case DrawnCamera::From::Box:
      pose.position = within(rng, camera.low, camera.high);
      break;
    case DrawnCamera::From::Path: {
      double length = 0.0;
      for (std::size_t k = 1; k < camera.points.size(); ++k) {
        length += glm::length(camera.points[k] - camera.points[k - 1]);
      }
      double along = rng.next() * length;
      for (std::size_t k = 1; k < camera.points.size(); ++k) {
        const Vec3 segment = camera.points[k] - camera.points[k - 1];
        const double step = glm::length(segment);
        pose.position =
            camera.points[k - 1] + (step > 0.0 ? std::min(1.0, along / step) : 0.0) * segment;
        if (along <= step) break;
        along -= step;
      }
      break;
    }
  }
  if (target) pose.look_at = *target;
  if (camera.look_at) pose.look_at = *camera.look_at;
  if (camera.jitter_m > 0.0) {
    pose.look_at += camera.jitter_m * std::cbrt(rng.next()) * on_sphere(rng);
  }
  const Vec3 forward = glm::normalize(pose.look_at - pose.position);
  if (!(glm::length(glm::cross(forward, pose.up)) > 1e-3))
    pose.up = base::frame_around(forward).tangent;
  const Vec3 right = glm::normalize(glm::cross(forward, pose.up));
  const double roll = base::radians(within(rng, camera.roll_deg));
  pose.up = std::cos(roll) * glm::cross(right, forward) + std::sin(roll) * right;
  return pose;
}

}  // namespace earthshine::app
