// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "scenes/light/lamp_light.h"
#include "scenes/read/scene_parts.h"
#include "scenes/text/table_reader.h"

namespace earthshine::scenes {
namespace {

constexpr std::string_view motion_keys[] = {"velocity", "spin"};
constexpr std::string_view point_keys[] = {"joint",    "name",      "group", "type",
                                           "position", "intensity", "flux"};
constexpr std::string_view spot_keys[] = {"joint", "name",      "group", "type",     "position",
                                          "aim",   "intensity", "flux",  "beam_deg", "field_deg"};
constexpr std::string_view rectangle_keys[] = {"joint",  "name",   "group",    "type", "center",
                                               "edge_u", "edge_v", "exitance", "flux"};
constexpr std::string_view disk_keys[] = {"joint",  "name",   "group",    "type", "center",
                                          "normal", "radius", "exitance", "flux"};
constexpr std::string_view distant_keys[] = {"joint", "name",      "group",
                                             "type",  "direction", "illuminance"};
constexpr std::string_view ies_keys[] = {"joint", "name", "group", "type",  "file",    "position",
                                         "aim",   "up",   "flux",  "color", "tilt_deg"};

// The lamp's strength, given directly or as flux, which is flux_per_unit times the strength.
Rgb read_strength(const TableReader& table, std::string_view key, double flux_per_unit) {
  const auto strength = table.colour(key);
  const auto flux = table.colour("flux");
  if (strength && flux) {
    table.fail("flux", fmt::format("cannot be combined with \"{}\"", key),
               "a light has one of the two");
  }
  if (!strength && !flux) {
    table.missing(key, fmt::format("{} = ... ({}) or flux = ... (lm)", key,
                                   key == "intensity" ? "cd" : "lm/m^2"));
  }
  return strength ? *strength : *flux / flux_per_unit;
}

// Position, and axis toward the aim.
void read_aim(Lamp& lamp, const TableReader& table, double unit_m) {
  lamp.position =
      table.required(table.position("position", unit_m), "position", "position = [x, y, z]");
  const Vec3 aim = table.required(table.position("aim", unit_m), "aim", "aim = [x, y, z]");
  const double distance = glm::length(aim - lamp.position);
  if (!(distance > 1e-9 * unit_m)) table.fail("aim", "is the light's own position");
  lamp.axis = (aim - lamp.position) / distance;
}

void read_point(Lamp& lamp, const TableReader& table, double unit_m, LuminaireShelf&) {
  lamp.position =
      table.required(table.position("position", unit_m), "position", "position = [x, y, z]");
  lamp.intensity_cd = read_strength(table, "intensity", 4.0 * base::pi);
}

void read_spot(Lamp& lamp, const TableReader& table, double unit_m, LuminaireShelf&) {
  read_aim(lamp, table, unit_m);
  lamp.field_deg = table.required(table.number("field_deg", {0.0, 180.0, true}), "field_deg",
                                  "field_deg = ..., the full angle beyond which there is no light");
  lamp.beam_deg = table.required(table.number("beam_deg", {0.0, 180.0}), "beam_deg",
                                 "beam_deg = ..., the full angle of the cone of full intensity");
  if (lamp.beam_deg > lamp.field_deg) {
    table.fail("beam_deg", fmt::format("is {}", lamp.beam_deg),
               fmt::format("allowed is at most field_deg, {}", lamp.field_deg));
  }
  // Full intensity within the beam, then a smoothstep in cos(theta) to 0 at the edge of the field.
  // The mean of the step is one half, so Phi = I 2 pi (1 - (cos beam/2 + cos field/2) / 2).
  const double cos_beam = std::cos(base::radians(lamp.beam_deg / 2.0));
  const double cos_field = std::cos(base::radians(lamp.field_deg / 2.0));
  lamp.intensity_cd =
      read_strength(table, "intensity", 2.0 * base::pi * (1.0 - 0.5 * (cos_beam + cos_field)));
}

// center, edge_u and edge_v of a lamp or an [[area]].
Area read_sides(const TableReader& table, double unit_m) {
  Area sides;
  sides.center = table.required(table.position("center", unit_m), "center", "center = [x, y, z]");
  sides.edge_u = table.required(table.position("edge_u", unit_m), "edge_u", "edge_u = [x, y, z]");
  sides.edge_v = table.required(table.position("edge_v", unit_m), "edge_v", "edge_v = [x, y, z]");
  const Vec3 normal = glm::cross(sides.edge_u, sides.edge_v);
  const double area = glm::length(normal);
  if (!(area > 1e-9 * glm::length(sides.edge_u) * glm::length(sides.edge_v)) || !(area > 0.0)) {
    table.fail("edge_v", "spans no area with edge_u",
               "the edges have lengths and are not parallel");
  }
  sides.normal = normal / area;
  return sides;
}

void read_rectangle(Lamp& lamp, const TableReader& table, double unit_m, LuminaireShelf&) {
  const Area sides = read_sides(table, unit_m);
  lamp.position = sides.center;
  lamp.edge_u = sides.edge_u;
  lamp.edge_v = sides.edge_v;
  lamp.axis = sides.normal;
  lamp.exitance =
      read_strength(table, "exitance", glm::length(glm::cross(sides.edge_u, sides.edge_v)));
}

void read_disk(Lamp& lamp, const TableReader& table, double unit_m, LuminaireShelf&) {
  lamp.position = table.required(table.position("center", unit_m), "center", "center = [x, y, z]");
  lamp.axis = table.required(table.direction("normal"), "normal", "normal = [x, y, z]");
  lamp.radius_m =
      table.required(table.length("radius", unit_m, above_zero), "radius", "radius = ...");
  lamp.exitance = read_strength(table, "exitance", base::pi * lamp.radius_m * lamp.radius_m);
}

constexpr std::string_view area_keys[] = {"name", "center", "edge_u", "edge_v"};

// Direction of the plane C0: projection of "up" perpendicular to the axis.
Vec3 read_c0(const Lamp& lamp, const TableReader& table) {
  const auto across = [&](const Vec3& up) { return up - glm::dot(up, lamp.axis) * lamp.axis; };
  constexpr double nearly_parallel = 1e-6;
  if (const auto up = table.direction("up")) {
    const Vec3 c0 = across(*up);
    if (glm::length(c0) < nearly_parallel) {
      table.fail("up", "is parallel to the light's axis",
                 "it gives the direction of the plane C0, across the axis");
    }
    return glm::normalize(c0);
  }
  const Vec3 c0 = across({1.0, 0.0, 0.0});
  return glm::normalize(glm::length(c0) < nearly_parallel ? across({0.0, 0.0, 1.0}) : c0);
}

void read_measured(Lamp& lamp, const TableReader& table, double unit_m, LuminaireShelf& shelf) {
  read_aim(lamp, table, unit_m);
  lamp.source = table.required(table.text("file"), "file", "file = \"LUMINAIRE.ies\"");
  const Luminaire& luminaire = shelf.take(lamp.source, table.where("file"));
  lamp.photometry = luminaire.light;
  lamp.c0 = read_c0(lamp, table);
  const auto tilt_deg = table.number("tilt_deg", {0.0, 180.0});
  if (tilt_deg && !luminaire.tilt) {
    table.fail("tilt_deg", "has no effect",
               "the file says TILT=NONE: its output does not depend on tilt", "Leave it out");
  }
  const auto flux = table.colour("flux");
  const auto color = table.colour("color");
  if (flux && color) {
    table.fail("color", "cannot be combined with \"flux\"", "a light has one of the two",
               "Give the flux as [r, g, b]");
  }
  if (flux) {
    lamp.intensity_cd = *flux / lamp.photometry->solid_angle_sr();
    return;
  }
  const double tilt = luminaire.tilt ? luminaire.tilt->factor_at(tilt_deg.value_or(0.0)) : 1.0;
  lamp.intensity_cd = Rgb(tilt * lamp.photometry->peak_cd());
  if (!color) return;
  // Only its hue: the candelas of the file remain the luminous intensity.
  if (!(base::luminance(*color) > 0.0)) table.fail("color", "is black", "it gives the light's hue");
  lamp.intensity_cd *= *color / base::luminance(*color);
}

void read_distant(Lamp& lamp, const TableReader& table, double, LuminaireShelf&) {
  // Like the Sun's direction: toward the light.
  lamp.axis = -table.required(table.direction("direction"), "direction",
                              "direction = [x, y, z], toward the light");
  lamp.illuminance_lx =
      table.required(table.colour("illuminance"), "illuminance", "illuminance = ... (lx)");
}

struct LampReader {
  KeyList keys;
  void (*read)(Lamp&, const TableReader&, double unit_m, LuminaireShelf&);
};
// In LampKind's order.
constexpr std::array<LampReader, lamp_rows.size()> readers = {{{point_keys, read_point},
                                                               {spot_keys, read_spot},
                                                               {rectangle_keys, read_rectangle},
                                                               {disk_keys, read_disk},
                                                               {ies_keys, read_measured},
                                                               {distant_keys, read_distant}}};

// Keys of all types.
std::vector<std::string_view> all_keys() {
  std::vector<std::string_view> keys(std::begin(motion_keys), std::end(motion_keys));
  for (const LampReader& reader : readers) {
    for (const std::string_view key : reader.keys) {
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
    }
  }
  return keys;
}

// Leaves room for " (2)" and the object's name in front.
constexpr std::size_t longest_own_name = 90;

bool belongs(const Mesh& mesh, std::uint32_t part_set, std::uint32_t part) {
  const auto& set = mesh.part_sets[part_set];
  return part == no_index || std::find(set.begin(), set.end(), part) != set.end();
}

template <class Named>
std::string new_name(const std::vector<Named>& known, const std::string& object,
                     const std::string& own, std::string_view otherwise) {
  const std::string first =
      fmt::format("{}.{}", object.substr(0, longest_own_name),
                  own.empty() ? otherwise : std::string_view(own).substr(0, longest_own_name));
  std::string name = first;
  for (int k = 2; std::any_of(known.begin(), known.end(),
                              [&](const Named& other) { return other.name == name; });
       ++k) {
    name = fmt::format("{} ({})", first, k);
  }
  return name;
}

Vec3 placed(const Placement& placement, const Vec3& point, const base::Location& where) {
  const Vec3 result = placement.apply(point);
  for (int c = 0; c < 3; ++c) {
    if (std::abs(result[c]) <= largest_length) continue;
    throw base::Error(
        base::Blame::Input, where,
        fmt::format("a lamp or camera of the file at ({}, {}, {}) m", result.x, result.y, result.z),
        fmt::format("coordinates are at most {} m", largest_length));
  }
  return result;
}

}  // namespace

Area read_area(const TomlNode& node, double unit_m) {
  TableReader table(node, "[[area]]", area_keys);
  const std::string name = table.read_name();
  Area area = read_sides(table, unit_m);
  area.name = name;
  return area;
}

const Luminaire& LuminaireShelf::take(const std::filesystem::path& named,
                                      const base::Location& asked_at) {
  const std::filesystem::path path = scene_folder_ / named;
  const auto key = path.lexically_normal();
  const auto found = luminaires_.find(key);
  if (found != luminaires_.end()) return found->second;
  return luminaires_.emplace(key, read_ies(path, asked_at)).first->second;
}

Lamp read_lamp(const TomlNode& node, double unit_m, const JointPoses& joints,
               LuminaireShelf& shelf) {
  static const std::vector<std::string_view> keys = all_keys();
  TableReader table(node, "[[light]]", keys);
  Lamp lamp;
  lamp.name = table.read_name();
  lamp.group = table.name("group").value_or(lamp.name);
  std::array<std::string_view, lamp_rows.size()> types;
  std::transform(lamp_rows.begin(), lamp_rows.end(), types.begin(),
                 [](const LampRow& row) { return row.type; });
  const std::string type =
      table.required(table.choice("type", types), "type",
                     "type = \"point\", \"spot\", \"rectangle\", \"disk\", \"ies\" or \"distant\"");
  const auto kind = std::find(types.begin(), types.end(), type) - types.begin();
  lamp.kind = static_cast<LampKind>(kind);
  const LampReader& reader = readers[static_cast<std::size_t>(kind)];
  std::vector<std::string_view> allowed(reader.keys.begin(), reader.keys.end());
  if (lamp.kind != LampKind::Distant) {
    allowed.insert(allowed.end(), std::begin(motion_keys), std::end(motion_keys));
  }
  table.allow_only(allowed, fmt::format("a light of type \"{}\"", type));
  lamp.motion = read_motion(table);
  reader.read(lamp, table, unit_m, shelf);
  lamp.joint = table.text("joint").value_or("");
  const Pose pose = joints.of(table);
  lamp.position = pose.point(lamp.position);
  for (Vec3* direction : {&lamp.axis, &lamp.edge_u, &lamp.edge_v, &lamp.c0}) {
    *direction = pose.rotation * *direction;
  }
  for (const Rgb& strength : {lamp.intensity_cd, lamp.exitance}) {
    if (!std::isfinite(base::max_component(strength))) {
      table.fail("flux", "gives no finite strength",
                 "the light's solid angle or area is too small");
    }
  }
  return lamp;
}

void add_file_lamps(Scene& scene, const std::string& object, const Mesh& mesh, std::uint32_t part,
                    const Placement& placement, const base::Location& where) {
  for (const MeshLamp& of_file : mesh.lamps) {
    if (!belongs(mesh, of_file.part_set, part)) continue;
    Lamp lamp = of_file.lamp;
    lamp.name = lamp.group = new_name(scene.lamps, object, lamp.name, "lamp");
    if (!lamp.is_distant()) lamp.position = placed(placement, lamp.position, where);
    lamp.axis = placement.rotated(lamp.axis);
    lamp.object = object;
    scene.lamps.push_back(std::move(lamp));
  }
}

void add_file_cameras(Scene& scene, const std::string& object, const Mesh& mesh, std::uint32_t part,
                      const Placement& placement, const base::Location& where) {
  for (const MeshCamera& of_file : mesh.cameras) {
    if (!belongs(mesh, of_file.part_set, part)) continue;
    Camera camera = of_file.camera;
    const Vec3 along = placement.rotated(camera.look_at - camera.position);
    camera.name = new_name(scene.cameras, object, camera.name, "camera");
    camera.position = placed(placement, camera.position, where);
    camera.look_at = camera.position + placement.unit_m * along;
    camera.up = placement.rotated(camera.up);
    camera.where = where;
    camera.object = object;
    scene.cameras.push_back(std::move(camera));
  }
}

}  // namespace earthshine::scenes
