// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenes/effects/quality.h"
#include "scenes/read/scene_parts.h"
#include "scenes/view/projection.h"

namespace earthshine::scenes {
namespace {

constexpr std::string_view camera_keys[] = {
    "name",     "position",   "look_at",    "up",           "fov_deg",      "focus",   "aperture",
    "cctv",     "resolution", "filter",     "filter_width", "range_sensor", "fx",      "fy",
    "cx",       "cy",         "K",          "pixel_origin", "distortion",   "fisheye", "joint",
    "velocity", "spin",       "exposure_s", "line_s",       "row_order"};
constexpr std::string_view row_orders[] = {"down", "up"};
constexpr Range shutter_s{0.0, 3600.0};
constexpr std::string_view pixel_origins[] = {"corner", "center"};
constexpr Range focal_px{0.0, 1e7, true};
constexpr Range centre_px{-1e6, 1e6};
struct FilterRow {
  std::string_view name;
  FilterShape shape;
  double width_px;  // default
};
constexpr FilterRow filters[] = {{"box", FilterShape::Box, 1.0},
                                 {"triangle", FilterShape::Triangle, 2.0},
                                 {"gaussian", FilterShape::Gaussian, 3.0},
                                 {"blackman-harris", FilterShape::BlackmanHarris, 4.0}};
constexpr Range filter_widths{0.0, 16.0, true};  // px
// Rounding dominates the view of a camera closer to its target than this share of its coordinates.
constexpr double least_relative_view = 1e-9;
constexpr std::string_view quality_keys[] = {
    "error",       "patch_edge",     "max_patches", "refine",           "form_factor_rays",
    "gather_rays", "camera_samples", "denoise",     "solver_tolerance", "gather",
    "smooth",      "picture_noise"};
constexpr int most_pixels = 16384;           // per side
constexpr std::size_t most_settings = 1000;  // of a CCTV camera or the monitor; a dozen exist

void read_resolution(Camera& camera, const TableReader& table) {
  const TomlEntry* entry = table.find("resolution");
  if (entry == nullptr) return;
  const auto* items = std::get_if<TomlArray>(&entry->node.value);
  int* const sides[] = {&camera.columns, &camera.rows};
  for (std::size_t i = 0; i < 2; ++i) {
    const auto* side = items != nullptr && items->size() == 2
                           ? std::get_if<std::int64_t>(&(*items)[i].value)
                           : nullptr;
    if (side == nullptr || *side < 1 || *side > most_pixels) {
      table.fail(
          "resolution",
          side != nullptr ? fmt::format("holds {}", *side) : "is " + describe(entry->node),
          fmt::format("allowed is [columns, rows], whole numbers from 1 to {}", most_pixels));
    }
    *sides[i] = static_cast<int>(*side);
  }
}

void read_lens(Camera& camera, const TableReader& table) {
  // focus and aperture are in metres in any scene unit (docs/scene-format.md).
  const auto focus = table.length("focus", 1.0, above_zero);
  const auto aperture = table.length("aperture", 1.0, at_least_zero);
  if (focus && !aperture) {
    table.fail("focus", "is given without \"aperture\"", "depth of field needs both",
               "Add aperture = ... (m, diameter), or remove focus");
  }
  if (aperture.value_or(0.0) > 0.0 && !focus) {
    table.fail("aperture", "is given without \"focus\"", "depth of field needs both",
               "Add focus = ... (m), or remove aperture");
  }
  camera.focus_m = focus.value_or(0.0);
  camera.aperture_m = aperture.value_or(0.0);
}

void read_shutter(Camera& camera, const TableReader& table) {
  camera.motion = read_motion(table);
  camera.exposure_s = table.number("exposure_s", shutter_s).value_or(0.0);
  camera.line_s = table.number("line_s", shutter_s).value_or(0.0);
  camera.from_below = table.choice("row_order", row_orders).value_or("down") == "up";
  if (table.has("row_order") && !table.has("line_s")) {
    table.fail("row_order", "is given without \"line_s\"",
               "it is the order in which a rolling shutter exposes the rows");
  }
}

std::vector<double> read_numbers(const TableReader& table, std::string_view key) {
  std::vector<double> numbers;
  const auto add = [&](const auto& self, const TomlNode& node) -> void {
    if (const auto* items = std::get_if<TomlArray>(&node.value)) {
      for (const TomlNode& item : *items) self(self, item);
      return;
    }
    const auto* whole = std::get_if<std::int64_t>(&node.value);
    const auto* number = std::get_if<double>(&node.value);
    if ((whole == nullptr && number == nullptr) || (number != nullptr && !std::isfinite(*number))) {
      table.fail(key, "holds " + describe(node), "allowed are finite numbers");
    }
    numbers.push_back(whole != nullptr ? static_cast<double>(*whole) : *number);
  };
  if (const TomlEntry* entry = table.find(key)) add(add, entry->node);
  return numbers;
}

// Whether the key replaces `other`: it comes from an override and the other from the file. Two from
// one place are refused.
bool replaces(const TableReader& table, std::string_view key, std::string_view other) {
  const auto is_override = [&](std::string_view one) {
    return table.where(one).file != table.where().file;
  };
  if (is_override(key) == is_override(other)) {
    table.fail(other, fmt::format("cannot be combined with \"{}\"", key),
               "a camera has one of them", fmt::format("Remove {} or {}", other, key));
  }
  return is_override(key);
}

// fx and fy or K, in pixels of `resolution`.
void read_intrinsics(Camera& camera, const TableReader& table) {
  const bool from_centre =
      table.choice("pixel_origin", pixel_origins).value_or("corner") == "center";
  const double shift = from_centre ? 0.5 : 0.0;
  double fx = table.number("fx", focal_px).value_or(0.0);
  double fy = table.number("fy", focal_px).value_or(0.0);
  double cx = table.number("cx", centre_px).value_or(0.5 * camera.columns - shift);
  double cy = table.number("cy", centre_px).value_or(0.5 * camera.rows - shift);
  if (table.has("K")) {
    for (const char* key : {"fx", "fy", "cx", "cy"}) {
      if (table.has(key) && !replaces(table, "K", key)) {
        table.fail(key, "is set beside \"K\"", "K has fx, fy, cx and cy", "Set K");
      }
    }
    const std::vector<double> k = read_numbers(table, "K");
    const bool is_upper =
        k.size() == 9 && k[1] == 0.0 && k[3] == 0.0 && k[6] == 0.0 && k[7] == 0.0 && k[8] == 1.0;
    if (!is_upper || !focal_px.holds(k[0]) || !focal_px.holds(k[4]) || !centre_px.holds(k[2]) ||
        !centre_px.holds(k[5])) {
      table.fail("K", "is no matrix of a camera without skew",
                 "it is [[fx, 0, cx], [0, fy, cy], [0, 0, 1]] in pixels, fx and fy above 0");
    }
    fx = k[0], cx = k[2], fy = k[4], cy = k[5];
  }
  if (!(fx > 0.0) && !(fy > 0.0)) {
    for (const char* key : {"cx", "cy", "pixel_origin"}) {
      if (table.has(key)) {
        table.fail(key, "is given without \"fx\" and \"K\"", "it belongs to intrinsics in pixels");
      }
    }
    return;
  }
  if (!(fx > 0.0)) fx = fy;  // square pixels
  if (!(fy > 0.0)) fy = fx;
  const char* const given = table.has("K") ? "K" : table.has("fx") ? "fx" : "fy";
  if (table.has("fov_deg") && !replaces(table, given, "fov_deg")) return;
  camera.intrinsics = {fx, fy, cx + shift, cy + shift};
  camera.fov_deg = base::degrees(2.0 * std::atan(camera.rows / (2.0 * fy)));
}

void read_distortion(Camera& camera, const TableReader& table) {
  if (table.has("distortion") && table.has("fisheye")) {
    table.fail("fisheye", "cannot be combined with \"distortion\"", "a lens has one of them");
  }
  const char* key = table.has("fisheye") ? "fisheye" : "distortion";
  if (!table.has(key)) return;
  const bool is_fisheye = table.has("fisheye");
  const std::vector<double> k = read_numbers(table, key);
  if (is_fisheye ? k.size() != 4 : k.size() != 4 && k.size() != 5) {
    table.fail(
        key, fmt::format("has {} numbers", k.size()),
        is_fisheye ? "it is [k1, k2, k3, k4]" : "it is [k1, k2, p1, p2, k3]; k3 may be absent");
  }
  camera.distortion = is_fisheye ? Distortion::Fisheye : Distortion::BrownConrady;
  std::copy(k.begin(), k.end(), camera.distortion_k.begin());
  if (is_fisheye && camera.aperture_m > 0.0) {
    table.fail("fisheye", "cannot be combined with \"aperture\"",
               "a fisheye lens has no plane in focus: its depth of field is unlimited");
  }
  if (!Projection(camera, camera.columns, camera.rows).covers_picture()) {
    table.fail(key, "does not reach the picture's border",
               "over the whole picture the distance from the principal point grows with the angle "
               "to the axis",
               "Check the coefficients and the focal length, which is in pixels of `resolution`");
  }
}

void read_filter(Camera& camera, const TableReader& table) {
  std::vector<std::string_view> names;
  for (const FilterRow& row : filters) names.push_back(row.name);
  const std::string name = table.choice("filter", names).value_or("box");
  for (const FilterRow& row : filters) {
    if (row.name != name) continue;
    camera.filter = row.shape;
    camera.filter_width_px = table.number("filter_width", filter_widths).value_or(row.width_px);
  }
}

Setting read_setting(const TableReader& table, const TomlEntry& entry) {
  Setting setting{entry.key, false, entry.where};
  const TomlNode& node = entry.node;
  if (const auto* flag = std::get_if<bool>(&node.value)) {
    setting.value = *flag;
  } else if (std::holds_alternative<std::string>(node.value)) {
    setting.value = *table.text(entry.key);
  } else if (const auto* items = std::get_if<TomlArray>(&node.value)) {
    std::vector<double> numbers;
    for (const TomlNode& item : *items) {
      const auto* whole = std::get_if<std::int64_t>(&item.value);
      const auto* number = std::get_if<double>(&item.value);
      if ((whole == nullptr && number == nullptr) ||
          (number != nullptr && !std::isfinite(*number))) {
        table.fail(entry.key, "holds " + describe(item), "allowed are finite numbers");
      }
      numbers.push_back(whole != nullptr ? static_cast<double>(*whole) : *number);
    }
    setting.value = std::move(numbers);
  } else if (std::holds_alternative<std::int64_t>(node.value) ||
             std::holds_alternative<double>(node.value)) {
    setting.value = *table.number(entry.key);
  } else {
    table.fail(entry.key, "is " + describe(node),
               "allowed is true or false, a number, a string or an array of numbers");
  }
  return setting;
}

}  // namespace

std::string_view filter_name(FilterShape shape) {
  for (const FilterRow& row : filters) {
    if (row.shape == shape) return row.name;
  }
  return "";
}

Camera read_camera(const TomlNode& node, double unit_m, const JointPoses& joints) {
  TableReader table(node, "[[camera]]", camera_keys);
  Camera camera;
  camera.name = table.read_name();
  camera.position =
      table.required(table.position("position", unit_m), "position", "position = [x, y, z]");
  camera.look_at =
      table.required(table.position("look_at", unit_m), "look_at", "look_at = [x, y, z]");
  camera.where = table.where("position");
  const Vec3 view = camera.look_at - camera.position;
  if (!(glm::length(view) > least_relative_view * std::max(unit_m, glm::length(camera.position)))) {
    table.fail("look_at", "is the camera's own position",
               "it is another point, far enough away to give a direction");
  }
  camera.up = table.direction("up").value_or(camera.up);
  if (!(glm::length(glm::cross(glm::normalize(view), camera.up)) > 1e-6)) {
    table.fail(table.has("up") ? "up" : "look_at", "makes the view parallel to up",
               "up, [0, 0, 1] unless given, is a direction across the view",
               "Give another up = [x, y, z]");
  }
  camera.joint = table.text("joint").value_or("");
  const Pose pose = joints.of(table);
  camera.position = pose.point(camera.position);
  camera.look_at = pose.point(camera.look_at);
  camera.up = pose.rotation * camera.up;
  camera.fov_deg = table.number("fov_deg", {0.0, 180.0, true, true}).value_or(camera.fov_deg);
  read_resolution(camera, table);
  read_intrinsics(camera, table);
  read_lens(camera, table);
  read_shutter(camera, table);
  read_distortion(camera, table);
  read_filter(camera, table);
  camera.cctv = table.text("cctv").value_or("");
  camera.range_sensor = table.text("range_sensor").value_or("");
  if (table.has("cctv")) camera.cctv_at = table.where("cctv");
  if (table.has("range_sensor")) camera.range_sensor_at = table.where("range_sensor");
  return camera;
}

SettingTable read_settings(const TomlNode& node, const std::string& title, bool named) {
  // degrade/ knows the keys and rejects unknown ones.
  std::vector<std::string_view> keys;
  if (const auto* entries = std::get_if<TomlTable>(&node.value)) {
    if (entries->size() > most_settings) {
      throw base::Error(base::Blame::Input, node.where,
                        fmt::format("{} has {} keys", title, entries->size()),
                        fmt::format("it has at most {}", most_settings));
    }
    for (const TomlEntry& entry : *entries) keys.push_back(entry.key);
  }
  TableReader table(node, title, keys);
  SettingTable settings;
  settings.name = named ? table.read_name() : "monitor";
  settings.where = node.where;
  for (const TomlEntry& entry : std::get<TomlTable>(node.value)) {
    if (named && entry.key == "name") continue;
    settings.settings.push_back(read_setting(table, entry));
  }
  return settings;
}

// Obsolete keys, read as the current key with the nearest meaning.
void read_former_keys(Quality& quality, const TableReader& table,
                      std::vector<std::string>& warnings) {
  const auto warn = [&](const char* key, const std::string& as) {
    warnings.push_back(fmt::format("{}: quality.{} is a key of former versions, read as {}",
                                   base::to_string(table.where(key)), key, as));
  };
  const auto no_denoising = [&](const char* key, bool off) {
    if (off && !quality.denoise) quality.denoise = false;
    warn(key, off ? "denoise = false" : "denoise = true");
  };
  const auto gather = table.text("gather");
  if (gather && *gather != "shared" && *gather != "per-sample") {
    table.fail("gather", fmt::format("is \"{}\"", *gather),
               "allowed is \"shared\" or \"per-sample\"");
  }
  if (gather) no_denoising("gather", *gather == "per-sample");
  const auto smooth = table.number("smooth", {0.0, 1.0, false});
  if (smooth) no_denoising("smooth", *smooth == 0.0);
  const auto noise = table.number("picture_noise", {0.0, 1.0, true});
  if (!noise) return;
  // Gather noise was 1.5 times the wanted error.
  const int samples = camera_samples_for(*noise / 1.5);
  if (!quality.camera_samples) quality.camera_samples = samples;
  warn("picture_noise", fmt::format("camera_samples = {}", samples));
}

Quality read_quality(const TomlNode& node, std::vector<std::string>& warnings) {
  const TableReader table(node, "[quality]", quality_keys);
  Quality quality;
  quality.error = table.number("error", {0.0, 1.0, true});
  quality.patch_edge_m = table.length("patch_edge", 1.0, above_zero);  // metres in any unit
  quality.max_patches = table.whole("max_patches", 1, 1 << 26);
  quality.refine = table.flag("refine");
  if (quality.max_patches && !quality.refine.value_or(true)) {
    table.fail("max_patches", "is the budget of refinement, which refine = false turns off",
               "patch_edge sets the size of patches that are all alike",
               "Leave out max_patches or refine");
  }
  quality.form_factor_rays = table.whole("form_factor_rays", 1, 1 << 24);
  quality.gather_rays = table.whole("gather_rays", 1, 1 << 20);
  quality.solver_tolerance = table.number("solver_tolerance", {0.0, 0.1, true});
  quality.camera_samples = table.whole("camera_samples", 1, 1 << 20);
  quality.denoise = table.flag("denoise");
  read_former_keys(quality, table, warnings);
  return quality;
}

}  // namespace earthshine::scenes
