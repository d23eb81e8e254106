// SPDX-License-Identifier: Apache-2.0
#include "scenes/reflect/energy.h"

#include <fmt/format.h>

namespace earthshine::scenes {

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

}  // namespace earthshine::scenes
