// SPDX-License-Identifier: Apache-2.0
#include "radiosity/exact/polygon/convex_polygon.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace earthshine::radiosity {

ConvexPolygon make_polygon(const std::array<Vec3, 4>& corners, const Vec3& normal) {
  ConvexPolygon polygon;
  polygon.normal = normal;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    if (corners[k] != corners[(k + 3) % 4]) polygon.add(corners[k]);
  }
  return polygon;
}

double area_m2(const ConvexPolygon& polygon) {
  Vec3 twice(0.0);
  for (int k = 2; k < polygon.count; ++k) {
    twice += glm::cross(polygon[k - 1] - polygon[0], polygon[k] - polygon[0]);
  }
  return 0.5 * glm::length(twice);
}

Ball ball_around(const ConvexPolygon& polygon) {
  Ball ball;
  for (int k = 0; k < polygon.count; ++k) ball.centre += polygon[k];
  ball.centre /= std::max(1, polygon.count);
  double square = 0.0;
  for (int k = 0; k < polygon.count; ++k) {
    const Vec3 d = polygon[k] - ball.centre;
    square = std::max(square, glm::dot(d, d));
  }
  ball.radius = std::sqrt(square);
  return ball;
}

ConvexPolygon clip(const ConvexPolygon& polygon, const Plane& plane, double margin_m) {
  std::array<double, ConvexPolygon::most_corners> height{};
  double highest = 0.0, lowest = 0.0;
  for (int k = 0; k < polygon.count; ++k) {
    double h = plane.height(polygon[k]);
    if (std::abs(h) <= margin_m) h = 0.0;
    height[static_cast<std::size_t>(k)] = h;
    highest = std::max(highest, h);
    lowest = std::min(lowest, h);
  }
  ConvexPolygon front;
  front.normal = polygon.normal;
  if (highest == 0.0) return front;
  if (lowest == 0.0) return polygon;
  for (int k = 0; k < polygon.count; ++k) {
    const int next = k + 1 == polygon.count ? 0 : k + 1;
    const double here = height[static_cast<std::size_t>(k)];
    const double there = height[static_cast<std::size_t>(next)];
    if (here >= 0.0) front.add(polygon[k]);
    if (here * there < 0.0) {
      front.add(polygon[k] + (here / (here - there)) * (polygon[next] - polygon[k]));
    }
  }
  return front;
}

double distance_m(const ConvexPolygon& polygon, const Vec3& point) {
  const double height = glm::dot(polygon.normal, point - polygon[0]);
  bool inside = true;
  double nearest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < polygon.count; ++k) {
    const Vec3 along = polygon.next(k) - polygon[k];
    const Vec3 to = point - polygon[k];
    if (glm::dot(glm::cross(polygon.normal, along), to) < 0.0) inside = false;
    const double square = glm::dot(along, along);
    const double t = square > 0.0 ? std::clamp(glm::dot(to, along) / square, 0.0, 1.0) : 0.0;
    nearest = std::min(nearest, glm::length(to - t * along));
  }
  return inside ? std::abs(height) : nearest;
}

void area_points(const ConvexPolygon& polygon, int points, std::vector<AreaPoint>& out) {
  const base::GaussRule& rule = base::gauss_rule(points);
  out.clear();
  for (int k = 1; k + 1 < polygon.count; k += 2) {
    // The bilinear quadrilateral p = a + x (b - a) + y (d - a) + x y (a - b + c - d); for a
    // triangle the last two corners coincide.
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
