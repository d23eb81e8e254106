// SPDX-License-Identifier: Apache-2.0
#include "scenes/reflect/energy.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace earthshine::scenes {
namespace {

constexpr double rounding = 1e-9;

}  // namespace

Rgb lobe_albedo(const Material& material) {
  return material.specular * (2.0 / (material.shininess + 2.0));
}

Rgb reflected_share(const Material& material) {
  return material.diffuse + lobe_albedo(material) + material.mirror + material.transmit;
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
  const Rgb lobe = lobe_albedo(material);
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

namespace {

// Mean over the azimuth of (a + b cos t) / max(a + b cos t, cos_in), by the midpoint rule.
double mean_even_weight(double a, double b, double cos_in) {
  constexpr int steps = 48;
  double sum = 0.0;
  for (int k = 0; k < steps; ++k) {
    const double cos_out = a + b * std::cos(base::pi * (k + 0.5) / steps);
    if (cos_out > 0.0) sum += cos_out / std::max(cos_in, cos_out);
  }
  return sum / steps;
}

}  // namespace

// Outgoing directions have the density (n + 1) cos^n / (2 pi) about the mirrored direction,
// incoming ones cos / pi about the normal. Midpoint rule in equal shares of probability of both. At
// azimuth t about the mirrored direction the cosine to the normal is a + b cos t; only directions
// above the surface count: t up to acos(-a / b).
double mean_lobe_reflectance(double n, bool even) {
  constexpr std::size_t steps = 48;
  const auto share = [](std::size_t k) { return (static_cast<double>(k) + 0.5) / steps; };
  double sum = 0.0;
  for (std::size_t j = 0; j < steps; ++j) {
    const double cos_off = std::pow(share(j), 1.0 / (n + 1.0));
    const double sin_off = std::sqrt(std::max(0.0, 1.0 - cos_off * cos_off));
    for (std::size_t i = 0; i < steps; ++i) {
      const double a = cos_off * std::sqrt(1.0 - share(i)), b = sin_off * std::sqrt(share(i));
      if (even) {
        sum += mean_even_weight(a, b, std::sqrt(1.0 - share(i)));
        continue;
      }
      sum += a >= b ? a : (a * std::acos(-a / b) + std::sqrt(b * b - a * a)) / base::pi;
    }
  }
  return 2.0 / (n + 1.0) * sum / (double(steps) * steps);
}

std::vector<Rgb> bihemispherical_albedos(const Scene& scene) {
  std::vector<Rgb> all;
  for (const Material& material : scene.materials) {
    Rgb reflectance = material.diffuse;
    if (base::max_component(material.specular) > 0.0) {
      reflectance +=
          material.specular * mean_lobe_reflectance(material.shininess, material.even_lobe);
    }
    all.push_back(reflectance);
  }
  return all;
}

}  // namespace earthshine::scenes
