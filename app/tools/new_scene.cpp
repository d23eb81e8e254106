// SPDX-License-Identifier: Apache-2.0
// earthshine new: writes an initial scene file with the parts, bounds and materials of meshes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <set>

#include "app/command.h"
#include "app/console.h"
#include "app/options.h"
#include "app/output.h"
#include "base/error.h"
#include "base/files/output_file.h"
#include "scenes/mesh/mesh_file.h"
#include "scenes/read/scene_file.h"
#include "scenes/triangle_point.h"

namespace earthshine::app {
namespace {

namespace fs = std::filesystem;

struct NewCall {
  std::string scene;
  std::vector<std::string> meshes;
};

constexpr std::size_t most_parts = 64;  // of a mesh, that become separate objects
constexpr const char* plain_material = "grey";

std::string toml_text(const std::string& text) { return Json(text).dump(); }

std::string numbers(const Vec3& v) { return fmt::format("{:.4g} {:.4g} {:.4g}", v.x, v.y, v.z); }

struct MeshPart {
  std::string name;  // "": the whole mesh
  std::size_t polygons = 0;
  scenes::Box bounds;
  std::set<std::string> materials;
  bool lacks_material = false;  // in some polygon
};

// The smallest parts that contain each polygon. The whole mesh if such parts overlap or are too
// many.
std::vector<std::uint32_t> finest_parts(const scenes::Mesh& mesh) {
  std::vector<std::size_t> sizes(mesh.part_names.size(), 0);
  for (const scenes::MeshPolygon& polygon : mesh.polygons) {
    if (mesh.part_sets.empty()) return {};
    for (const std::uint32_t part : mesh.part_sets[polygon.part_set]) ++sizes[part];
  }
  std::set<std::uint32_t> parts;
  for (const scenes::MeshPolygon& polygon : mesh.polygons) {
    const auto& own = mesh.part_sets[polygon.part_set];
    if (own.empty()) return {};
    parts.insert(*std::min_element(own.begin(), own.end(), [&](std::uint32_t a, std::uint32_t b) {
      return sizes[a] != sizes[b] ? sizes[a] < sizes[b] : a < b;
    }));
  }
  std::size_t covered = 0;
  for (const std::uint32_t part : parts) covered += sizes[part];
  if (covered != mesh.polygons.size() || parts.size() > most_parts) return {};
  return {parts.begin(), parts.end()};
}

// part: scenes::no_index for the whole mesh.
MeshPart describe_part(const scenes::Mesh& mesh, std::uint32_t part, bool y_to_z) {
  MeshPart found;
  std::vector<Vec3> corners;
  for (const scenes::MeshPolygon& polygon : mesh.polygons) {
    const auto& own =
        mesh.part_sets.empty() ? std::vector<std::uint32_t>() : mesh.part_sets[polygon.part_set];
    if (part != scenes::no_index && std::find(own.begin(), own.end(), part) == own.end()) continue;
    ++found.polygons;
    for (std::uint32_t k = 0; k < polygon.count; ++k) {
      const Vec3& v = mesh.vertices[mesh.indices[polygon.first + k]];
      corners.push_back(y_to_z ? Vec3(v.x, -v.z, v.y) : v);
    }
    if (polygon.material == scenes::no_index) {
      found.lacks_material = true;
    } else {
      found.materials.insert(mesh.material_names[polygon.material]);
    }
  }
  if (part != scenes::no_index) found.name = mesh.part_names[part];
  found.bounds = scenes::box_around(corners);
  return found;
}

class SceneText {
 public:
  explicit SceneText(const fs::path& scene) : folder_(scene.parent_path()) {
    name_ = scene.stem().string();
  }

  void add_mesh(const fs::path& path) {
    const fs::path beside = folder_.empty() ? fs::path(".") : folder_;
    const std::string named =
        path.is_absolute() ? path.string() : fs::relative(path, beside).generic_string();
    scenes::Mesh mesh = scenes::read_mesh(path, beside, base::Location{path.string()});
    // For a file with +Y up, which would lie on its side in a scene.
    const bool y_to_z = mesh.is_y_up && !mesh.is_own;
    std::vector<std::uint32_t> parts = finest_parts(mesh);
    if (parts.size() < 2) parts = {scenes::no_index};
    for (const std::uint32_t part : parts) {
      add_object(mesh, named, path.stem().string(), describe_part(mesh, part, y_to_z), y_to_z);
    }
    for (const std::string& material : worn_) {
      const std::uint32_t own = scenes::find_mesh_material(mesh, material, beside);
      if (own != scenes::no_index) defined_.emplace(material, mesh.materials[own]);
    }
  }

  void add_shapes() {
    objects_ =
        "[[object]]\nname = \"floor\"\nshape = \"quad\"\n"
        "corners = [[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0]]\nmaterial = \"grey\"\n\n"
        "[[object]]\nname = \"crate\"\nshape = \"box\"\nmin = [-0.5, -0.5, 0]\n"
        "max = [0.5, 0.5, 1]\nmaterial = \"grey\"\ntarget = true  # studies ask who sees it\n\n";
    bounds_ = {Vec3(-2.0, -2.0, 0.0), Vec3(2.0, 2.0, 1.0)};
    worn_.insert(plain_material);
  }

  [[nodiscard]] std::string text() const {
    const Vec3 size = bounds_.high - bounds_.low;
    std::string all = fmt::format(
        "# Every key: docs/scene-format.md. \"earthshine inspect\" shows the values read.\n"
        "format = 1\nname = {}\n"
        "unit = \"m\"  # m, cm, mm, ft or in: of all lengths, those of OBJ, PLY and STL files too; "
        "all objects together are {:.4g} x {:.4g} x {:.4g}\n\n",
        toml_text(name_), size.x, size.y, size.z);
    return all + sky_text() + camera_text() + objects_ + material_text() +
           "[quality]\nerror = 0.05  # wanted relative error of pictures\n";
  }

 private:
  void add_object(const scenes::Mesh& mesh, const std::string& file, const std::string& stem,
                  const MeshPart& part, bool y_to_z) {
    std::string name = part.name.empty() ? stem : part.name;
    if (names_.contains(name)) name = stem + "-" + name;
    for (int k = 2; names_.contains(name); ++k) name = fmt::format("{}-{}", stem, k);
    names_.insert(name);
    objects_ += fmt::format("[[object]]  # {} polygons, {} to {}\nname = {}\nmesh = {}\n",
                            part.polygons, numbers(part.bounds.low), numbers(part.bounds.high),
                            toml_text(name), toml_text(file));
    if (!part.name.empty()) objects_ += fmt::format("part = {}\n", toml_text(part.name));
    if (y_to_z) objects_ += "axes = \"y-up\"  # the file's y becomes z\n";
    if (mesh.metres) objects_ += "# lengths of this format are metres\n";
    if (part.lacks_material) {
      objects_ += fmt::format("material = \"{}\"  # the file gives none\n", plain_material);
      worn_.insert(plain_material);
    } else {
      objects_ += fmt::format("# materials of the file: {}\n", fmt::join(part.materials, ", "));
      worn_.insert(part.materials.begin(), part.materials.end());
    }
    objects_ += "# target = true  # studies ask who sees it\n\n";
    bounds_.add(part.bounds);
  }

  // Materials of the files become comments, as templates.
  [[nodiscard]] std::string material_text() const {
    std::string text =
        "# Shares of the light: diffuse + 2 specular / (shininess + 2) + mirror + transmit is at "
        "most 1.\n";
    for (const std::string& name : worn_) {
      const auto own = defined_.find(name);
      const auto colour = [](const Rgb& c) {
        return fmt::format("[{:.4g}, {:.4g}, {:.4g}]", c.r, c.g, c.b);
      };
      if (own == defined_.end()) {
        text += fmt::format(
            "[[material]]\nname = {}\ndiffuse = 0.5  # a guess: what it reflects, 0 to 1\n"
            "two_sided = true  # false: its back is black\n\n",
            toml_text(name));
        continue;
      }
      const scenes::Material& m = own->second;
      text += fmt::format(
          "# [[material]]  # as its file has it; a table of this name here goes before it\n"
          "# name = {}\n# diffuse = {}\n# specular = {}\n# shininess = {:.4g}\n# emit = {}\n"
          "# two_sided = {}\n\n",
          toml_text(name), colour(m.diffuse), colour(m.specular), m.shininess, colour(m.emit),
          m.two_sided);
    }
    return text;
  }

  [[nodiscard]] static std::string sky_text() {
    return "[sun]\ndirection = [0.5, -0.6, 0.7]  # toward the Sun\n"
           "illuminance = 133100  # lx on a plate that faces it\n\n"
           "# [earth]\n# direction = [0, 0, 1]  # toward its centre\n# altitude_km = 400\n\n"
           "# [[light]]\n# name = \"lamp\"\n# type = \"spot\"\n# position = [0, 0, 1]\n"
           "# aim = [0, 0, 0]\n# beam_deg = 60\n# field_deg = 120\n# intensity = 500  # cd\n\n";
  }

  // From the Sun's side, at a distance that shows the sphere around all objects.
  [[nodiscard]] std::string camera_text() const {
    constexpr double fov_deg = 40.0, room = 1.05;
    const Vec3 middle = bounds_.middle();
    const double away = room * 0.5 * bounds_.diagonal() / std::sin(0.5 * base::radians(fov_deg));
    const Vec3 from = middle + away * glm::normalize(Vec3(0.6, -0.8, 0.6));
    const auto point = [](const Vec3& v) {
      return fmt::format("[{:.5g}, {:.5g}, {:.5g}]", v.x, v.y, v.z);
    };
    return fmt::format(
        "[[camera]]\nname = \"A\"  # sees all objects\nposition = {}\nlook_at = {}\nup = [0, 0, "
        "1]\n"
        "fov_deg = {}  # vertical\nresolution = [512, 512]\n"
        "# cctv = \"sit-monochrome\"  # earthshine degrade --list has the cameras that ship\n\n",
        point(from), point(middle), fov_deg);
  }

  fs::path folder_;
  std::string name_, objects_;
  scenes::Box bounds_;
  std::set<std::string> names_, worn_;
  std::map<std::string, scenes::Material> defined_;
};

void run(const NewCall& call, const Common& common) {
  refuse_other_kind("SCENE", call.scene, {".toml"});
  const Files meshes(call.meshes.begin(), call.meshes.end());
  if (fs::exists(call.scene)) {
    throw base::Error(base::Blame::Input, call.scene, "is there already", {},
                      "Name another file, or remove it");
  }
  check_outputs({call.scene}, meshes);
  SceneText scene(call.scene);
  for (const fs::path& mesh : meshes) scene.add_mesh(mesh);
  if (meshes.empty()) scene.add_shapes();
  const std::string text = scene.text();
  // Reports errors of the meshes now.
  const LoadedScene loaded = check_scene(scenes::read_scene_text(text, call.scene));
  base::write_text(call.scene, text);
  if (common.quiet) return;
  for (const std::string& warning : loaded.scene.warnings) note("warning: " + warning);
  note(fmt::format(
      "{}: {} objects, {} triangles; look at it with: earthshine render {} -o a.exr "
      "--png a.png",
      call.scene, loaded.scene.objects.size(), loaded.scene.triangles.size(), call.scene));
}

}  // namespace

Command add_new(CLI::App& program) {
  CLI::App* parser = add_subcommand(
      program, "new",
      "A commented scene file to begin with, with the parts and materials of meshes");
  const auto call = std::make_shared<NewCall>();
  parser->add_option("SCENE", call->scene, "Scene file to write (TOML)")->required()->type_name("");
  parser->add_option("MESH", call->meshes, "OBJ, glTF, GLB, PLY or STL files; none: two shapes")
      ->type_name("");
  return {parser, [call](const Common& common) { run(*call, common); }};
}

}  // namespace earthshine::app
