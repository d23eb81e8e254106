// SPDX-License-Identifier: Apache-2.0
// Phong lobes that replace the microfacet highlights of glTF materials.
#pragma once

namespace earthshine::scenes {

// The GGX highlight of glTF 2.0 (appendix B.3) for facets of reflectance F = 1:
//   f = D V,  D = a^2 / (pi ((n h)^2 (a^2 - 1) + 1)^2),  a = roughness^2,
//   V = 1 / ((n l + sqrt(a^2 + (1 - a^2)(n l)^2)) (n v + sqrt(a^2 + (1 - a^2)(n v)^2))), V for
// uncorrelated heights. In 1/sr; cosines above 0, a in (0, 1].
[[nodiscard]] double ggx_brdf(double a, double cos_light, double cos_view, double cos_half);

// pi f = diffuse + peak cos^shininess(alpha) / max(cos in, cos out), times F: an even lobe
// (Material::even_lobe).
struct PhongLobe {
  double diffuse = 0.0;
  double peak = 0.0;
  double shininess = 0.0;
  // Albedo of the highlight for light along the normal.
  [[nodiscard]] double albedo() const { return 2.0 * peak / (shininess + 2.0); }
};

// The lobe with the single-scattering albedo of GGX for uniform hemispherical light (its albedo for
// light along the normal is at most 1). For light along the normal it has GGX's radiance along the
// normal and 60 degrees off. There is no lobe where GGX is brighter off the normal than along it
// (roughness above 0.84). Continuous in a, with a clamped to 0.05^2 from below. Interpolates a
// table (tests/validation/metal_lobes.py).
[[nodiscard]] PhongLobe phong_of_ggx(double a);

}  // namespace earthshine::scenes
