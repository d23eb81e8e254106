// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "scenes/scene_parts.h"

namespace earthshine::scenes {
namespace {

constexpr std::string_view keys[] = {"name",     "diffuse", "specular", "shininess", "mirror",
                                     "transmit", "ior",     "emit",     "light",     "two_sided"};

// The largest shininess: beyond it the lobe is narrower than the Sun's disc by far, a mirror in
// fact.
constexpr double largest_shininess = 1e6;
constexpr double largest_ior = 10.0;

}  // namespace

void check_energy(const Material& material, const base::Location& where, const std::string& what) {
  const Rgb lobe = material.specular * (2.0 / (material.shininess + 2.0));
  const Rgb total = material.diffuse + lobe + material.mirror + material.transmit;
  for (int c = 0; c < 3; ++c) {
    if (total[c] <= 1.0 + 1e-9) continue;
    throw base::Error(
        base::Blame::Input, where,
        fmt::format(
            "{} reflects more than it receives in {}: diffuse {:.6g} + 2 specular/(n+2) {:.6g} + "
            "mirror {:.6g} + transmit {:.6g} = {:.6g}",
            what,
            c == 0   ? "red"
            : c == 1 ? "green"
                     : "blue",
            material.diffuse[c], lobe[c], material.mirror[c], material.transmit[c], total[c]),
        fmt::format("the sum is at most 1 (specular {:.6g}, shininess n = {:.6g})",
                    material.specular[c], material.shininess),
        "Lower one of them, or raise shininess");
  }
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
