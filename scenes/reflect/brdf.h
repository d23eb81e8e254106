// SPDX-License-Identifier: Apache-2.0
// Reflectance at a surface point, and importance sampling of directions.
#pragma once

#include "base/units.h"
#include "scenes/scene.h"

namespace earthshine::scenes {

// Directions for (u, v) uniform in [0, 1)^2, in coordinates whose third axis is the normal or the
// lobe's axis.
// Density cos / pi.
[[nodiscard]] Vec3 cosine_sample(double u, double v);
// Density (n + 1) cos^n / (2 pi); u = 0 gives the axis.
[[nodiscard]] Vec3 lobe_sample(double n, double u, double v);
// cosine_sample() about frame.normal.
[[nodiscard]] inline Vec3 cosine_direction(const base::Frame3& frame, double u, double v) {
  return frame.to_world(cosine_sample(u, v));
}

// The BRDF at a point for one view, Lambert's and Phong's (docs/theory.md):
//   f = (k_d + k_s cos^n alpha) / pi   in 1/sr, alpha between the light and the mirrored view;
// If the material has an even lobe (Material::even_lobe), the second term is divided by the larger
// cosine to the normal. The material must outlive it.
struct Brdf {
  enum class Term { Diffuse, Specular };
  // f cos_in / pdf = k weight, with k = k_d or k_s; 0 below the surface.
  struct Sample {
    Vec3 direction;
    double weight;
  };

  const Material& material;
  Rgb diffuse;      // k_d at the point
  Vec3 normal;      // unit, on the viewer's side
  Vec3 mirrored;    // unit: the view mirrored about the normal, the lobe's axis
  double cos_view;  // of the view to the normal

  // pi f for light from the unit vector `in` with cosine cos_in > 0 to the normal: the total, and
  // the specular term alone.
  [[nodiscard]] Rgb eval(const Vec3& in, double cos_in) const {
    return diffuse + eval_specular(in, cos_in);
  }
  [[nodiscard]] Rgb eval_specular(const Vec3& in, double cos_in) const;
  // Samples one term with its own density.
  [[nodiscard]] Sample sample(Term term, double u, double v) const;
  [[nodiscard]] double pdf_per_sr(Term term, const Vec3& in) const;
  // Largest directional albedo of a term, for light along the normal: k_d, 2 k_s / (n + 2).
  [[nodiscard]] Rgb albedo(Term term) const;
};

}  // namespace earthshine::scenes
