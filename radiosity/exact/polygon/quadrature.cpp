// SPDX-License-Identifier: Apache-2.0
#include "radiosity/exact/polygon/quadrature.h"

#include <array>
#include <cmath>

namespace earthshine::radiosity {
void area_points(const ConvexPolygon& polygon, int points, std::vector<AreaPoint>& out) {
  const base::GaussRule& rule = base::gauss_rule(points);
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
