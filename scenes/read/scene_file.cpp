// SPDX-License-Identifier: Apache-2.0
#include "scenes/read/scene_file.h"

#include <fmt/format.h>

#include "base/free_memory.h"
#include "scenes/health/coincident.h"
#include "scenes/health/mend.h"
#include "scenes/health/small_objects.h"
#include "scenes/read/include.h"
#include "scenes/read/override.h"
#include "scenes/read/scene_parts.h"
#include "scenes/sky/airglow.h"
#include "scenes/sky/moon.h"
#include "scenes/surface_texture.h"
#include "scenes/text/toml_file.h"
#include "scenes/triangle_point.h"

namespace earthshine::scenes {
namespace {

constexpr std::string_view root_keys[] = {
    "format",  "name",         "unit",    "material", "object",  "light",  "area",
    "sun",     "earth",        "orbit",   "time",     "ambient", "camera", "cctv",
    "monitor", "range_sensor", "quality", "joint",    "moon",    "track",  "airglow"};
constexpr std::string_view camera_file_keys[] = {"cctv", "monitor"};
constexpr std::string_view ambient_keys[] = {"radiance"}, airglow_keys[] = {"radiance"};
constexpr std::string_view units[] = {"m", "cm", "mm", "ft", "in"};
constexpr double metres_per_unit[] = {1.0, 0.01, 0.001, 0.3048, 0.0254};
static_assert(std::size(units) == std::size(metres_per_unit));

// A study file has other keys.
void refuse_study(const TomlNode& tree) {
  for (const char* key : {"scene", "scenes"}) {
    const TomlEntry* const entry = find_entry(std::get<TomlTable>(tree.value), key);
    if (entry == nullptr) continue;
    throw base::Error(base::Blame::Input, entry->where,
                      fmt::format("\"{}\" makes this a study file", key),
                      "a scene file is wanted here",
                      "Give it to earthshine study run, or give the scene that it names");
  }
}

double read_unit(const TableReader& root) {
  const std::string unit = root.choice("unit", units).value_or("m");
  for (std::size_t i = 0; i < std::size(units); ++i) {
    if (units[i] == unit) return metres_per_unit[i];
  }
  return 1.0;
}

const TomlNode* plain_table(const TableReader& root, std::string_view key) {
  const TomlEntry* entry = root.find(key);
  return entry == nullptr ? nullptr : &entry->node;
}

// Reads the entries of [[key]] in order and checks that names are unique.
template <class Read>
void read_named(const TableReader& root, std::string_view key, Read read) {
  const auto entries = named_entries(root, key);
  std::vector<std::string> names;
  names.reserve(entries.size());
  for (const TomlNode* entry : entries) names.push_back(read(*entry));
  check_unique(names, entries, fmt::format("[[{}]]", key));
}

void read_cctv(Scene& scene, const TableReader& root) {
  read_named(root, "cctv", [&](const TomlNode& node) {
    return scene.cctv.emplace_back(read_settings(node, "[[cctv]]", true)).name;
  });
  if (const TomlNode* node = plain_table(root, "monitor")) {
    scene.monitor = read_settings(*node, "[monitor]", false);
  }
}

// A bay of ten kilometres lacks its unit. Small scenes are checked by the cameras' views
// (scenes/plausible).
void check_size(Scene& scene) {
  constexpr double large_m = 300.0;
  if (scene.vertices.empty()) return;
  const double across = box_around(scene.vertices).diagonal();
  if (across <= large_m) return;
  scene.warnings.push_back(fmt::format(
      "the surfaces are {:.3g} m across; are unit, and scale of the objects, right?", across));
}

}  // namespace

void check_format(const TableReader& root) {
  const char* const wanted = "this program reads format = 1";
  const TomlEntry* entry = root.find("format");
  if (entry == nullptr) {
    throw base::Error(base::Blame::Input, base::Location{root.where().file, 1, 1},
                      root.label() + " has no \"format\"", wanted,
                      "Begin the file with format = 1");
  }
  const auto* format = std::get_if<std::int64_t>(&entry->node.value);
  if (format != nullptr && *format == 1) return;
  throw base::Error(base::Blame::Input, entry->where,
                    fmt::format("\"format\" is {}", describe(entry->node)), wanted,
                    format == nullptr ? "Write it as the whole number 1"
                                      : "Another version of the program may read it");
}

Scene read_camera_file(const std::filesystem::path& path) {
  TomlNode tree = read_toml(path);
  const bool whole_scene = find_entry(std::get<TomlTable>(tree.value), "format") != nullptr;
  Scene scene;
  if (whole_scene) add_includes(tree, path, scene.files);
  const TableReader root(tree, whole_scene ? "the scene" : "a camera file",
                         whole_scene ? KeyList(root_keys) : KeyList(camera_file_keys));
  if (whole_scene) check_format(root);
  scene.path = path;
  scene.name = path.stem().string();
  read_cctv(scene, root);
  return scene;
}

namespace {

Scene scene_of(TomlNode tree, const std::filesystem::path& path,
               std::span<const std::string> overrides,
               const std::optional<base::Location>& overrides_at) {
  refuse_study(tree);
  Scene scene;
  scene.path = path;
  add_includes(tree, path, scene.files);
  std::vector<LampOff> off;
  for (const std::string& setting : overrides) apply_override(tree, setting, overrides_at, off);

  const TableReader root(tree, "the scene", root_keys);
  check_format(root);
  scene.name = root.text("name").value_or(path.stem().string());
  const double unit_m = scene.unit_m = read_unit(root);

  read_named(root, "material", [&](const TomlNode& node) {
    return scene.materials.emplace_back(read_material(node)).name;
  });
  read_sky(scene, {plain_table(root, "sun"), plain_table(root, "earth"), plain_table(root, "orbit"),
                   plain_table(root, "time"), plain_table(root, "moon")});
  read_linkage(scene, root, unit_m);
  const JointPoses joints(scene);
  LuminaireShelf luminaires(path.parent_path());
  read_named(root, "light", [&](const TomlNode& node) {
    return scene.lamps.emplace_back(read_lamp(node, unit_m, joints, luminaires)).name;
  });
  read_named(root, "area", [&](const TomlNode& node) {
    return scene.areas.emplace_back(read_area(node, unit_m)).name;
  });
  if (scene.moon) add_moon_lamp(scene, plain_table(root, "moon")->where);
  if (const TomlNode* node = plain_table(root, "airglow")) {
    const TableReader table(*node, "[airglow]", airglow_keys);
    add_airglow_lamps(scene, table.colour("radiance").value_or(Rgb(usual_airglow_cd_m2)),
                      node->where);
  }
  const auto tables = luminaires.files();
  scene.files.insert(scene.files.end(), tables.begin(), tables.end());
  for (std::string& warning : luminaires.warnings()) scene.warnings.push_back(std::move(warning));
  if (const TomlNode* node = plain_table(root, "ambient")) {
    const TableReader table(*node, "[ambient]", ambient_keys);
    scene.ambient_radiance = table.colour("radiance").value_or(Rgb(0.0));
  }
  read_named(root, "camera", [&](const TomlNode& node) {
    return scene.cameras.emplace_back(read_camera(node, unit_m, joints)).name;
  });
  read_cctv(scene, root);
  read_named(root, "range_sensor", [&](const TomlNode& node) {
    return scene.range_sensors.emplace_back(read_settings(node, "[[range_sensor]]", true)).name;
  });
  if (const TomlNode* node = plain_table(root, "quality"))
    scene.quality = read_quality(*node, scene.warnings);

  // Objects last: meshes take longest to read, so that other errors appear at once.
  MeshShelf shelf(path.parent_path(), scene.materials.size());
  InstanceReader instances;
  FileFronts fronts;
  read_named(root, "object", [&](const TomlNode& node) {
    if (const auto name = instances.take(node)) return *name;
    const Placement placement = read_object(scene, node, unit_m, joints, shelf, fronts);
    instances.know(scene.objects.back().name, placement);
    return scene.objects.back().name;
  });
  switch_off(scene, off);
  constexpr std::size_t mending_bytes = 56;  // per triangle, measured on spheres
  base::check_room(scene.triangles.size() * mending_bytes, path.string());
  FaceParts parts = mend_surfaces(scene, fronts);
  instances.finish(scene, unit_m, joints, shelf.own_material_count());
  check_size(scene);
  settle_textures(scene);
  lift_lamps(scene);
  add_instances(parts, scene);
  find_coincident_faces(scene, parts);
  scene.face_parts = std::make_shared<const FaceParts>(std::move(parts));
  name_small_objects(scene);
  return scene;
}

}  // namespace

Scene read_scene(const std::filesystem::path& path, std::span<const std::string> overrides,
                 const std::optional<base::Location>& overrides_at) {
  Scene scene = scene_of(read_toml(path), path, overrides, overrides_at);
  scene.files.insert(scene.files.begin(), path);
  return scene;
}

Scene read_scene_text(std::string_view text, const std::filesystem::path& path,
                      std::span<const std::string> overrides) {
  return scene_of(parse_toml(text, path.string()), path, overrides, std::nullopt);
}

}  // namespace earthshine::scenes
