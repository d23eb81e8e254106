// SPDX-License-Identifier: Apache-2.0
#include "radiosity/exact/occlusion/shadow_kinks.h"

#include <cmath>

namespace earthshine::radiosity {
namespace {

// Sine below which edges count as parallel, and the share of a side within which points are one.
constexpr double parallel = 1e-7, same = 1e-9;
// Round bodies have no edges that matter one by one.
constexpr std::size_t most_edges = 48;

}  // namespace

// An edge along `along`, as a point of the plane across it: `across` in units of the receiver's
// side, `towards` the height above the receiver in metres.
void ShadowKinks::collect(const Vec3& from, const Vec3& to, const Lookout& lookout,
                          std::vector<Point>& points) {
  const Vec3 edge = to - from;
  const double off = glm::length(glm::cross(edge, lookout.along));
  if (off > parallel * glm::length(edge) * lookout.along_m) return;
  const Vec3 at = from - lookout.corner;
  const Point made{glm::dot(at, lookout.across), glm::dot(at, lookout.normal)};
  for (const Point& point : points) {
    if (std::abs(point.across - made.across) < same &&
        std::abs(point.towards - made.towards) < same * lookout.side_m) {
      return;
    }
  }
  points.push_back(made);
}

void ShadowKinks::find(const Vec3& corner, const Vec3& side, const Vec3& along,
                       const TargetFrame& frame, const ConvexPolygon& target,
                       std::span<const Blocker> blockers, std::vector<double>& kinks) {
  Lookout lookout{corner,
                  along,
                  glm::normalize(glm::cross(side, along)),
                  Vec3(0.0),
                  glm::length(side),
                  glm::length(along)};
  // In the plane spanned by side and normal, seen along `along`.
  const Vec3 across = glm::cross(along, lookout.normal);
  lookout.across = across / glm::dot(across, side);
  of_target_.clear();
  of_blockers_.clear();
  for (int k = 0; k < target.count; ++k) {
    collect(target[k], target.next(k), lookout, of_target_);
  }
  for (const Blocker& blocker : blockers) {
    if (blocker.body != nullptr) {
      if (blocker.body->edges.size() > most_edges) continue;
      for (const ConvexBody::Edge& edge : blocker.body->edges) {
        collect(frame.point(edge.from), frame.point(edge.to), lookout, of_blockers_);
      }
    } else {
      for (int k = 0; k < blocker.shape.count; ++k) {
        collect(blocker.shape[k], blocker.shape.next(k), lookout, of_blockers_);
      }
    }
  }
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

void ShadowKinks::find(const Vec3& corner, const Vec3& ab, const Vec3& ad, const TargetFrame& frame,
                       const ConvexPolygon& target, std::span<const Blocker> blockers) {
  find(corner, ab, ad, frame, target, blockers, at_x_);
  find(corner, ad, ab, frame, target, blockers, at_y_);
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
