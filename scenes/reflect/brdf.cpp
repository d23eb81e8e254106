// SPDX-License-Identifier: Apache-2.0
#include "scenes/reflect/brdf.h"

#include <algorithm>
#include <cmath>

#include "scenes/reflect/energy.h"

namespace earthshine::scenes {

using base::pi;

Vec3 cosine_sample(double u, double v) {
  const double radius = std::sqrt(u), phi = 2.0 * pi * v;
  return {radius * std::cos(phi), radius * std::sin(phi), std::sqrt(std::max(0.0, 1.0 - u))};
}

Vec3 lobe_sample(double n, double u, double v) {
  const double cosine = std::pow(1.0 - u, 1.0 / (n + 1.0));
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine)), phi = 2.0 * pi * v;
  return {sine * std::cos(phi), sine * std::sin(phi), cosine};
}

Rgb Brdf::eval_specular(const Vec3& in, double cos_in) const {
  const double cos_alpha = glm::dot(in, mirrored);
  if (cos_alpha <= 0.0 || !base::is_lit(material.specular)) return Rgb(0.0);
  const double lobe = std::pow(cos_alpha, material.shininess);
  return material.specular * (material.even_lobe ? lobe / std::max(cos_in, cos_view) : lobe);
}

Brdf::Sample Brdf::sample(Term term, double u, double v) const {
  if (term == Term::Diffuse) return {cosine_direction(base::frame_around(normal), u, v), 1.0};
  const double n = material.shininess;
  const Vec3 direction = base::frame_around(mirrored).to_world(lobe_sample(n, u, v));
  const double cosine = std::max(0.0, glm::dot(direction, normal));
  const double evened = material.even_lobe ? cosine / std::max(cos_view, cosine) : cosine;
  return {direction, 2.0 * evened / (n + 1.0)};
}

double Brdf::pdf_per_sr(Term term, const Vec3& in) const {
  if (term == Term::Diffuse) return std::max(0.0, glm::dot(in, normal)) / pi;
  const double n = material.shininess;
  return (n + 1.0) / (2.0 * pi) * std::pow(std::max(0.0, glm::dot(in, mirrored)), n);
}

Rgb Brdf::albedo(Term term) const {
  return term == Term::Diffuse ? diffuse : lobe_albedo(material);
}

}  // namespace earthshine::scenes
