// SPDX-License-Identifier: Apache-2.0
// Where light goes on from a mirror or glass.
#pragma once

#include <algorithm>
#include <cmath>

#include "scenes/ray_query.h"
#include "scenes/scene.h"

namespace earthshine::scenes {

// Whether any material is a mirror or glass.
[[nodiscard]] bool any_passes_light_on(const Scene& scene);

// The way of a ray that arrives along the unit vector `direction` at a surface of unit normal
// `normal` (the front's): reflected, or refracted by Snell's law, whichever share of the material
// is larger; total reflection where Snell's law has no solution. Sheets of glass are thin and do
// not bend light. One way only: following both by chance would make integer hit counts noisy, and
// materials that are half mirror, half clear glass do not occur.
[[nodiscard]] Vec3 specular_direction(const Material& material, const Vec3& normal,
                                      const Vec3& direction);

// Refracted direction, or the reflected one on total reflection (total is then true).
struct Refraction {
  Vec3 direction;
  bool total = false;
};
[[nodiscard]] Refraction refract(const Material& material, const Vec3& normal,
                                 const Vec3& direction);

// The ray that goes on along specular_direction() from a hit on a mirror or glass: its origin lies
// offset_m off the surface on the side it goes to, and is drawn a hundred-thousandth of the way to
// the triangle's middle, off its edges, where rounding could put it behind a neighbour and let
// light leak from a closed room. aimed: where it goes straight on, it is straight_through().
struct SpecularStep {
  Vec3 origin, direction;
};
[[nodiscard]] SpecularStep specular_step(const Scene& scene, const Hit& hit, const Vec3& direction,
                                         double offset_m, bool aimed = false);

// The lobe's shape, times k_s: cos^n alpha, over the larger cosine to the normal where the material
// has an even lobe. cos_in, cos_out: of the two directions, above 0.
[[nodiscard]] inline double lobe_at(const Material& material, double cos_alpha, double cos_in,
                                    double cos_out) {
  const double lobe = std::pow(cos_alpha, material.shininess);
  return material.even_lobe ? lobe / std::max(cos_in, cos_out) : lobe;
}
// The lobe times the cosine of the direction drawn by the density (n + 1) cos^n alpha / (2 pi), over
// that density and pi: what a ray along it weighs.
[[nodiscard]] inline double lobe_weight(const Material& material, double cos_in, double cos_out) {
  const double cosine = material.even_lobe ? cos_out / std::max(cos_in, cos_out) : cos_out;
  return 2.0 * cosine / (material.shininess + 1.0);
}

}  // namespace earthshine::scenes
