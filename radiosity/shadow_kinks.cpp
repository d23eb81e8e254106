// SPDX-License-Identifier: Apache-2.0
#include "radiosity/shadow_kinks.h"

#include <cmath>

namespace earthshine::radiosity {
namespace {

// Sine below which edges count as parallel, and the share of a side within which points are one.
constexpr double parallel = 1e-7, same = 1e-9;

}  // namespace

// Edges along `along`, as points of the plane across it: `across` in units of the receiver's side,
// `towards` the height above the receiver in metres.
void ShadowKinks::collect(const ConvexPolygon& polygon, const Vec3& corner, const Vec3& side,
                          const Vec3& along, std::vector<Point>& points) const {
  const Vec3 normal = glm::normalize(glm::cross(side, along));
  // Of the plane spanned by side and normal, seen along `along`.
  const Vec3 across = glm::cross(along, normal);
  const double unit = glm::dot(across, side);
  for (int k = 0; k < polygon.count; ++k) {
    const Vec3 edge = polygon.next(k) - polygon[k];
    if (glm::length(glm::cross(edge, along)) > parallel * glm::length(edge) * glm::length(along)) {
      continue;
    }
    const Vec3 from = polygon[k] - corner;
    const Point made{glm::dot(from, across) / unit, glm::dot(from, normal)};
    bool known = false;
    for (const Point& point : points) {
      known = known || (std::abs(point.across - made.across) < same &&
                        std::abs(point.towards - made.towards) < same * glm::length(side));
    }
    if (!known) points.push_back(made);
  }
}

void ShadowKinks::find(const Vec3& corner, const Vec3& side, const Vec3& along,
                       const ConvexPolygon& target, std::span<const Blocker> blockers,
                       std::vector<double>& kinks) {
  of_target_.clear();
  of_blockers_.clear();
  collect(target, corner, side, along, of_target_);
  for (const Blocker& blocker : blockers) collect(blocker.shape, corner, side, along, of_blockers_);
  // The line through two points meets the receiver, towards = 0, at x.
  const auto add = [&kinks](const Point& p, const Point& q) {
    const double rise = q.towards - p.towards;
    if (rise == 0.0) return;
    const double x = p.across - p.towards * (q.across - p.across) / rise;
    if (x > same && x < 1.0 - same) kinks.push_back(x);
  };
  kinks.clear();
  for (std::size_t k = 0; k < of_blockers_.size(); ++k) {
    for (const Point& point : of_target_) add(of_blockers_[k], point);
    for (std::size_t j = 0; j < k; ++j) add(of_blockers_[k], of_blockers_[j]);
  }
}

void ShadowKinks::find(const Vec3& corner, const Vec3& ab, const Vec3& ad,
                       const ConvexPolygon& target, std::span<const Blocker> blockers) {
  find(corner, ab, ad, target, blockers, at_x_);
  find(corner, ad, ab, target, blockers, at_y_);
}

void ShadowKinks::clear() {
  at_x_.clear();
  at_y_.clear();
}

double ShadowKinks::split(const std::vector<double>& kinks, double low, double high) {
  const double middle = 0.5 * (low + high), width = high - low;
  double nearest = (0.5 - 1e-6) * width, best = middle;
  for (const double x : kinks) {
    if (std::abs(x - middle) < nearest) {
      nearest = std::abs(x - middle);
      best = x;
    }
  }
  return best;
}

}  // namespace earthshine::radiosity
