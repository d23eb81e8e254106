// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/free_memory.h"
#include "scenes/mesh/mesh_file.h"
#include "scenes/mesh/shapes.h"
#include "scenes/read/material_choice.h"
#include "scenes/read/scene_parts.h"
#include "scenes/round/round.h"

namespace earthshine::scenes {
namespace {

constexpr std::string_view object_keys[] = {
    "name",   "mesh",     "part",       "shape",     "material",    "translate", "rotate",
    "scale",  "target",   "inward",     "corners",   "min",         "max",       "center",
    "radius", "segments", "from",       "to",        "caps",        "normal",    "orient",
    "lights", "cameras",  "smooth_deg", "round_deg", "instance_of", "velocity",  "axes",
    "joint",  "spin",     "spin_about"};
constexpr std::string_view shapes[] = {"quad", "box", "sphere", "cylinder", "disk"};
constexpr std::string_view common_keys[] = {"name",     "material", "translate", "rotate",
                                            "scale",    "target",   "inward",    "orient",
                                            "velocity", "joint",    "spin",      "spin_about"};
constexpr std::string_view orients[] = {"outward", "inward", "as-is", "two-sided"};
constexpr std::string_view axes_known[] = {"y-up", "as-is"};
constexpr Range lengths{-largest_length, largest_length};

void allow_keys(const TableReader& table, std::initializer_list<std::string_view> own,
                std::string_view of_what) {
  std::vector<std::string_view> allowed(std::begin(common_keys), std::end(common_keys));
  allowed.insert(allowed.end(), own);
  table.allow_only(allowed, of_what);
}

constexpr Range step_range_deg{0.25, 90.0};
constexpr Range creases_deg{0.0, 180.0, true};

// Number of segments, given directly or by the angle between two. faces_of: faces of a shape with
// this many segments. Checks the memory before the shape is made.
int read_segments(const TableReader& table, std::uint64_t (*faces_of)(std::uint64_t)) {
  constexpr std::uint64_t bytes_per_face = 2 * sizeof(MeshPolygon) + 8 * sizeof(std::uint32_t) +
                                           2 * sizeof(Vec3);  // arrays grow by doubling
  const auto given = table.whole("segments", fewest_segments, most_segments);
  const auto step_deg = table.number("round_deg", step_range_deg);
  if (given && step_deg) {
    table.fail("round_deg", "cannot be combined with \"segments\"", "a shape has one of the two");
  }
  const int segments =
      given ? *given
            : static_cast<int>(std::ceil(360.0 / step_deg.value_or(Rounding{}.step_deg) - 1e-6));
  base::check_room(faces_of(static_cast<std::uint64_t>(segments)) * bytes_per_face,
                   base::to_string(table.where()));
  return segments;
}

// Rounding options of a mesh.
std::optional<Rounding> read_rounding(const TableReader& table) {
  const auto crease_deg = table.number("smooth_deg", creases_deg);
  const auto step_deg = table.number("round_deg", step_range_deg);
  if (!crease_deg && !step_deg) return std::nullopt;
  Rounding rounding;
  rounding.crease_deg = crease_deg;
  rounding.step_deg = step_deg.value_or(rounding.step_deg);
  return rounding;
}

std::uint64_t faces_around(std::uint64_t segments) { return 3 * segments; }
std::uint64_t faces_of_sphere(std::uint64_t segments) { return segments * segments / 2; }

double read_radius(const TableReader& table) {
  return table.required(table.number("radius", {0.0, largest_length, true}), "radius",
                        "radius = ...");
}

Vec3 read_point(const TableReader& table, std::string_view key) {
  return table.required(table.vector(key, lengths), key, fmt::format("{} = [x, y, z]", key));
}

Mesh read_quad(const TableReader& table) {
  allow_keys(table, {"shape", "corners"}, "the shape \"quad\"");
  const auto corners =
      table.required(table.points("corners"), "corners", "corners = [[x, y, z], ...], four points");
  if (corners.size() != 4) {
    table.fail("corners", fmt::format("has {} points", corners.size()), "a quad has four");
  }
  const std::span<const Vec3, 4> four(corners.data(), 4);
  switch (check_quad(four)) {
    case QuadFault::NoArea:
      table.fail("corners", "span no area", "a quad has four corners, in order round it");
    case QuadFault::NotFlat:
      table.fail("corners", "do not lie in one plane", "they do, to 1e-6 of the quad's size",
                 "Move a corner, or make two quads or a mesh of it");
    case QuadFault::NotConvex:
      table.fail("corners", "do not go round a convex quadrilateral",
                 "they follow its outline in order");
    case QuadFault::None:
      break;
  }
  return make_quad(four);
}

Mesh read_box(const TableReader& table) {
  allow_keys(table, {"shape", "min", "max"}, "the shape \"box\"");
  const Vec3 low = read_point(table, "min");
  const Vec3 high = read_point(table, "max");
  if (!glm::all(glm::lessThan(low, high))) {
    table.fail("max", fmt::format("is [{}, {}, {}]", high.x, high.y, high.z),
               fmt::format("each number is above that of min, [{}, {}, {}]", low.x, low.y, low.z));
  }
  return make_box(low, high);
}

Mesh read_cylinder(const TableReader& table) {
  allow_keys(table, {"shape", "from", "to", "radius", "segments", "caps", "round_deg"},
             "the shape \"cylinder\"");
  const Vec3 from = read_point(table, "from");
  const Vec3 to = read_point(table, "to");
  if (!(glm::length(to - from) > 0.0)) table.fail("to", "is the same point as from");
  return make_cylinder(from, to, read_radius(table), read_segments(table, faces_around),
                       table.flag("caps").value_or(true));
}

Mesh read_shape(const TableReader& table, const std::string& shape) {
  if (shape == "quad") return read_quad(table);
  if (shape == "box") return read_box(table);
  if (shape == "cylinder") return read_cylinder(table);
  if (shape == "sphere") {
    allow_keys(table, {"shape", "center", "radius", "segments", "round_deg"},
               "the shape \"sphere\"");
    return make_sphere(read_point(table, "center"), read_radius(table),
                       read_segments(table, faces_of_sphere));
  }
  allow_keys(table, {"shape", "center", "normal", "radius", "segments", "round_deg"},
             "the shape \"disk\"");
  const Vec3 normal = table.required(table.direction("normal"), "normal", "normal = [x, y, z]");
  return make_disk(read_point(table, "center"), normal, read_radius(table),
                   read_segments(table, faces_around));
}

Orient read_orient(const TableReader& table, const Placement& placement) {
  const auto orient = table.choice("orient", orients);
  // A manually inverted object is not reoriented.
  if (!orient) return placement.inward ? Orient::AsIs : Orient::Mended;
  if (*orient == "as-is") return Orient::AsIs;
  if (*orient == "two-sided") return Orient::TwoSided;
  if (placement.inward) {
    table.fail("orient", fmt::format("is \"{}\" beside inward = true", *orient),
               "one of the two says which way the faces are turned", "Leave inward out");
  }
  return *orient == "outward" ? Orient::Outward : Orient::Inward;
}

// Transform from a mesh file's coordinates to the scene's: its unit, and y up to z up if the object
// requests it or this program wrote the file, whose scene had z up. Warns about a file whose format
// has another up axis than scenes, if the object does not set `axes`.
void take_axes(const TableReader& table, Mesh& mesh, Placement& placement) {
  const auto asked = table.choice("axes", axes_known);
  if (mesh.metres) placement.from_file *= *mesh.metres / placement.unit_m;
  if (asked ? *asked == "y-up" : mesh.is_own) {
    placement.from_file *= glm::dmat3(1, 0, 0, 0, 0, 1, 0, -1, 0);  // (x, y, z) to (x, -z, y)
  }
  if (asked || mesh.is_own || !mesh.is_y_up) return;
  mesh.warnings.push_back(
      fmt::format("{}: +Y is up in this format, +Z in scenes; it is read as it stands. Say axes = "
                  "\"y-up\" at the object to stand it upright, or axes = \"as-is\"",
                  mesh.path.string()));
  mesh.is_y_up = false;  // report once
}

void warn_of_unsupported(Mesh& mesh) {
  std::string list;
  for (const auto& [what, count] : mesh.unsupported) {
    list += fmt::format("{}{} ({})", list.empty() ? "" : ", ", what, count);
  }
  if (!list.empty()) {
    mesh.warnings.push_back(fmt::format("{}: not used, and the picture would change by it: {}",
                                        mesh.path.string(), list));
  }
  mesh.unsupported.clear();
}

// Adds lamps and cameras of the mesh file to the scene, and lists contents that are not used.
void take_extras(Scene& scene, const TableReader& table, Mesh& mesh, std::uint32_t part,
                 const Placement& placement) {
  const std::string object = scene.objects.back().name;
  const bool lights = table.flag("lights").value_or(false);
  const bool cameras = table.flag("cameras").value_or(false);
  if (lights) {
    add_file_lamps(scene, object, mesh, part, placement, table.where("lights"));
  }
  if (cameras) {
    add_file_cameras(scene, object, mesh, part, placement, table.where("cameras"));
  }
  const auto miss = [&](bool wanted, const char* what) {
    const auto found = mesh.unused.find(what);
    if (wanted && found != mesh.unused.end()) mesh.unsupported[what] = found->second;
  };
  miss(lights, unknown_lamps_of_file);
  miss(cameras, flat_cameras_of_file);
  warn_of_unsupported(mesh);
  std::string& unused = scene.objects.back().unused;
  bool normals = false;
  for (const auto& [what, count] : mesh.unused) {
    if ((lights && what == lamps_of_file) || (cameras && what == cameras_of_file)) continue;
    unused += fmt::format("{}{} {}", unused.empty() ? "" : ", ", count, what);
    normals |= std::find(std::begin(normals_of_file), std::end(normals_of_file), what) !=
               std::end(normals_of_file);
  }
  if (normals) unused += "; round_deg rounds the surface by the normals";
}

}  // namespace

Placement read_placement(const TableReader& table, double unit_m, const JointPoses& joints) {
  Placement placement;
  placement.unit_m = unit_m;
  if (table.has("scale")) {
    placement.scale = *table.scale("scale", {-1e6, 1e6});
    if (placement.scale.x * placement.scale.y * placement.scale.z == 0.0) {
      table.fail("scale", "is 0",
                 "allowed are numbers from -1e6 to 1e6 other than 0; a negative one mirrors");
    }
  }
  if (const auto degrees = table.vector("rotate", {-1e6, 1e6})) {
    placement.rotation = rotation_xyz(*degrees);
  }
  placement.translate = table.vector("translate", lengths).value_or(Vec3(0.0));
  placement.inward = table.flag("inward").value_or(false);
  placement.move(joints.of(table));
  return placement;
}

ShelvedMesh& MeshShelf::take(const std::filesystem::path& named, const base::Location& asked_at,
                             VertexNormals normals) {
  const std::filesystem::path path = scene_folder_ / named;
  std::unique_ptr<ShelvedMesh>& shelved = meshes_[{path.lexically_normal(), normals}];
  if (!shelved) {
    auto fresh = std::make_unique<ShelvedMesh>();
    fresh->mesh = read_mesh(path, scene_folder_, asked_at, normals);
    shelved = std::move(fresh);
  }
  return *shelved;
}

Motion read_motion(const TableReader& table) {
  return {table.vector("velocity", {-1e4, 1e4}).value_or(Vec3(0.0)),
          table.vector("spin", {-1e6, 1e6}).value_or(Vec3(0.0))};
}

std::optional<Vec3> read_spin_about(const TableReader& table, double unit_m) {
  if (table.has("spin_about") && !table.has("spin")) {
    table.fail("spin_about", "is given without \"spin\"", "it is the point about which spin turns");
  }
  return table.position("spin_about", unit_m);
}

Placement read_object(Scene& scene, const TomlNode& node, double unit_m, const JointPoses& joints,
                      MeshShelf& shelf, FileFronts& fronts) {
  TableReader table(node, "[[object]]", object_keys);
  Object object;
  object.name = table.read_name();
  object.target = table.flag("target").value_or(false);
  object.motion = read_motion(table);
  object.spin_about = read_spin_about(table, unit_m);
  const auto named = table.text("mesh");
  const auto shape = table.choice("shape", shapes);
  if (named && shape)
    table.fail("shape", "cannot be combined with \"mesh\"", "an object is one of the two");
  if (!named && !shape) {
    table.missing("mesh",
                  "mesh = \"FILE\", shape = \"quad\", \"box\", \"sphere\", ... or instance_of = "
                  "\"OBJECT\"");
  }
  Placement placement = read_placement(table, unit_m, joints);
  object.joint = table.text("joint").value_or("");
  object.orient = read_orient(table, placement);
  ShelvedMesh made;
  ShelvedMesh* shelved = &made;
  std::uint32_t part = no_index;
  std::optional<Rounding> rounding;
  if (shape) {
    made.mesh = read_shape(table, *shape);
    object.source = *shape;
  } else {
    allow_keys(table, {"mesh", "part", "lights", "cameras", "smooth_deg", "round_deg", "axes"},
               "an object with a mesh");
    rounding = read_rounding(table);
    shelved = &shelf.take(*named, table.where("mesh"),
                          rounding ? VertexNormals::Shape : VertexNormals::Sides);
    take_axes(table, shelved->mesh, placement);
    object.source = *named;
    if (const auto part_name = table.text("part")) {
      part = find_part(shelved->mesh, *part_name, table.where("part"));
      object.source += "#" + *part_name;
    }
  }
  MaterialChoice choice(scene, table, *shelved, shelf.own_material_count());
  Mesh round;
  if (rounding) {
    if (shelved->mesh.normals.empty() && !rounding->crease_deg) {
      table.fail("round_deg", "has nothing to go by: the mesh has no vertex normals", {},
                 "Add smooth_deg = 30, the angle from which an edge is a crease");
    }
    round = rounded(shelved->mesh, *rounding, table.where("round_deg"));
  }
  place_mesh(
      scene, std::move(object), rounding ? round : shelved->mesh, part, placement, table.where(),
      [&](const MeshPolygon& polygon) { return choice.material_of(polygon); }, fronts);
  take_extras(scene, table, shelved->mesh, part, placement);
  // Reported once, by the first object that uses the file.
  auto& warnings = shelved->mesh.warnings;
  scene.warnings.insert(scene.warnings.end(), warnings.begin(), warnings.end());
  warnings.clear();
  auto& files = shelved->mesh.files;
  scene.files.insert(scene.files.end(), files.begin(), files.end());
  files.clear();
  return placement;
}

}  // namespace earthshine::scenes
