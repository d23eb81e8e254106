// SPDX-License-Identifier: Apache-2.0
#include "scenes/read/material_choice.h"

#include <fmt/format.h>

#include "scenes/mesh/mesh_file.h"
#include "scenes/reflect/energy.h"
#include "scenes/text/message_text.h"

namespace earthshine::scenes {
namespace {

std::vector<std::string> names_of(const std::vector<Material>& materials, std::size_t count) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < count; ++i) names.push_back(materials[i].name);
  return names;
}

bool same_values(const Material& a, const Material& b) {
  return a.diffuse == b.diffuse && a.specular == b.specular && a.shininess == b.shininess &&
         a.mirror == b.mirror && a.transmit == b.transmit && a.ior == b.ior && a.emit == b.emit &&
         a.light_group == b.light_group && a.two_sided == b.two_sided &&
         a.even_lobe == b.even_lobe && a.maps == b.maps;
}

constexpr std::string_view keys[] = {"name",     "diffuse", "specular", "shininess", "mirror",
                                     "transmit", "ior",     "emit",     "light",     "two_sided"};

// Largest shininess: beyond it the lobe is much narrower than the Sun's disc, in effect a mirror.
constexpr double largest_shininess = 1e6;
constexpr double largest_ior = 10.0;

}  // namespace

MaterialChoice::MaterialChoice(Scene& scene, const TableReader& object, ShelvedMesh& shelved,
                               std::size_t own_material_count)
    : scene_(scene),
      object_(object),
      shelved_(shelved),
      own_material_count_(own_material_count),
      chosen_(shelved.mesh.material_names.size(), no_index) {
  const auto name = object.text("material");
  if (!name) return;
  override_ = own_material(*name);
  if (override_ != no_index) return;
  const auto names = names_of(scene.materials, own_material_count);
  object.fail("material", fmt::format("is {}, which is not defined", in_quotes(*name)),
              names.empty() ? "the scene has no [[material]]" : "the scene has: " + listed(names),
              did_you_mean(*name, names));
}

std::uint32_t MaterialChoice::material_of(const MeshPolygon& polygon) {
  if (override_ != no_index) return override_;
  const Mesh& mesh = shelved_.mesh;
  if (polygon.material == no_index) {
    if (mesh.path.empty())
      object_.missing("material", "material = \"NAME\", one of the [[material]]");
    const base::Location place{mesh.path.string(), static_cast<int>(polygon.line), 0};
    throw base::Error(base::Blame::Input, object_.where(),
                      fmt::format("{} has no \"material\", and neither has a face at {}",
                                  object_.label(), base::to_string(place)),
                      {}, "Add material = \"NAME\" to the object, or name one in the mesh");
  }
  std::uint32_t& number = chosen_[polygon.material];
  if (number == no_index) {
    number = find(mesh.material_names[polygon.material],
                  {mesh.path.string(), static_cast<int>(polygon.line), 0});
  }
  return number;
}

std::uint32_t MaterialChoice::own_material(const std::string& name) const {
  for (std::size_t i = 0; i < own_material_count_; ++i) {
    if (scene_.materials[i].name == name) return static_cast<std::uint32_t>(i);
  }
  return no_index;
}

std::uint32_t MaterialChoice::find(const std::string& name, const base::Location& place) {
  const auto& variants = shelved_.mesh.variant_of;
  const auto variant = variants.find(name);
  const std::uint32_t own = own_material(variant == variants.end() ? name : variant->second);
  if (own != no_index) return own;
  const std::uint32_t of_mesh = find_mesh_material(shelved_.mesh, name, scene_.path.parent_path());
  if (of_mesh != no_index) return add_to_scene(of_mesh);
  auto names = names_of(scene_.materials, own_material_count_);
  const auto more = names_of(shelved_.mesh.materials, shelved_.mesh.materials.size());
  names.insert(names.end(), more.begin(), more.end());
  throw base::Error(
      base::Blame::Input, place,
      fmt::format("the material {} of {} is not defined", in_quotes(name), object_.label()),
      names.empty() ? "neither the scene nor the mesh defines any"
                    : "the scene and the mesh define: " + listed(names),
      fmt::format("Add [[material]] with name = {} to the scene, or material = ... to the object",
                  in_quotes(name)));
}

std::uint32_t MaterialChoice::add_to_scene(std::uint32_t mesh_material) {
  shelved_.scene_material.resize(shelved_.mesh.materials.size(), no_index);
  std::uint32_t& number = shelved_.scene_material[mesh_material];
  if (number != no_index) return number;
  Material material = shelved_.mesh.materials[mesh_material];
  if (mesh_material < shelved_.mesh.unsupported_of_material.size()) {
    for (const std::string& what : shelved_.mesh.unsupported_of_material[mesh_material]) {
      ++shelved_.mesh.unsupported[what];
    }
  }
  // Material files do not respect the energy bound; a picture with extra energy is useless.
  if (const double sum = conserve_energy(material); sum > 1.0) {
    scene_.warnings.push_back(fmt::format(
        "{}: the material {} would send on {:.4g} times the light that arrives; all its shares are "
        "divided by that",
        base::to_string(shelved_.mesh.material_places[mesh_material]), in_quotes(material.name),
        sum));
  }
  // Meshes may share a library, or use one name for different materials; names in the scene stay
  // unique.
  for (std::size_t i = own_material_count_; i < scene_.materials.size(); ++i) {
    if (scene_.materials[i].name != material.name) continue;
    if (same_values(scene_.materials[i], material)) {
      number = static_cast<std::uint32_t>(i);
      return number;
    }
    material.name += fmt::format(" ({})", shelved_.mesh.path.string());
    break;
  }
  number = static_cast<std::uint32_t>(scene_.materials.size());
  scene_.materials.push_back(std::move(material));
  return number;
}

Material read_material(const TomlNode& node) {
  TableReader table(node, "[[material]]", keys);
  Material material;
  material.name = table.read_name();
  material.diffuse = table.colour("diffuse", share).value_or(material.diffuse);
  // A reflectance factor, not an albedo: it may exceed 1 in a narrow lobe; the energy bound limits
  // it.
  material.specular = table.colour("specular").value_or(material.specular);
  material.shininess =
      table.number("shininess", {0.0, largest_shininess}).value_or(material.shininess);
  material.mirror = table.colour("mirror", share).value_or(material.mirror);
  material.transmit = table.colour("transmit", share).value_or(material.transmit);
  material.ior = table.number("ior", {1.0, largest_ior}).value_or(material.ior);
  material.emit = table.colour("emit").value_or(material.emit);
  material.light_group = table.name("light").value_or(material.name);
  material.two_sided = table.flag("two_sided").value_or(material.two_sided);
  check_energy(material, table.where(), table.label());
  return material;
}

}  // namespace earthshine::scenes
