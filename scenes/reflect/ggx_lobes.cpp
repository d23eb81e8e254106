// SPDX-License-Identifier: Apache-2.0
#include "scenes/reflect/ggx_lobes.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/units.h"

namespace earthshine::scenes {
namespace {

struct Row {
  double roughness, diffuse, peak, shininess;
};
// Computed by tests/validation/metal_lobes.py.
constexpr Row rows[] = {{0.05, 4.99979e-05, 40000, 80002},
                        {0.075, 0.000253071, 7901.23, 15804.5},
                        {0.1, 0.00079946, 2500, 5002},
                        {0.15, 0.00403619, 493.823, 989.649},
                        {0.2, 0.0126628, 156.237, 314.482},
                        {0.25, 0.0304413, 63.9696, 129.956},
                        {0.3, 0.0613912, 30.8028, 63.635},
                        {0.35, 0.108719, 16.551, 35.1398},
                        {0.4, 0.173357, 9.59227, 21.2078},
                        {0.45, 0.252198, 5.84443, 13.9283},
                        {0.5, 0.335861, 3.66414, 10.038},
                        {0.55, 0.411467, 2.32059, 7.60782},
                        {0.6, 0.468964, 1.46005, 5.89459},
                        {0.65, 0.497675, 0.902836, 4.38201},
                        {0.7, 0.545329, 0.511659, 4},
                        {0.75, 0.56855, 0.249655, 4},
                        {0.8, 0.561347, 0.0865485, 4},
                        {0.85, 0.531545, 0, 4},
                        {0.9, 0.477327, 0, 4},
                        {0.95, 0.42527, 0, 4},
                        {1.0, 0.376159, 0, 4}};

double between(double a, double b, double share) { return (1.0 - share) * a + share * b; }
// Interpolates along a power of the roughness, as lobes vary; linearly to 0.
double between_powers(double a, double b, double share) {
  return a > 0.0 && b > 0.0 ? std::exp(between(std::log(a), std::log(b), share))
                            : between(a, b, share);
}

}  // namespace

double ggx_brdf(double a, double cos_light, double cos_view, double cos_half) {
  const double a2 = a * a;
  const double bulge = cos_half * cos_half * (a2 - 1.0) + 1.0;
  const auto shadowed = [&](double cosine) {
    return cosine + std::sqrt(a2 + (1.0 - a2) * cosine * cosine);
  };
  return a2 / (base::pi * bulge * bulge) / (shadowed(cos_light) * shadowed(cos_view));
}

PhongLobe phong_of_ggx(double a) {
  const double roughness =
      std::clamp(std::sqrt(a), std::begin(rows)->roughness, std::rbegin(rows)->roughness);
  const Row* above = std::begin(rows) + 1;
  while (above->roughness < roughness) ++above;
  const Row& low = *(above - 1);
  const double share =
      std::log(roughness / low.roughness) / std::log(above->roughness / low.roughness);
  return {between_powers(low.diffuse, above->diffuse, share),
          between_powers(low.peak, above->peak, share),
          between_powers(low.shininess, above->shininess, share)};
}

}  // namespace earthshine::scenes
