// SPDX-License-Identifier: Apache-2.0
// Phong lobes for the microfacet highlights of other programs' materials.
#pragma once

namespace earthshine::scenes {

// The GGX highlight of glTF 2.0 (appendix B.3) for a reflectance F of the facets of 1:
//   f = D V,  D = a^2 / (pi ((n h)^2 (a^2 - 1) + 1)^2),  a = roughness^2,
//   V = 1 / ((n l + sqrt(a^2 + (1 - a^2)(n l)^2)) (n v + sqrt(a^2 + (1 - a^2)(n v)^2))), V of
// uncorrelated heights. In 1/sr; cosines above 0, a in (0, 1].
[[nodiscard]] double ggx_brdf(double a, double cos_light, double cos_view, double cos_half);

// What it reflects of light that arrives along the normal: the integral of f cos over the
// hemisphere, in (0, 1]; below 1 because light between the facets is lost, as in the source.
[[nodiscard]] double ggx_albedo(double a);

// pi f = peak cos^shininess(alpha), times F.
struct PhongLobe {
  double peak = 0.0;
  double shininess = 0.0;
};

// The lobe with the same radiance along the mirror direction of the normal, 1 / (4 a^2), and the
// same albedo there, 2 peak / (shininess + 2) = ggx_albedo(a).
[[nodiscard]] PhongLobe phong_of_ggx(double a);

}  // namespace earthshine::scenes
