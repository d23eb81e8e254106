// SPDX-License-Identifier: Apache-2.0
#include "radiosity/patches/cluster_members.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/units.h"

namespace earthshine::radiosity {

ClusterSpan span_of(const Facet& cluster, const Cell& cell) {
  ClusterSpan span{cluster.first_member, cluster.members, {0.0, 1.0, 0.0, 1.0}};
  std::uint32_t digits = cell.s_cuts;
  for (; span.count > 1 && digits > 0; --digits) {
    const std::uint32_t left = span.count / 2;
    if (((cell.s >> (digits - 1)) & 1U) != 0) {
      span.first += left;
      span.count -= left;
    } else {
      span.count = left;
    }
  }
  if (span.count > 1) return span;
  const double rows = std::ldexp(1.0, static_cast<int>(digits));
  const double columns = std::ldexp(1.0, cell.t_cuts);
  const std::uint32_t own = cell.s & static_cast<std::uint32_t>((std::uint64_t{1} << digits) - 1);
  span.part = {own / rows, (own + 1.0) / rows, cell.t / columns, (cell.t + 1.0) / columns};
  return span;
}

Facet facet_about(const std::array<Vec3, 3>& p, std::uint8_t apex) {
  Facet facet;
  facet.apex = apex;
  facet.corner = p[apex];
  facet.a = p[(apex + 1) % 3] - facet.corner;
  facet.b = p[(apex + 2) % 3] - facet.corner;
  const Vec3 cross = glm::cross(facet.a, facet.b);
  facet.area_m2 = 0.5 * glm::length(cross);
  facet.normal = glm::normalize(cross);
  return facet;
}

std::uint8_t apex_of(const std::array<Vec3, 3>& p) {
  const auto squared = [](const Vec3& edge) { return glm::dot(edge, edge); };
  const double a = squared(p[1] - p[2]), b = squared(p[2] - p[0]), c = squared(p[0] - p[1]);
  if (a <= b && a <= c) return 0;
  return b <= c ? 1 : 2;
}

Facet facet_of_triangle(const Vec3& p0, const Vec3& p1, const Vec3& p2) {
  const std::array<Vec3, 3> p{p0, p1, p2};
  return facet_about(p, apex_of(p));
}

TriangleLengths lengths_of(const Facet& triangle) {
  return {std::max(glm::length(triangle.a), glm::length(triangle.b)),
          glm::length(triangle.b - triangle.a)};
}

Facet ClusterMembers::facet(std::uint32_t member) const {
  const auto& v = corner[member];
  Facet facet = facet_about({vertices[v[0]], vertices[v[1]], vertices[v[2]]}, apex[member]);
  facet.triangle = triangle[member];
  return facet;
}

double ClusterMembers::area(const ClusterSpan& span) const {
  if (span.count > 1) return area_to[span.first + span.count] - area_to[span.first];
  return area_of(facet(span.first), span.part);
}

Vec3 ClusterMembers::normal(const ClusterSpan& span) const {
  Vec3 sum(0.0);
  for (std::uint32_t m = span.first; m < span.first + span.count; ++m) {
    const auto& v = corner[m];
    sum += glm::cross(vertices[v[1]] - vertices[v[0]], vertices[v[2]] - vertices[v[0]]);
  }
  return glm::normalize(sum);
}

std::uint32_t ClusterMembers::pick(const ClusterSpan& span, double& x) const {
  if (span.count == 1) return span.first;
  const auto begin = area_to.begin() + span.first + 1, end = begin + (span.count - 1);
  const double low = area_to[span.first], high = area_to[span.first + span.count];
  const double wanted = low + x * (high - low);
  const auto member =
      static_cast<std::uint32_t>(std::upper_bound(begin, end, wanted) - area_to.begin() - 1);
  const double before = area_to[member];
  x = std::clamp((wanted - before) / (area_to[member + 1] - before), 0.0, 1.0);
  return member;
}

Parameters ClusterMembers::parameters(const Facet& cluster, std::uint32_t member,
                                      Parameters own) const {
  constexpr double below_one = 1.0 - 0x1p-30;  // s = 1 would be the next triangle
  std::uint32_t k = member - cluster.first_member, count = cluster.members;
  double path = 0.0, step = 1.0;
  while (count > 1) {
    const std::uint32_t left = count / 2;
    step *= 0.5;
    if (k >= left) {
      path += step;
      k -= left;
      count -= left;
    } else {
      count = left;
    }
  }
  return {path + step * std::clamp(own.s, 0.0, below_one), own.t};
}

std::array<Vec3, 4> ClusterMembers::corners(const ClusterSpan& span) const {
  const base::Frame3 frame = base::frame_around(normal(span));
  Vec3 low(std::numeric_limits<double>::infinity()), high = -low;
  for (std::uint32_t m = span.first; m < span.first + span.count; ++m) {
    for (const std::uint32_t v : corner[m]) {
      const Vec3& p = vertices[v];
      const Vec3 there(glm::dot(p, frame.tangent), glm::dot(p, frame.bitangent),
                       glm::dot(p, frame.normal));
      low = glm::min(low, there);
      high = glm::max(high, there);
    }
  }
  const double height = 0.5 * (low.z + high.z);
  return {frame.to_world({low.x, low.y, height}), frame.to_world({high.x, low.y, height}),
          frame.to_world({high.x, high.y, height}), frame.to_world({low.x, high.y, height})};
}

scenes::Box ClusterMembers::box(const ClusterSpan& span) const {
  Vec3 low(std::numeric_limits<double>::infinity()), high = -low;
  for (std::uint32_t m = span.first; m < span.first + span.count; ++m) {
    for (const std::uint32_t v : corner[m]) {
      low = glm::min(low, vertices[v]);
      high = glm::max(high, vertices[v]);
    }
  }
  return {low, high};
}

}  // namespace earthshine::radiosity
