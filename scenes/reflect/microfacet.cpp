// SPDX-License-Identifier: Apache-2.0
#include "scenes/reflect/microfacet.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace earthshine::scenes {
namespace {

// Of the angle, squeezed toward the highlight: relative errors below 1e-6 for a in [0.002, 1].
constexpr int albedo_steps = 2000;

}  // namespace

double ggx_brdf(double a, double cos_light, double cos_view, double cos_half) {
  const double a2 = a * a;
  const double bulge = cos_half * cos_half * (a2 - 1.0) + 1.0;
  const auto shadowed = [&](double cosine) {
    return cosine + std::sqrt(a2 + (1.0 - a2) * cosine * cosine);
  };
  return a2 / (base::pi * bulge * bulge) / (shadowed(cos_light) * shadowed(cos_view));
}

double ggx_albedo(double a) {
  // theta = pi/2 x^3, midpoints of x.
  double sum = 0.0;
  for (int k = 0; k < albedo_steps; ++k) {
    const double x = (k + 0.5) / albedo_steps;
    const double theta = base::pi / 2.0 * x * x * x;
    const double step = base::pi / 2.0 * 3.0 * x * x / albedo_steps;
    sum += ggx_brdf(a, 1.0, std::cos(theta), std::cos(theta / 2.0)) * 2.0 * base::pi *
           std::sin(theta) * std::cos(theta) * step;
  }
  return sum;
}

PhongLobe phong_of_ggx(double a) {
  const double peak = 1.0 / (4.0 * a * a);
  return {peak, std::max(0.0, 2.0 * peak / ggx_albedo(a) - 2.0)};
}

}  // namespace earthshine::scenes
