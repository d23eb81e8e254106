// SPDX-License-Identifier: Apache-2.0
#include "radiosity/exact/polygon/polygon_factor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "radiosity/direct/lambert.h"

namespace earthshine::radiosity {
namespace {

struct Edges {
  std::array<Segment, ConvexPolygon::most_corners> edge;
  int count = 0;
};

Edges edges_of(const ConvexPolygon& polygon) {
  Edges edges;
  for (int k = 0; k < polygon.count; ++k) {
    const Vec3 along = polygon.next(k) - polygon[k];
    const double length = glm::length(along);
    if (length > 0.0) {
      edges.edge[static_cast<std::size_t>(edges.count++)] = {polygon[k], along / length, length};
    }
  }
  return edges;
}

double point_share(const ConvexPolygon& polygon, const Vec3& point, const Vec3& normal) {
  LambertSum sum(normal);
  for (int k = 0; k < polygon.count; ++k) sum.add(polygon[k] - point, polygon.next(k) - point);
  return sum.share();
}

// Sine below which edges count as parallel: ln r changes by about as much.
constexpr double parallel_sine = 1e-9;
// Sine below which the closed form for intersecting lines loses too many digits: 1 / sine^2.
constexpr double meeting_sine = 0.02;
// Lines whose distance is below this share of the edges' extent count as intersecting: the error is
// c^2 times a logarithm.
constexpr double meeting_share = 1e-8;

// Second antiderivative in u of ln sqrt(u^2 + c^2).
double second_antiderivative(double u, double c) {
  const double square = u * u + c * c;
  if (square == 0.0) return 0.0;
  const double bend = c > 0.0 ? c * u * std::atan(u / c) : 0.0;
  return 0.25 * (u * u - c * c) * std::log(square) + bend - 0.75 * u * u;
}

// Integral of ln sqrt(u^2 + c^2) over u from a to b.
double log_integral(double a, double b, double c) {
  const auto from_zero = [c](double u) {
    const double square = u * u + c * c;
    if (square == 0.0) return 0.0;
    return 0.5 * u * std::log(square) - u + (c > 0.0 ? c * std::atan(u / c) : 0.0);
  };
  return from_zero(b) - from_zero(a);
}

double parallel_integral(const Segment& e, const Segment& f, double cosine) {
  const Vec3 between = f.start - e.start;
  const double along = glm::dot(between, e.direction);
  const double c = glm::length(between - along * e.direction);
  // f covers [f0, f1] of e's own line; u = position on f - position on e.
  const double f0 = cosine > 0.0 ? along : along - f.length;
  const double f1 = f0 + f.length;
  return second_antiderivative(f1, c) - second_antiderivative(f1 - e.length, c) -
         second_antiderivative(f0, c) + second_antiderivative(f0 - e.length, c);
}

// Integral over e of ln |p - q| for a point q.
double inner_integral(const Segment& e, const Vec3& q) {
  const Vec3 to = q - e.start;
  const double along = glm::dot(to, e.direction);
  const double c = glm::length(to - along * e.direction);
  return log_integral(-along, e.length - along, c);
}

// s and t are measured from the intersection: r^2 = s^2 + t^2 - 2 s t cosine.
double meeting_integral(double s0, double s1, double t0, double t1, double cosine, double sine) {
  // At fixed s the point has the coordinates s * cosine along f's line and s * sine off it.
  const auto side = [=](double fixed, double a, double b) {
    return log_integral(a - fixed * cosine, b - fixed * cosine, std::abs(fixed) * sine);
  };
  const double border =
      s1 * side(s1, t0, t1) - s0 * side(s0, t0, t1) + t1 * side(t1, s0, s1) - t0 * side(t0, s0, s1);
  return 0.5 * (border - (s1 - s0) * (t1 - t0));
}

// Singularities of the inner integral as a function of the position t on f: at the ends of e, |q(t)
// - end| = 0, and at the closest approach of the two lines, where the distance to e's line is 0.
// Edges that nearly touch along their whole length have no others.
struct Singularity {
  double t, off;  // singularities at t + i off and t - i off
};
using Singularities = std::array<Singularity, 3>;

Singularities singularities(const Segment& e, const Segment& f, double cosine, const Vec3& cross,
                            double sine) {
  const auto beside = [&f](const Vec3& end) {
    const Vec3 to = end - f.start;
    const double along = glm::dot(to, f.direction);
    return Singularity{along, glm::length(to - along * f.direction)};
  };
  const Vec3 between = f.start - e.start;
  const double a = glm::dot(between, e.direction), b = glm::dot(between, f.direction);
  const double gap = std::abs(glm::dot(between, cross)) / sine;
  return {beside(e.start), beside(e.start + e.length * e.direction),
          Singularity{(a * cosine - b) / (sine * sine), gap / sine}};
}

double skew_piece(const Segment& e, const Segment& f, const Singularities& poles, double t0,
                  double t1, int depth) {
  const double half = 0.5 * (t1 - t0), middle = 0.5 * (t0 + t1);
  // The error of an n-point Gauss rule is about growth^(-2n), with growth from the largest ellipse
  // about the interval that is free of singularities (its semi-major axis is half the sum of a
  // singularity's distances from the foci).
  double axis = std::numeric_limits<double>::infinity();
  for (const Singularity& pole : poles) {
    const double x = (pole.t - middle) / half, y = pole.off / half;
    axis = std::min(axis, 0.5 * (std::hypot(x - 1.0, y) + std::hypot(x + 1.0, y)));
  }
  const double growth = axis + std::sqrt(std::max(0.0, axis * axis - 1.0));
  if (growth < 2.0 && depth > 0) {
    return skew_piece(e, f, poles, t0, middle, depth - 1) +
           skew_piece(e, f, poles, middle, t1, depth - 1);
  }
  const int points = std::clamp(static_cast<int>(10.0 / std::log(growth)) + 1, 3, 16);
  const base::GaussRule& rule = base::gauss_rule(points);
  double sum = 0.0;
  for (std::size_t k = 0; k < rule.node.size(); ++k) {
    const double t = t0 + rule.node[k] * (t1 - t0);
    sum += rule.weight[k] * inner_integral(e, f.start + t * f.direction);
  }
  return sum * (t1 - t0);
}

double skew_integral(const Segment& e, const Segment& f, double cosine, const Vec3& cross,
                     double sine) {
  constexpr int deepest = 30;
  return skew_piece(e, f, singularities(e, f, cosine, cross, sine), 0.0, f.length, deepest);
}

}  // namespace

double contour_exchange_m2(const ConvexPolygon& first, const ConvexPolygon& second) {
  const Edges one = edges_of(first), two = edges_of(second);
  double sum = 0.0;
  for (int i = 0; i < one.count; ++i) {
    const Segment& e = one.edge[static_cast<std::size_t>(i)];
    for (int j = 0; j < two.count; ++j) {
      const Segment& f = two.edge[static_cast<std::size_t>(j)];
      const double cosine = glm::dot(e.direction, f.direction);
      if (std::abs(cosine) > 1e-15) sum += cosine * log_distance_integral(e, f);
    }
  }
  return std::max(0.0, sum / (2.0 * base::pi));
}

double lambert_exchange_m2(const ConvexPolygon& points_on, const ConvexPolygon& polygon,
                           int points) {
  thread_local std::vector<AreaPoint> at;
  area_points(points_on, points, at);
  double sum = 0.0;
  for (const AreaPoint& p : at) {
    sum += p.weight_m2 * std::max(0.0, point_share(polygon, p.position, points_on.normal));
  }
  return sum;
}

double area_exchange_m2(const PointView& first, const Vec3& first_normal, const PointView& second,
                        const Vec3& second_normal) {
  constexpr std::size_t lanes = 4;
  const Vec3 n = first_normal, m = second_normal;
  std::array<double, lanes> sum{};
  for (std::size_t p = 0; p < first.count; ++p) {
    if (first.weight_m2[p] == 0.0) continue;
    const double x = first.x[p], y = first.y[p], z = first.z[p], weight = first.weight_m2[p];
    for (std::size_t q = 0; q < second.count; q += lanes) {
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        const double dx = second.x[q + lane] - x, dy = second.y[q + lane] - y;
        const double dz = second.z[q + lane] - z;
        const double square = dx * dx + dy * dy + dz * dz;
        const double here = dx * n.x + dy * n.y + dz * n.z;
        const double there = dx * m.x + dy * m.y + dz * m.z;
        sum[lane] -= weight * second.weight_m2[q + lane] * here * there / (square * square);
      }
    }
  }
  return std::max(0.0, ((sum[0] + sum[1]) + (sum[2] + sum[3])) / base::pi);
}

int area_order(double separation) {
  // Measured on random pairs: relative error at most 2e-5 (F itself below 1e-3 there), 2e-6, 3e-7.
  if (separation > 12.0) return 2;
  if (separation > 5.0) return 3;
  if (separation > 2.8) return 4;
  return 0;
}

double exchange_m2(const ConvexPolygon& first, const ConvexPolygon& second, double margin_m) {
  if (first.count < 3 || second.count < 3) return 0.0;
  const Ball whole = ball_around(first), other = ball_around(second);
  const double margin =
      margin_m + 1e-12 * (whole.radius + other.radius + glm::length(whole.centre - other.centre));
  ConvexPolygon a = clip(first, {second[0], second.normal}, margin);
  ConvexPolygon b = clip(second, {first[0], first.normal}, margin);
  if (a.count < 3 || b.count < 3) return 0.0;
  Ball ball_a = ball_around(a), ball_b = ball_around(b);
  const double separation =
      glm::length(ball_a.centre - ball_b.centre) / (ball_a.radius + ball_b.radius);
  if (const int order = area_order(separation); order > 0) {
    thread_local PointColumns points_a, points_b;
    points_a.clear();
    points_b.clear();
    points_a.add(a, order);
    points_b.add(b, order);
    return area_exchange_m2(points_a.view(), a.normal, points_b.view(), b.normal);
  }
  if (ball_a.radius > ball_b.radius) {
    std::swap(a, b);
    std::swap(ball_a, ball_b);
  }
  // A small polygon before a wall: the contour's terms are (wall / small)^2 times their sum or
  // more.
  const double distance = distance_m(b, ball_a.centre);
  if (ball_a.radius < 0.01 * (ball_b.radius + distance) && distance > 1.5 * ball_a.radius) {
    return lambert_exchange_m2(a, b, 6);
  }
  return contour_exchange_m2(a, b);
}

double log_distance_integral(const Segment& e, const Segment& f) {
  const double cosine = glm::dot(e.direction, f.direction);
  const Vec3 cross = glm::cross(e.direction, f.direction);
  const double sine = glm::length(cross);
  if (sine < parallel_sine) return parallel_integral(e, f, cosine);
  const Vec3 between = f.start - e.start;
  const double extent = glm::length(between) + e.length + f.length;
  if (sine > meeting_sine && std::abs(glm::dot(between, cross)) < meeting_share * sine * extent) {
    // Feet of the common perpendicular, from each edge's start.
    const double a = glm::dot(between, e.direction), b = glm::dot(between, f.direction);
    const double s = (a - b * cosine) / (sine * sine);
    const double t = (a * cosine - b) / (sine * sine);
    return meeting_integral(-s, e.length - s, -t, f.length - t, cosine, sine);
  }
  return e.length >= f.length ? skew_integral(e, f, cosine, cross, sine)
                              : skew_integral(f, e, cosine, -cross, sine);
}

}  // namespace earthshine::radiosity
