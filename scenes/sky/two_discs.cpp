// SPDX-License-Identifier: Apache-2.0
#include "scenes/sky/two_discs.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace earthshine::scenes {
namespace {

// 1 - cos x without cancellation for small x.
double versine(double x) {
  const double half = std::sin(0.5 * x);
  return 2.0 * half * half;
}

// Spherical triangle of both centres and an intersection of the rims, from its sides.
struct SphericalTriangle {
  double p, a, b, separation;  // p: half the sum of the sides
  SphericalTriangle(double of_a, double of_b, double apart)
      : p(0.5 * (of_a + of_b + apart)), a(of_a), b(of_b), separation(apart) {}
  [[nodiscard]] bool is_one() const { return p > a && p > b && p > separation; }
  // Angle at the centre of the disc with radius `own`.
  [[nodiscard]] double angle(double own, double other) const {
    return 2.0 * std::atan2(std::sqrt(std::sin(p - own) * std::sin(p - separation)),
                            std::sqrt(std::sin(p) * std::sin(p - other)));
  }
  [[nodiscard]] double area() const {
    const auto tan_half = [](double x) { return std::tan(0.5 * x); };
    return 4.0 * std::atan(std::sqrt(tan_half(p) * tan_half(p - a) * tan_half(p - b) *
                                     tan_half(p - separation)));
  }
};

}  // namespace

double disc_solid_angle(double radius) { return 2.0 * base::pi * versine(radius); }

double covered_half_arc(double rim, double other, double separation) {
  const SphericalTriangle triangle(rim, other, separation);
  if (triangle.is_one()) return triangle.angle(rim, other);
  return rim + separation <= other ? base::pi : 0.0;
}

double shared_solid_angle(double a, double b, double separation) {
  const SphericalTriangle triangle(a, b, separation);
  if (!triangle.is_one()) {
    return separation < std::max(a, b) ? disc_solid_angle(std::min(a, b)) : 0.0;
  }
  return 2.0 *
         (triangle.angle(a, b) * versine(a) + triangle.angle(b, a) * versine(b) - triangle.area());
}

}  // namespace earthshine::scenes
