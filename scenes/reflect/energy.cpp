// SPDX-License-Identifier: Apache-2.0
#include "scenes/reflect/energy.h"

#include <fmt/format.h>

namespace earthshine::scenes {
namespace {

constexpr double rounding = 1e-9;

Rgb lobe_of(const Material& material) {
  return material.specular * (2.0 / (material.shininess + 2.0));
}

}  // namespace

Rgb reflected_share(const Material& material) {
  return material.diffuse + lobe_of(material) + material.mirror + material.transmit;
}

double conserve_energy(Material& material) {
  const double sum = base::max_component(reflected_share(material));
  if (sum <= 1.0 + rounding) return 1.0;
  for (Rgb* part : {&material.diffuse, &material.specular, &material.mirror, &material.transmit}) {
    *part /= sum;
  }
  return sum;
}

void check_energy(const Material& material, const base::Location& where, const std::string& what) {
  const Rgb lobe = lobe_of(material);
  const Rgb total = reflected_share(material);
  for (int c = 0; c < 3; ++c) {
    if (total[c] <= 1.0 + rounding) continue;
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

}  // namespace earthshine::scenes
