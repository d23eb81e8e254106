// SPDX-License-Identifier: Apache-2.0
#include "scenes/view/projection.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>

namespace earthshine::scenes {
namespace {

constexpr int newton_steps = 40;  // 4 or 5 are usual
constexpr int bisections = 20;    // to a millionth of the limit
constexpr double newton_end = 1e-14;
constexpr int azimuths = 64;         // along which the distortion is followed outward
constexpr double limit_step = 0.01;  // of the radius or angle
constexpr double widest = 50.0;      // tangent; 88.9 degrees from the axis
constexpr int border_points = 64;    // along each side of the picture

}  // namespace

Projection::Projection(const Camera& camera, int columns, int rows)
    : half_height(std::tan(base::radians(camera.fov_deg / 2))),
      distortion_(camera.distortion),
      k_(camera.distortion_k) {
  half_width = half_height * columns / rows;
  if (camera.intrinsics) {
    const auto [fx, fy, cx, cy] = *camera.intrinsics;
    half_width = 0.5 * camera.columns / fx;
    half_height = 0.5 * camera.rows / fy;
    middle = {(0.5 * camera.columns - cx) / fx, (0.5 * camera.rows - cy) / fy};
  }
  if (distortion_ == Distortion::Fisheye) {
    while (limit_ + limit_step < base::pi && fisheye_slope(limit_ + limit_step) > 0.0) {
      limit_ += limit_step;
    }
  } else if (distortion_ == Distortion::BrownConrady) {
    const auto grows = [this](double radius) {
      for (int k = 0; k < azimuths; ++k) {
        const double phi = 2.0 * base::pi * k / azimuths;
        const glm::dvec2 at = radius * glm::dvec2(std::cos(phi), std::sin(phi));
        const glm::dmat2 slope = brown_conrady_slope(at);
        if (!(glm::determinant(slope) > 0.0 && glm::dot(at, slope * at) > 0.0)) return false;
      }
      return true;
    };
    limit_ = std::numeric_limits<double>::infinity();
    for (double radius = limit_step; radius < widest; radius *= 1.0 + limit_step) {
      if (grows(radius)) continue;
      limit_ = radius / (1.0 + limit_step);
      break;
    }
  }
}

Vec3 Projection::direction(const glm::dvec2& place) const {
  glm::dvec2 at((2.0 * place.x - 1.0) * half_width + middle.x,
                (2.0 * place.y - 1.0) * half_height + middle.y);
  if (distortion_ == Distortion::BrownConrady) at = without_brown_conrady(at);
  if (distortion_ != Distortion::Fisheye) return {at, 1.0};
  const double radius = glm::length(at);
  if (!(radius > 0.0)) return {0.0, 0.0, 1.0};
  const double angle = fisheye_angle(radius);
  return {at * (std::sin(angle) / radius), std::cos(angle)};
}

glm::dvec2 Projection::place(const Vec3& point) const {
  const glm::dvec2 at = film(point) - middle;
  return {0.5 * (at.x / half_width + 1.0), 0.5 * (at.y / half_height + 1.0)};
}

bool Projection::shows(const Vec3& point) const {
  if (!is_before(point)) return false;
  const glm::dvec2 at = place(point);
  return at.x >= 0.0 && at.y >= 0.0 && at.x <= 1.0 && at.y <= 1.0;
}

double Projection::film_per_sr(const Vec3& point) const {
  if (distortion_ != Distortion::Fisheye) {
    const double secant = glm::length(point) / point.z;
    return magnification(point) * secant * secant * secant;
  }
  const double angle = std::atan2(std::hypot(point.x, point.y), point.z);
  if (angle < 1e-6) return 1.0;
  return fisheye(angle) * fisheye_slope(angle) / std::sin(angle);
}

double Projection::film_per_rad(const Vec3& point) const {
  if (distortion_ == Distortion::Fisheye) {
    const double angle = std::atan2(std::hypot(point.x, point.y), point.z);
    if (angle < 1e-6) return 1.0;
    return std::max(fisheye_slope(angle), fisheye(angle) / std::sin(angle));
  }
  const double across = glm::dot(point, point) / (point.z * point.z);
  if (distortion_ == Distortion::None) return across;
  const glm::dmat2 slope = brown_conrady_slope(glm::dvec2(point) / point.z);
  return across * std::sqrt(glm::dot(slope[0], slope[0]) + glm::dot(slope[1], slope[1]));
}

double Projection::px_per_rad(const Vec3& point, int columns, int rows) const {
  constexpr double step = 1e-4;  // rad; differences have an error of its square
  const Vec3 direction = glm::normalize(point);
  const base::Frame3 frame = base::frame_around(direction);
  const glm::dvec2 px(columns, rows);
  const auto slope = [&](const Vec3& side) {
    return px * (place(direction + step * side) - place(direction - step * side)) / (2.0 * step);
  };
  // The largest singular value of the derivative.
  const glm::dvec2 u = slope(frame.tangent), v = slope(frame.bitangent);
  const double a = glm::dot(u, u), b = glm::dot(v, v), c = glm::dot(u, v);
  return std::sqrt(0.5 * (a + b) + std::hypot(0.5 * (a - b), c));
}

double Projection::magnification(const Vec3& point) const {
  switch (distortion_) {
    case Distortion::None:
      return 1.0;
    case Distortion::BrownConrady:
      return std::abs(glm::determinant(brown_conrady_slope(glm::dvec2(point) / point.z)));
    case Distortion::Fisheye:
      break;
  }
  const double cosine = point.z / glm::length(point);
  return film_per_sr(point) * std::abs(cosine * cosine * cosine);
}

bool Projection::covers_picture() const {
  if (!is_distorted()) return true;
  for (int k = 0; k <= border_points; ++k) {
    const double t = static_cast<double>(k) / border_points;
    for (const glm::dvec2 at : {glm::dvec2(t, 0), {t, 1}, {0, t}, {1, t}}) {
      const Vec3 there = direction(at);
      const double radius = std::hypot(there.x, there.y);
      const double reached =
          distortion_ == Distortion::Fisheye ? std::atan2(radius, there.z) : radius;
      if (!(reached < limit_) || !(glm::length(place(there) - at) < 1e-9)) return false;
    }
  }
  return true;
}

glm::dvec2 Projection::film(const Vec3& point) const {
  if (distortion_ == Distortion::None) return {point.x / point.z, point.y / point.z};
  if (distortion_ == Distortion::Fisheye) {
    const double radius = std::hypot(point.x, point.y);
    if (!(radius > 0.0)) return glm::dvec2(0.0);
    return glm::dvec2(point) * (fisheye(std::atan2(radius, point.z)) / radius);
  }
  const glm::dvec2 pinhole(point.x / point.z, point.y / point.z);
  const double beyond = glm::length(pinhole) / limit_;
  return beyond > 1.0 ? beyond * brown_conrady(pinhole / beyond) : brown_conrady(pinhole);
}

// k1, k2, p1, p2, k3. Brown, "Decentering distortion of lenses", Photogrammetric Engineering 32
// (1966), as OpenCV's calib3d writes it.
glm::dvec2 Projection::brown_conrady(const glm::dvec2& p) const {
  const auto [k1, k2, p1, p2, k3] = k_;
  const double r2 = glm::dot(p, p), radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  return {p.x * radial + 2.0 * p1 * p.x * p.y + p2 * (r2 + 2.0 * p.x * p.x),
          p.y * radial + p1 * (r2 + 2.0 * p.y * p.y) + 2.0 * p2 * p.x * p.y};
}

// Columns: derivatives by x and by y.
glm::dmat2 Projection::brown_conrady_slope(const glm::dvec2& p) const {
  const auto [k1, k2, p1, p2, k3] = k_;
  const double r2 = glm::dot(p, p), radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double by_r2 = k1 + r2 * (2.0 * k2 + r2 * 3.0 * k3);
  const double mixed = 2.0 * p.x * p.y * by_r2 + 2.0 * p1 * p.x + 2.0 * p2 * p.y;
  return {radial + 2.0 * p.x * p.x * by_r2 + 2.0 * p1 * p.y + 6.0 * p2 * p.x, mixed, mixed,
          radial + 2.0 * p.y * p.y * by_r2 + 6.0 * p1 * p.y + 2.0 * p2 * p.x};
}

// The radial terms alone grow up to the limit: bisection. Newton's steps from the film itself would
// leave the limit where it is near.
glm::dvec2 Projection::start_for(const glm::dvec2& film) const {
  const double wanted = glm::length(film);
  if (!(wanted > 0.0) || !std::isfinite(limit_)) return film;
  const auto [k1, k2, p1, p2, k3] = k_;
  const auto radial = [&](double r) {
    return r * (1.0 + r * r * (k1 + r * r * (k2 + r * r * k3)));
  };
  if (radial(limit_) <= wanted) return film * (2.0 * limit_ / wanted);
  double low = 0.0, high = limit_;
  for (int k = 0; k < bisections; ++k) {
    const double half = 0.5 * (low + high);
    (radial(half) < wanted ? low : high) = half;
  }
  return film * (low / wanted);
}

glm::dvec2 Projection::without_brown_conrady(const glm::dvec2& film) const {
  glm::dvec2 at = start_for(film);
  for (int k = 0; k < newton_steps; ++k) {
    const double radius = glm::length(at);
    if (radius > limit_) {
      // Beyond the limit the film grows linearly.
      const glm::dvec2 rim = at * (limit_ / radius);
      return rim * (glm::length(film) / glm::length(brown_conrady(rim)));
    }
    const glm::dvec2 step = glm::inverse(brown_conrady_slope(at)) * (brown_conrady(at) - film);
    at -= step;
    if (!(glm::dot(step, step) > newton_end * newton_end * (1.0 + glm::dot(at, at)))) break;
  }
  return at;
}

// k1 to k4. Kannala and Brandt, "A generic camera model and calibration method", IEEE PAMI 28
// (2006), as OpenCV's fisheye module writes it: the radius on the film at unit focal length.
double Projection::fisheye(double angle) const {
  const auto [k1, k2, k3, k4, unused] = k_;
  const double a = std::min(angle, limit_), a2 = a * a;
  return a * (1.0 + a2 * (k1 + a2 * (k2 + a2 * (k3 + a2 * k4)))) +
         fisheye_slope(limit_) * (angle - a);
}

double Projection::fisheye_slope(double angle) const {
  const auto [k1, k2, k3, k4, unused] = k_;
  const double a2 = angle * angle;
  return 1.0 + a2 * (3.0 * k1 + a2 * (5.0 * k2 + a2 * (7.0 * k3 + a2 * 9.0 * k4)));
}

double Projection::fisheye_angle(double radius) const {
  double angle = std::min(radius, limit_);
  for (int k = 0; k < newton_steps; ++k) {
    const double step = (fisheye(angle) - radius) / fisheye_slope(std::min(angle, limit_));
    angle = std::max(0.0, angle - step);
    if (!(std::abs(step) > newton_end)) break;
  }
  return angle;
}

}  // namespace earthshine::scenes
