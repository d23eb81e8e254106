// SPDX-License-Identifier: Apache-2.0
#include "scenes/light/solid_angle.h"

#include <algorithm>
#include <cmath>

namespace earthshine::scenes {
namespace {

using base::pi;

// Normalised component of b perpendicular to the unit vector a.
Vec3 across(const Vec3& a, const Vec3& b) {
  const Vec3 part = b - glm::dot(a, b) * a;
  const double length2 = glm::dot(part, part);
  return length2 > 0.0 ? part / std::sqrt(length2) : Vec3(0.0);
}

double angle_between(const Vec3& a, const Vec3& b) {
  return std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0));
}

}  // namespace

SolidAngleSample sample_rectangle(const Vec3& point, const Vec3& corner, const Vec3& edge_u,
                                  const Vec3& edge_v, double u, double v) {
  // Names as in the paper; coordinates along the edges, z toward the point.
  const double width = glm::length(edge_u), height = glm::length(edge_v);
  const Vec3 x = edge_u / width, y = edge_v / height, d = corner - point;
  Vec3 z = glm::cross(x, y);
  double z0 = glm::dot(d, z);
  if (z0 > 0.0) {
    z = -z;
    z0 = -z0;
  }
  const double x0 = glm::dot(d, x), y0 = glm::dot(d, y), x1 = x0 + width, y1 = y0 + height;
  // z components of the unit normals of the planes through the point and the four edges.
  const double n0 = -y0 / std::hypot(z0, y0), n1 = x1 / std::hypot(z0, x1);
  const double n2 = y1 / std::hypot(z0, y1), n3 = -x0 / std::hypot(z0, x0);
  const double g0 = std::acos(-n0 * n1), g1 = std::acos(-n1 * n2), g2 = std::acos(-n2 * n3),
               g3 = std::acos(-n3 * n0);
  const double k = 2.0 * pi - g2 - g3;
  const double solid_angle = g0 + g1 - k;
  if (!(solid_angle > 0.0)) return {};

  const double au = u * solid_angle + k;
  const double fu = (std::cos(au) * n0 - n2) / std::sin(au);
  const double cu = std::clamp(std::copysign(1.0, fu) / std::sqrt(fu * fu + n0 * n0), -1.0, 1.0);
  const double xu = std::clamp(-cu * z0 / std::sqrt(std::max(1.0 - cu * cu, 1e-300)), x0, x1);
  const double d2 = xu * xu + z0 * z0;
  const double h0 = y0 / std::sqrt(d2 + y0 * y0), h1 = y1 / std::sqrt(d2 + y1 * y1);
  const double hv = h0 + v * (h1 - h0);
  const double yv = hv * hv < 1.0 ? std::clamp(hv * std::sqrt(d2 / (1.0 - hv * hv)), y0, y1) : y1;
  return {glm::normalize(xu * x + yv * y + z0 * z), solid_angle};
}

SolidAngleSample sample_triangle(const Vec3& point, const Vec3& corner, const Vec3& edge1,
                                 const Vec3& edge2, double u, double v) {
  const Vec3 a = glm::normalize(corner - point);
  const Vec3 b = glm::normalize(corner + edge1 - point);
  const Vec3 c = glm::normalize(corner + edge2 - point);
  const Vec3 ab = glm::normalize(glm::cross(a, b)), bc = glm::normalize(glm::cross(b, c)),
             ca = glm::normalize(glm::cross(c, a));
  const double alpha = angle_between(ab, -ca), beta = angle_between(bc, -ab),
               gamma = angle_between(ca, -bc);
  const double solid_angle = alpha + beta + gamma - pi;
  if (!(solid_angle > 0.0)) return {};
  const double sin_alpha = std::sin(alpha), cos_alpha = std::cos(alpha);
  const double s = std::sin(u * solid_angle - alpha), t = std::cos(u * solid_angle - alpha);
  const double p = t - cos_alpha, q = s + sin_alpha * glm::dot(a, b);
  const double below = (q * s + p * t) * sin_alpha;
  const double cosine =
      below != 0.0 ? std::clamp(((q * t - p * s) * cos_alpha - q) / below, -1.0, 1.0) : 1.0;
  const Vec3 on_ac = cosine * a + std::sqrt(1.0 - cosine * cosine) * across(a, c);
  const double z = 1.0 - v * (1.0 - glm::dot(on_ac, b));
  const Vec3 direction = z * b + std::sqrt(std::max(0.0, 1.0 - z * z)) * across(b, on_ac);
  return {glm::normalize(direction), solid_angle};
}

}  // namespace earthshine::scenes
