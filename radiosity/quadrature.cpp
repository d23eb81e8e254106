// SPDX-License-Identifier: Apache-2.0
#include "radiosity/quadrature.h"

#include <array>
#include <cmath>

namespace earthshine::radiosity {
namespace {

// Roots of the Legendre polynomial by Newton's method from Chebyshev's guesses.
GaussRule make_rule(int points) {
  GaussRule rule;
  for (int k = points; k > 0; --k) {
    double x = std::cos(base::pi * (k - 0.25) / (points + 0.5));
    double slope = 0.0;
    for (int step = 0; step < 50; ++step) {
      double here = 1.0, before = 0.0;
      for (int n = 0; n < points; ++n) {
        const double next = ((2.0 * n + 1.0) * x * here - n * before) / (n + 1.0);
        before = here;
        here = next;
      }
      slope = points * (x * here - before) / (x * x - 1.0);
      const double move = here / slope;
      x -= move;
      if (std::abs(move) < 1e-15) break;
    }
    rule.node.push_back(0.5 * (1.0 + x));
    rule.weight.push_back(1.0 / ((1.0 - x * x) * slope * slope));
  }
  return rule;
}

}  // namespace

const GaussRule& gauss_rule(int points) {
  static const auto rules = [] {
    std::array<GaussRule, most_gauss_points + 1> all;
    for (int n = 1; n <= most_gauss_points; ++n) all[static_cast<std::size_t>(n)] = make_rule(n);
    return all;
  }();
  return rules[static_cast<std::size_t>(points)];
}

void area_points(const ConvexPolygon& polygon, int points, std::vector<AreaPoint>& out) {
  const GaussRule& rule = gauss_rule(points);
  out.clear();
  for (int k = 1; k + 1 < polygon.count; k += 2) {
    // The bilinear quadrilateral p = a + x (b - a) + y (d - a) + x y (a - b + c - d); a triangle is
    // one whose last two corners coincide.
    const Vec3 &a = polygon[0], &b = polygon[k], &c = polygon[k + 1];
    const Vec3& d = k + 2 < polygon.count ? polygon[k + 2] : c;
    const Vec3 ab = b - a, ad = d - a, twist = (c - d) - ab;
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
      for (std::size_t j = 0; j < rule.node.size(); ++j) {
        const double x = rule.node[i], y = rule.node[j];
        const double stretch = glm::length(glm::cross(ab + y * twist, ad + x * twist));
        out.push_back(
            {a + x * ab + y * ad + (x * y) * twist, rule.weight[i] * rule.weight[j] * stretch});
      }
    }
  }
}

void PointColumns::clear() {
  for (std::vector<double>* column : {&x_, &y_, &z_, &weight_m2_}) column->clear();
}

std::size_t PointColumns::add(const ConvexPolygon& polygon, int points) {
  const std::size_t first = count();
  area_points(polygon, points, scratch_);
  while (scratch_.size() % 4 != 0) scratch_.push_back({scratch_.back().position, 0.0});
  for (const AreaPoint& point : scratch_) {
    x_.push_back(point.position.x);
    y_.push_back(point.position.y);
    z_.push_back(point.position.z);
    weight_m2_.push_back(point.weight_m2);
  }
  return first;
}

}  // namespace earthshine::radiosity
