// SPDX-License-Identifier: Apache-2.0
#include "app/console/live_scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>

#include "app/console.h"
#include "app/render/draw.h"
#include "app/render/error_json.h"
#include "app/render/light.h"
#include "base/error.h"
#include "raytrace/frame/first_hit.h"
#include "raytrace/preview.h"
#include "scenes/read/include.h"
#include "scenes/read/override.h"
#include "scenes/text/toml_file.h"
#include "scenes/time/linkage.h"
#include "scenes/triangle_point.h"

namespace earthshine::app {
namespace {

using base::Blame;
using base::Error;

[[noreturn]] void refuse(const std::string& key, const std::string& found,
                         const std::string& allowed) {
  throw Error(Blame::Input, "request", (key.empty() ? "" : "\"" + key + "\" ") + found, allowed);
}

constexpr double largest_number = 1e9;

double number_of(const Json& value, const std::string& key) {
  if (!value.is_number()) refuse(key, "is no number", "numbers are finite");
  const double number = value.get<double>();
  if (!(std::abs(number) <= largest_number)) {
    refuse(key, "is out of range", "numbers are finite and at most 1e9");
  }
  return number;
}

std::vector<double> numbers_of(const Json& value, const std::string& key, std::size_t count) {
  if (count == 1) return {number_of(value, key)};
  if (!value.is_array() || value.size() != count) {
    refuse(key, fmt::format("is no list of {} numbers", count), {});
  }
  std::vector<double> numbers;
  for (const Json& one : value) numbers.push_back(number_of(one, key));
  return numbers;
}

Vec3 vector_of(const Json& view, const char* key) {
  const std::vector<double> v = numbers_of(view.value(key, Json()), std::string("view.") + key, 3);
  return {v[0], v[1], v[2]};
}

int whole_of(const Json& value, const std::string& key, int least, int most) {
  const double number = number_of(value, key);
  if (number != std::floor(number) || number < least || number > most) {
    refuse(key, "is out of range", fmt::format("whole numbers from {} to {}", least, most));
  }
  return static_cast<int>(number);
}

void check_keys(const Json& json, const std::string& where,
                std::initializer_list<const char*> allowed) {
  for (const auto& [key, value] : json.items()) {
    if (std::ranges::none_of(allowed, [&](const char* one) { return key == one; })) {
      refuse(where + key, "is unknown", fmt::format("allowed are {}", fmt::join(allowed, ", ")));
    }
  }
}

LiveRequest::View view_of(const Json& json) {
  if (!json.is_object()) refuse("view", "is no object", {});
  check_keys(json, "view.", {"position", "look_at", "up", "fov_deg"});
  LiveRequest::View view;
  view.position = vector_of(json, "position");
  view.look_at = vector_of(json, "look_at");
  view.up = vector_of(json, "up");
  view.fov_deg = number_of(json.value("fov_deg", Json()), "view.fov_deg");
  const Vec3 along = view.look_at - view.position;
  const bool has_axes = glm::length(along) > 1e-6 &&
                        glm::length(glm::cross(along, view.up)) > 1e-9 * glm::length(along);
  if (!has_axes) refuse("view", "has no direction", "look_at is off position, up is off the axis");
  if (!(view.fov_deg >= 1.0 && view.fov_deg <= 170.0)) {
    refuse("view.fov_deg", "is out of range", "1 to 170 degrees");
  }
  return view;
}

// The key of a table that may be moved, and the count of its numbers.
struct MovableKey {
  const char *table, *key;
  std::size_t count;
  MovableKind kind;
};
constexpr MovableKey movable_keys[] = {{"light", "position", 3, MovableKind::Lamp},
                                       {"object", "translate", 3, MovableKind::Object},
                                       {"joint", "angle_deg", 1, MovableKind::Joint}};

std::size_t count_of(const std::string& key) {
  for (const MovableKey& one : movable_keys) {
    if (key.starts_with(std::string(one.table) + ".") &&
        key.ends_with(std::string(".") + one.key)) {
      return one.count;
    }
  }
  refuse("set." + key, "cannot be moved",
         "light.NAME.position, object.NAME.translate or joint.NAME.angle_deg");
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

Json camera_json(const scenes::Camera& camera) {
  return {{"position", to_json(camera.position)},
          {"look_at", to_json(camera.look_at)},
          {"up", to_json(camera.up)},
          {"fov_deg", camera.fov_deg}};
}

std::string answer_of(const Json& head, const base::Image& image, const base::Image& layers) {
  const std::string text = dump(head);
  const auto length = static_cast<std::uint32_t>(text.size());
  std::string bytes;
  for (const unsigned shift : {0U, 8U, 16U, 24U}) {
    bytes.push_back(static_cast<char>((length >> shift) & 0xFFU));
  }
  bytes += text;
  const auto append = [&bytes](const std::vector<float>& values) {
    const std::size_t begin = bytes.size();
    bytes.resize(begin + values.size() * sizeof(float));
    std::memcpy(bytes.data() + begin, values.data(), values.size() * sizeof(float));
  };
  for (const char* name : {"R", "G", "B"}) append(image.find(name)->values);
  for (const base::Channel& channel : layers.channels) append(channel.values);
  return bytes;
}

}  // namespace

LiveRequest read_live_request(std::string_view text) {
  // Deep nesting would overflow the parser's stack of values only beyond 64 KiB of brackets.
  const Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded() || !json.is_object()) refuse({}, "is no JSON object", {});
  check_keys(json, "", {"camera", "columns", "rows", "view", "set", "level"});
  LiveRequest request;
  const Json camera = json.value("camera", Json());
  if (!camera.is_string()) refuse("camera", "is no text", "the name of a camera");
  request.camera = camera.get<std::string>();
  constexpr int least = 16, most = 1024;
  if (json.contains("columns"))
    request.size.columns = whole_of(json["columns"], "columns", least, most);
  if (json.contains("rows")) request.size.rows = whole_of(json["rows"], "rows", least, most);
  if (json.contains("view")) request.view = view_of(json["view"]);
  if (json.contains("level")) {
    request.level = static_cast<std::size_t>(
        whole_of(json["level"], "level", 0, static_cast<int>(std::size(level_errors))));
  }
  const Json set = json.value("set", Json::object());
  if (!set.is_object()) refuse("set", "is no object", {});
  for (const auto& [key, value] : set.items()) {
    request.set.emplace_back(key, numbers_of(value, "set." + key, count_of(key)));
  }
  return request;
}

LiveScene::LiveScene(const SceneInput& input, const Common& common)
    : common_(common), own_set_(input.overrides) {
  common_.quiet = true;
  common_.progress = std::make_shared<Progress>(true);
  scene_.path = input.path;
  scene_.set(own_set_);
  scene_.read();
  cameras_ = scene_.loaded.scene.cameras;
  movables_ = movables();
  description_ = describe();
}

std::vector<LiveScene::Movable> LiveScene::movables() const {
  std::vector<Movable> found;
  scenes::TomlNode root = scenes::read_toml(scene_.path);
  std::vector<std::filesystem::path> files;
  std::vector<scenes::LampOff> off;
  scenes::add_includes(root, scene_.path, files);
  for (const std::string& own : own_set_) scenes::apply_override(root, own, std::nullopt, off);
  for (const auto& [table, key, count, kind] : movable_keys) {
    const auto* list = scenes::find_entry(std::get<scenes::TomlTable>(root.value), table);
    const auto* entries = list ? std::get_if<scenes::TomlArray>(&list->node.value) : nullptr;
    if (entries == nullptr) continue;
    for (const scenes::TomlNode& entry : *entries) {
      const auto& keys = std::get<scenes::TomlTable>(entry.value);
      const auto* name = scenes::find_entry(keys, "name");
      const auto* text = name ? std::get_if<std::string>(&name->node.value) : nullptr;
      const auto* value = scenes::find_entry(keys, key);
      // Without the key: objects and joints are at 0, a lamp without a position has none.
      if (text == nullptr || (value == nullptr && kind == MovableKind::Lamp)) continue;
      std::vector<double> numbers =
          value ? scenes::numbers_of(value->node) : std::vector<double>(count, 0.0);
      if (numbers.size() != count) continue;
      Movable& one = found.emplace_back(
          Movable{fmt::format("{}.{}.{}", table, *text, key), numbers, kind, {}, false, {}});
      find_in_scene(one, *text, keys);
    }
  }
  return found;
}

Json LiveScene::describe() const {
  Json cameras = Json::array(), movables = Json::array();
  for (const scenes::Camera& camera : cameras_) {
    Json& one = cameras.emplace_back(camera_json(camera));
    one["name"] = camera.name;
    one["columns"] = camera.columns;
    one["rows"] = camera.rows;
  }
  for (const Movable& one : movables_) movables.push_back({{"key", one.key}, {"value", one.value}});
  const std::string& name = scene_.loaded.scene.name;
  return {{"scene", name.empty() ? std::filesystem::path(scene_.path).stem().string() : name},
          {"path", scene_.path},
          {"unit_m", scene_.loaded.scene.unit_m},
          {"cameras", cameras},
          {"movables", movables},
          {"level_errors", level_errors}};
}

void LiveScene::find_in_scene(Movable& one, const std::string& name,
                              const scenes::TomlTable& keys) const {
  const scenes::Scene& scene = scene_.loaded.scene;
  const auto index_in = [&](const auto& list) {
    const auto found =
        std::ranges::find_if(list, [&](const auto& item) { return item.name == name; });
    return found == list.end() ? std::nullopt
                               : std::optional(static_cast<std::size_t>(found - list.begin()));
  };
  if (one.kind == MovableKind::Object) {
    one.index = index_in(scene.objects);
    one.moves_warm = one.index.has_value();
  } else if (one.kind == MovableKind::Joint) {
    if (scene.linkage) one.index = index_in(scene.linkage->joints);
    one.moves_warm = one.index && !scene.linkage->joints[*one.index].moves();
  } else {
    one.index = index_in(scene.lamps);
    if (!one.index) return;
    const scenes::LampKind kind = scene.lamps[*one.index].kind;
    if (kind == scenes::LampKind::Spot) {
      const auto* aim = scenes::find_entry(keys, "aim");
      const std::vector<double> at = aim ? scenes::numbers_of(aim->node) : std::vector<double>();
      if (at.size() != 3) return;
      one.aim_m = scene.unit_m * Vec3(at[0], at[1], at[2]);
    }
    one.moves_warm = kind == scenes::LampKind::Point || one.aim_m;
  }
}

std::optional<scenes::PoseChange> LiveScene::change_to(const Set& set) const {
  const auto value_in = [](const Set& values, const Movable& one) {
    const auto found = std::ranges::find(values, one.key, &Set::value_type::first);
    return found == values.end() ? one.value : found->second;
  };
  scenes::PoseChange change;
  for (const Movable& one : movables_) {
    const std::vector<double> now = value_in(set, one), before = value_in(read_set_, one);
    if (now == before) continue;
    if (!one.moves_warm) return std::nullopt;
    if (one.kind == MovableKind::Joint) {
      change.joints.push_back({*one.index, now[0]});
      continue;
    }
    const double unit_m = scene_.loaded.scene.unit_m;
    const Vec3 at_m = unit_m * Vec3(now[0], now[1], now[2]);
    const Vec3 shift_m = at_m - unit_m * Vec3(before[0], before[1], before[2]);
    if (one.kind == MovableKind::Object) {
      change.objects.push_back({*one.index, shift_m});
      continue;
    }
    std::optional<Vec3> axis;
    if (one.aim_m) {
      if (*one.aim_m == at_m) refuse("set." + one.key, "is the lamp's own aim", {});
      axis = glm::normalize(*one.aim_m - at_m);
    }
    change.lamps.push_back({*one.index, shift_m, axis});
  }
  return change;
}

Json LiveScene::marks() const {
  const scenes::Scene& scene = scene_.loaded.scene;
  std::vector<scenes::JointState> joints;
  if (scene.linkage) joints = scenes::joints_now(scene);
  Json marks = Json::array();
  for (const Movable& one : movables_) {
    if (!one.index) continue;
    Json mark = {{"key", one.key}};
    std::string hangs_on;
    if (one.kind == MovableKind::Object) {
      mark["object"] = *one.index;
      mark["at"] = to_json(scenes::bounds_of(scene, scene.objects[*one.index]).middle());
      hangs_on = scene.objects[*one.index].joint;
    } else if (one.kind == MovableKind::Lamp) {
      mark["at"] = to_json(scene.lamps[*one.index].position);
      hangs_on = scene.lamps[*one.index].joint;
    } else {
      const scenes::Joint& joint = scene.linkage->joints[*one.index];
      mark["at"] = to_json(joints[*one.index].pose.point(joint.pivot_m));
      mark["axis"] = to_json(joints[*one.index].pose.rotation * joint.axis);
    }
    if (!hangs_on.empty()) {
      const std::size_t k = scenes::joint_index(*scene.linkage, hangs_on);
      for (int column = 0; column < 3; ++column) {
        mark["rotation"].push_back(to_json(joints[k].pose.rotation[column]));
      }
    }
    marks.push_back(std::move(mark));
  }
  return marks;
}

void LiveScene::apply(const LiveRequest& request) {
  std::vector<std::string> changes = own_set_;
  for (const auto& [key, value] : request.set) {
    if (std::ranges::find(movables_, key, &Movable::key) == movables_.end()) {
      refuse("set." + key, "is not in the scene", {});
    }
    changes.push_back(value.size() == 1 ? fmt::format("{}={}", key, value.front())
                                        : fmt::format("{}=[{}]", key, fmt::join(value, ", ")));
  }
  if (scene_.is_read) scene_.loaded.scene.cameras = cameras_;
  // A level's picture is that of the scene read with these values, to the byte.
  const auto change = request.level == 0 && scene_.is_read && request.set != read_set_
                          ? change_to(request.set)
                          : std::nullopt;
  if (change) {
    if (request.set != pose_set_) scene_.pose(*change);
  } else {
    scene_.set(std::move(changes));
    const std::size_t reads = scene_.reads;
    scene_.read();
    read_set_ = request.set;
    if (scene_.reads > reads) {  // the file may have changed
      movables_ = movables();
      light_.reset();
    }
  }
  pose_set_ = request.set;
  cameras_ = scene_.loaded.scene.cameras;
  const auto found =
      std::ranges::find(scene_.loaded.scene.cameras, request.camera, &scenes::Camera::name);
  if (found == scene_.loaded.scene.cameras.end()) {
    refuse("camera", "names no camera of the scene", {});
  }
  if (!request.view) return;
  found->position = request.view->position;
  found->look_at = request.view->look_at;
  found->up = request.view->up;
  found->fov_deg = request.view->fov_deg;
}

base::Image LiveScene::at_once(const RenderCall& call, const scenes::Camera& camera,
                               const Size& size, Json& head) {
  if (light_ && light_->solved && light_set_ == pose_set_) {
    head["kind"] = "patches";
    return raytrace::preview(scene_.loaded.world(*scene_.query), light_->solution,
                             raytrace::make_camera_model(camera, size.columns, size.rows));
  }
  // Other light: the samples of a small picture. The solution before the move makes it no better
  // (docs/console.md) and half as slow again.
  Solved none;
  none.solution = radiosity::unsolved(scene_.loaded.groups);
  RenderCall small = call;
  small.size = Size{std::max(16, size.columns / 4), std::max(16, size.rows / 4)};
  small.no_error = true;
  scene_.loaded.scene.quality.gather_rays = 4;
  scene_.loaded.scene.quality.camera_samples = 1;
  const RenderContext context{small, common_, scene_.loaded, *scene_.query, none};
  head["kind"] = "samples";
  return draw_frame(context, camera, picture_options(small, common_, scene_.loaded, camera)).image;
}

base::Image LiveScene::sampled(RenderCall& call, const scenes::Camera& camera, Json& head) {
  StageTimes times;
  const Solved& light = scene_.light_for(call, common_, times);
  if (Interrupt::asked()) return {};
  light_ = light;
  light_set_ = read_set_;
  const RenderContext context{call, common_, scene_.loaded, *scene_.query, light};
  Drawn drawn = draw_picture(context, camera, times);
  head["kind"] = "samples";
  head["error"] = error_json(drawn, scene_.loaded.scene.quality.error);
  return std::move(drawn.frame.image);
}

std::optional<std::string> LiveScene::draw(const LiveRequest& request) {
  const auto start = std::chrono::steady_clock::now();
  const std::uint64_t number = ++newest_;
  Interrupt::ask(true);  // ends an older picture
  const std::lock_guard<std::mutex> lock(drawing_);
  if (number != newest_) return std::nullopt;
  Interrupt::ask(false);
  apply(request);
  RenderCall call;
  call.scene.path = scene_.path;
  call.cameras = {request.camera};
  // The first level is quick: half the columns and rows.
  call.size = request.size;
  if (request.level == 1) {
    call.size = Size{std::max(16, request.size.columns / 2), std::max(16, request.size.rows / 2)};
  }
  const auto cameras = wanted_cameras(call.cameras, scene_.loaded.scene);
  const double error = level_errors[request.level == 0 ? 0 : request.level - 1];
  scene_.prepare(call, cameras, true, error);
  Json head = {{"level", request.level}, {"error", nullptr}};
  base::Image image = request.level == 0 ? at_once(call, *cameras.front(), request.size, head)
                                         : sampled(call, *cameras.front(), head);
  if (Interrupt::asked() || image.channels.empty()) return std::nullopt;
  head["columns"] = image.width;
  head["rows"] = image.height;
  base::Image layers;
  if (request.level == 0) {
    layers.width = request.size.columns;
    layers.height = request.size.rows;
    for (const char* name : {"object", "Z"}) layers.add(name);
    raytrace::fill_first_hit(
        scene_.loaded.scene, *scene_.query,
        raytrace::make_camera_model(*cameras.front(), layers.width, layers.height),
        {0, 0, layers.width, layers.height}, layers);
    head["layers"] = {{"columns", layers.width}, {"rows", layers.height}};
    head["camera"] = camera_json(*cameras.front());
    head["marks"] = marks();
  }
  head["seconds"] = seconds_since(start);
  return answer_of(head, image, layers);
}

}  // namespace earthshine::app
