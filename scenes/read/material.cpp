// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "scenes/read/scene_parts.h"
#include "scenes/reflect/energy.h"

namespace earthshine::scenes {
namespace {

constexpr std::string_view keys[] = {"name",     "diffuse", "specular", "shininess", "mirror",
                                     "transmit", "ior",     "emit",     "light",     "two_sided"};

// The largest shininess: beyond it the lobe is narrower than the Sun's disc by far, a mirror in
// fact.
constexpr double largest_shininess = 1e6;
constexpr double largest_ior = 10.0;

}  // namespace

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
