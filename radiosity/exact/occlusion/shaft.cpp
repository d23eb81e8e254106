// SPDX-License-Identifier: Apache-2.0
#include "radiosity/exact/occlusion/shaft.h"

#include <cmath>

namespace earthshine::radiosity {

Shaft::Shaft(const ConvexPolygon& first, const ConvexPolygon& second, double margin_m)
    : low_(first[0]), high_(first[0]), margin_m_(margin_m) {
  for (const ConvexPolygon* polygon : {&first, &second}) {
    for (int k = 0; k < polygon->count; ++k) {
      low_ = glm::min(low_, (*polygon)[k]);
      high_ = glm::max(high_, (*polygon)[k]);
    }
  }
  add_planes(first, second);
  add_planes(second, first);
}

void Shaft::add_planes(const ConvexPolygon& from, const ConvexPolygon& to) {
  for (int k = 0; k < from.count; ++k) {
    const Vec3& start = from[k];
    const Vec3 edge = from.next(k) - start;
    // Turn a plane about the edge, outwards, until nothing of `to` is beyond it.
    Vec3 normal = glm::cross(edge, to[0] - start);
    for (int j = 1; j < to.count; ++j) {
      if (glm::dot(normal, to[j] - start) > 0.0) normal = glm::cross(edge, to[j] - start);
    }
    const double length = glm::length(normal);
    if (length <= margin_m_ * glm::length(edge)) continue;
    const Plane plane{start, normal / length};
    // Touching polygons have corners on the edge's own line, which leave the turning undecided.
    bool bounds = true;
    for (const ConvexPolygon* polygon : {&from, &to}) {
      for (int j = 0; j < polygon->count; ++j) {
        bounds = bounds && plane.height((*polygon)[j]) <= margin_m_;
      }
    }
    if (bounds) outside_[count_++] = plane;
  }
}

bool Shaft::may_hide(const ConvexPolygon& blocker) const {
  Vec3 low = blocker[0], high = blocker[0];
  for (int k = 1; k < blocker.count; ++k) {
    low = glm::min(low, blocker[k]);
    high = glm::max(high, blocker[k]);
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (low[axis] > high_[axis] + margin_m_ || high[axis] < low_[axis] - margin_m_) return false;
  }
  for (std::size_t p = 0; p < count_; ++p) {
    bool beyond = true;
    for (int k = 0; k < blocker.count && beyond; ++k) {
      beyond = outside_[p].height(blocker[k]) >= -margin_m_;
    }
    if (beyond) return false;
  }
  return true;
}

}  // namespace earthshine::radiosity
