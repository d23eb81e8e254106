// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh/triangulate.h"

#include <algorithm>
#include <cmath>

namespace earthshine::scenes {
namespace {

using Point = glm::dvec2;
constexpr double area_tolerance = 1e-4;  // relative

// Twice the signed area of (a, b, c).
double orientation(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

double triangle_area(const Vec3& a, const Vec3& b, const Vec3& c) {
  return 0.5 * glm::length(glm::cross(b - a, c - a));
}

// The remaining outline: a ring of corners from which ears are clipped.
class EarClipper {
 public:
  EarClipper(std::span<const Point> points, std::span<const std::uint32_t> corners, double flat)
      : points_(points),
        corners_(corners),
        flat_(flat),
        next_(corners.size()),
        previous_(corners.size()),
        ear_(corners.size()) {
    const std::size_t n = corners.size();
    for (std::size_t i = 0; i < n; ++i) {
      next_[i] = (i + 1) % n;
      previous_[i] = (i + n - 1) % n;
    }
    for (std::size_t i = 0; i < n; ++i) ear_[i] = is_ear(i);
  }

  void run(std::vector<std::array<std::uint32_t, 3>>& triangles) {
    std::size_t start = 0;
    for (std::size_t left = corners_.size(); left > 3; --left) {
      const std::size_t ear = best_ear(start);
      cut(ear, triangles);
      start = next_[ear];
      next_[previous_[ear]] = next_[ear];
      previous_[next_[ear]] = previous_[ear];
      ear_[next_[ear]] = is_ear(next_[ear]);
      ear_[previous_[ear]] = is_ear(previous_[ear]);
    }
    cut(start, triangles);
  }

 private:
  [[nodiscard]] const Point& at(std::size_t i) const { return points_[corners_[i]]; }
  [[nodiscard]] double orientation_at(std::size_t i) const {
    return orientation(at(previous_[i]), at(i), at(next_[i]));
  }

  [[nodiscard]] bool is_ear(std::size_t i) const {
    const Point& a = at(previous_[i]);
    const Point& b = at(i);
    const Point& c = at(next_[i]);
    if (orientation(a, b, c) <= flat_) return false;
    for (std::size_t k = next_[next_[i]]; k != previous_[i]; k = next_[k]) {
      const Point& p = at(k);
      // A corner that coincides with one of the ear's (a bridge to a hole) does not block it.
      if (p == a || p == b || p == c) continue;
      if (orientation(a, b, p) >= 0.0 && orientation(b, c, p) >= 0.0 && orientation(c, a, p) >= 0.0)
        return false;
    }
    return true;
  }

  // Prefers well-shaped triangles. An ear beside a straight corner has priority: without its
  // neighbours, such a corner can only end in a triangle without area and leave a gap.
  [[nodiscard]] double quality(std::size_t i) const {
    const Point& a = at(previous_[i]);
    const Point& b = at(i);
    const Point& c = at(next_[i]);
    const Point ab = b - a, bc = c - b, ca = a - c;
    const double longest = std::max({glm::dot(ab, ab), glm::dot(bc, bc), glm::dot(ca, ca)});
    const bool frees_straight = std::abs(orientation_at(previous_[i])) <= flat_ ||
                                std::abs(orientation_at(next_[i])) <= flat_;
    return orientation(a, b, c) / longest + (frees_straight ? 2.0 : 0.0);
  }

  [[nodiscard]] std::size_t best_ear(std::size_t start) const {
    std::size_t best = start;
    double best_quality = -1.0;
    std::size_t straightest = start;
    double least = std::abs(orientation_at(start));
    std::size_t i = start;
    do {
      if (ear_[i]) {
        const double q = quality(i);
        if (q > best_quality) {
          best = i;
          best_quality = q;
        }
      }
      if (std::abs(orientation_at(i)) < least) {
        straightest = i;
        least = std::abs(orientation_at(i));
      }
      i = next_[i];
    } while (i != start);
    // No ear: remove the corner that changes the outline least. The final area check detects
    // errors.
    return best_quality >= 0.0 ? best : straightest;
  }

  void cut(std::size_t i, std::vector<std::array<std::uint32_t, 3>>& triangles) const {
    triangles.push_back({corners_[previous_[i]], corners_[i], corners_[next_[i]]});
  }

  std::span<const Point> points_;
  std::span<const std::uint32_t> corners_;
  double flat_;
  std::vector<std::size_t> next_, previous_;
  std::vector<char> ear_;
};

// Keeps the triangles with area and compares the sum of areas.
void judge(std::span<const Vec3> corners, std::span<const Point> points, double smallest_area,
           Triangulation& result) {
  double seen_area = 0.0;  // along the normal, with all triangles counted positive
  for (const auto& t : result.triangles) {
    seen_area += 0.5 * std::abs(orientation(points[t[0]], points[t[1]], points[t[2]]));
    result.triangle_area += triangle_area(corners[t[0]], corners[t[1]], corners[t[2]]);
  }
  std::erase_if(result.triangles, [&](const auto& t) {
    return triangle_area(corners[t[0]], corners[t[1]], corners[t[2]]) < smallest_area;
  });
  const bool conserved = std::abs(seen_area - result.area) <= area_tolerance * result.area;
  result.kind = !conserved                 ? PolygonKind::Crossing
                : result.triangles.empty() ? PolygonKind::Degenerate
                                           : PolygonKind::Sound;
}

// Divides a quadrilateral whose edges cross only in projection; a flat one keeps its result.
void cut_twisted(std::span<const Vec3> corners, std::span<const std::uint32_t> ring,
                 Triangulation& result) {
  constexpr double flat_share = 1e-3;  // its height over its longest diagonal
  if (ring.size() != 4) return;
  const auto at = [&](std::size_t k) { return corners[ring[k % 4]]; };
  // The halves (k, k+1, k+2) and (k, k+2, k+3).
  const auto halves = [&](std::size_t k) {
    return triangle_area(at(k), at(k + 1), at(k + 2)) + triangle_area(at(k), at(k + 2), at(k + 3));
  };
  const double first = halves(0), second = halves(1);
  const std::size_t k = second < first ? 1 : 0;
  const double area = std::min(first, second);
  const double longest = std::max(glm::length(at(2) - at(0)), glm::length(at(3) - at(1)));
  const double volume = std::abs(glm::dot(glm::cross(at(1) - at(0), at(2) - at(0)), at(3) - at(0)));
  if (volume <= flat_share * longest * area) return;
  result.triangles = {{ring[k], ring[k + 1], ring[k + 2]},
                      {ring[k], ring[k + 2], ring[(k + 3) % 4]}};
  result.triangle_area = area;
  result.kind = PolygonKind::Sound;
}

}  // namespace

Vec3 vector_area(std::span<const Vec3> corners) {
  Vec3 sum(0.0);
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    sum += glm::cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
  }
  return 0.5 * sum;
}

void triangulate(std::span<const Vec3> corners, double smallest_area, Triangulation& result) {
  result = {PolygonKind::Degenerate, std::move(result.triangles), 0.0, 0.0};
  result.triangles.clear();
  const Vec3 area = vector_area(corners);
  result.area = glm::length(area);
  const std::size_t n = corners.size();
  if (n == 3) {
    if (!(result.area >= smallest_area) || result.area == 0.0) return;
    result.triangles.push_back({0, 1, 2});
    result.triangle_area = result.area;
    result.kind = PolygonKind::Sound;
    return;
  }
  std::vector<std::uint32_t> ring;
  for (std::uint32_t i = 0; i < n; ++i) {
    if (ring.empty() || corners[i] != corners[ring.back()]) ring.push_back(i);
  }
  while (ring.size() > 1 && corners[ring.front()] == corners[ring.back()]) ring.pop_back();
  if (ring.size() < 3) return;
  if (!(result.area >= smallest_area) || result.area == 0.0) {
    // No area along the normal: degenerate, or the outline is a figure of eight.
    double unsigned_area = 0.0;
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
      unsigned_area += triangle_area(corners[ring[0]], corners[ring[i]], corners[ring[i + 1]]);
    }
    const double threshold = smallest_area * static_cast<double>(n);
    result.kind = unsigned_area > threshold ? PolygonKind::Crossing : PolygonKind::Degenerate;
    if (result.kind == PolygonKind::Crossing) cut_twisted(corners, ring, result);
    return;
  }
  const base::Frame3 frame = base::frame_around(area / result.area);
  std::vector<Point> points(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 local = corners[i] - corners[0];
    points[i] = {glm::dot(local, frame.tangent), glm::dot(local, frame.bitangent)};
  }
  const double flat = 1e-9 * result.area;
  const auto orientation_at = [&](std::size_t i) {
    const std::size_t m = ring.size();
    return orientation(points[ring[(i + m - 1) % m]], points[ring[i]], points[ring[(i + 1) % m]]);
  };
  const bool convex_quad = ring.size() == 4 && orientation_at(0) > flat &&
                           orientation_at(1) > flat && orientation_at(2) > flat &&
                           orientation_at(3) > flat;
  if (convex_quad) {
    result.triangles.push_back({ring[0], ring[1], ring[2]});
    result.triangles.push_back({ring[0], ring[2], ring[3]});
  } else {
    EarClipper(points, ring, flat).run(result.triangles);
  }
  judge(corners, points, smallest_area, result);
  if (result.kind == PolygonKind::Crossing) cut_twisted(corners, ring, result);
}

}  // namespace earthshine::scenes
