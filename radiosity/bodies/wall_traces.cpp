// SPDX-License-Identifier: Apache-2.0
#include "radiosity/bodies/wall_traces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "radiosity/bodies/closed_parts.h"
#include "scenes/health/box_join.h"
#include "scenes/surface_offset.h"
#include "scenes/triangle_point.h"

namespace earthshine::radiosity {
namespace {

using scenes::Corners;

double cross(const PlanePoint& u, const PlanePoint& v) { return u.x * v.y - u.y * v.x; }

// The two points where a triangle's border crosses a plane, or none.
std::optional<std::array<Vec3, 2>> meeting(const Corners& wall, const Vec3& corner,
                                           const Vec3& normal, bool both_sides, double touch_m) {
  const std::array<Vec3, 3> p{wall.a, wall.b, wall.c};
  std::array<double, 3> height{};
  for (std::size_t k = 0; k < 3; ++k) height[k] = glm::dot(p[k] - corner, normal);
  const auto [low, high] = std::minmax_element(height.begin(), height.end());
  const bool before = *high > touch_m, behind = *low < -touch_m;
  if (*low > touch_m || *high < -touch_m || !(before || (behind && both_sides))) {
    return std::nullopt;
  }
  std::array<Vec3, 2> ends{};
  std::size_t count = 0;
  const auto take = [&](const Vec3& point) {
    if (count < 2) ends[count] = point;
    ++count;
  };
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    if (std::abs(height[k]) <= touch_m) take(p[k]);
    if (std::abs(height[k]) <= touch_m || std::abs(height[next]) <= touch_m) continue;
    if ((height[k] > 0.0) == (height[next] > 0.0)) continue;
    take(p[k] + height[k] / (height[k] - height[next]) * (p[next] - p[k]));
  }
  if (count != 2) return std::nullopt;
  return ends;
}

class WallFinder {
 public:
  WallFinder(const scenes::Scene& scene, const Patches& patches)
      : scene_(scene), patches_(patches), offsets_(scene), by_facet_(patches.facets.size()) {}

  Traces find() {
    std::vector<scenes::LabelledBox> boxes;
    boxes.reserve(scene_.triangles.size());
    bool any = false;
    const Vec3 centre = scene_.vertices.empty() ? Vec3(0.0) : scene_.vertices.front();
    for (std::uint32_t t = 0; t < scene_.triangles.size(); ++t) {
      const std::uint32_t facet = patches_.of_triangle[t];
      // Visibility between a cluster's cells is not needed.
      const bool apart = !patches_.facets[facet].is_cluster();
      any = any || apart;
      const auto [a, b, c] = scenes::corners_of(scene_, t).seen_from(centre);
      const double touch_m = offsets_.contact(t);
      boxes.push_back({glm::vec3(glm::min(a, glm::min(b, c)) - 2.0 * touch_m),
                       glm::vec3(glm::max(a, glm::max(b, c)) + 2.0 * touch_m),
                       apart ? facet + 1 : 0, t});
    }
    if (!any) return Traces(std::move(by_facet_));
    scenes::join_boxes(std::move(boxes), [&](std::uint32_t a, std::uint32_t b) {
      look_at(a, b);
      look_at(b, a);
    });
    mark_bodies();
    for (std::size_t f = 0; f < by_facet_.size(); ++f) join_pieces(f);
    return Traces(std::move(by_facet_));
  }

 private:
  void look_at(std::uint32_t ground, std::uint32_t wall) {
    const std::uint32_t number = patches_.of_triangle[ground];
    const Facet& facet = patches_.facets[number];
    const scenes::Material& material = scene_.materials[scene_.triangles[wall].material];
    if (facet.is_cluster() || material.lets_light_through()) return;
    const Corners corners = scenes::corners_of(scene_, wall);
    const double touch_m = offsets_.contact(ground, wall);
    const auto ends =
        meeting(corners, facet.corner, facet.normal, facet.first_back != no_patch, touch_m);
    if (!ends) return;
    const Vec3 along = (*ends)[1] - (*ends)[0];
    if (glm::length(along) <= touch_m) return;
    Vec3 front = glm::normalize(glm::cross(facet.normal, along));
    if (glm::dot(front, corners.normal()) < 0.0) front = -front;
    Trace trace{in_plane(facet, (*ends)[0]), in_plane(facet, (*ends)[1]), {}, 0.0, front, false};
    if (!clip(facet, scenes::corners_of(scene_, ground), touch_m, trace)) return;
    trace.normal = {glm::dot(front, facet.a), glm::dot(front, facet.b)};
    trace.reach = glm::dot(trace.normal, 0.5 * (trace.from + trace.to));
    by_facet_[number].push_back(trace);
    if (!material.two_sided) of_bodies_.push_back({number, by_facet_[number].size() - 1, wall});
  }

  static PlanePoint in_plane(const Facet& facet, const Vec3& point) {
    const Vec3 d = point - facet.corner, n = glm::cross(facet.a, facet.b);
    const double size = glm::dot(n, n);
    return {glm::dot(glm::cross(d, facet.b), n) / size, glm::dot(glm::cross(facet.a, d), n) / size};
  }

  // Clips the trace to the facet's triangle; false if nothing remains.
  bool clip(const Facet& facet, const Corners& ground, double touch_m, Trace& trace) const {
    std::array<PlanePoint, 3> p{in_plane(facet, ground.a), in_plane(facet, ground.b),
                                in_plane(facet, ground.c)};
    const PlanePoint along = trace.to - trace.from;
    double low = 0.0, high = 1.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const PlanePoint edge = p[(k + 1) % 3] - p[k];
      const double at = cross(edge, trace.from - p[k]), change = cross(edge, along);
      // Share of twice the facet's area: rounding tolerance for points on the edge.
      constexpr double rounding = 1e-9;
      if (std::abs(change) < rounding) {
        if (at < -rounding) return false;
        continue;
      }
      if (change > 0.0) low = std::max(low, -at / change);
      if (change < 0.0) high = std::min(high, -at / change);
    }
    if (!(low < high)) return false;
    const PlanePoint from = trace.from;
    trace.from = from + low * along;
    trace.to = from + high * along;
    const double length =
        glm::length((trace.to.x - trace.from.x) * facet.a + (trace.to.y - trace.from.y) * facet.b);
    return length > touch_m && !along_edge(facet, touch_m, trace);
  }

  [[nodiscard]] static bool along_edge(const Facet& facet, double touch_m, const Trace& trace) {
    const double area = glm::length(glm::cross(facet.a, facet.b));
    // Heights above an edge of this length.
    const auto near = [&](double from, double to, double edge_m) {
      return std::max(std::abs(from), std::abs(to)) * area / edge_m <= 2.0 * touch_m;
    };
    const PlanePoint &p = trace.from, &q = trace.to;
    const double a = glm::length(facet.a), b = glm::length(facet.b);
    if (near(p.x, q.x, b) || near(p.y, q.y, a)) return true;
    if (facet.parallelogram) return near(1.0 - p.x, 1.0 - q.x, b) || near(1.0 - p.y, 1.0 - q.y, a);
    return near(1.0 - p.x - p.y, 1.0 - q.x - q.y, glm::length(facet.b - facet.a));
  }

  // Marks the one-sided walls of closed bodies.
  void mark_bodies() {
    if (of_bodies_.empty()) return;
    const ClosedParts parts = find_closed_parts(scene_);
    std::vector<double> volume(scene_.triangles.size(), 0.0);
    for (std::uint32_t t = 0; t < scene_.triangles.size(); ++t) {
      const std::uint32_t part = parts.of[t];
      if (parts.closed[part] == 0) continue;
      volume[part] += scenes::corners_of(scene_, t)
                          .seen_from(scene_.vertices[scene_.triangles[part].vertex[0]])
                          .triple_product();
    }
    for (const OneSided& wall : of_bodies_) {
      by_facet_[wall.facet][wall.trace].of_body = volume[parts.of[wall.triangle]] > 0.0;
    }
  }

  // Joins collinear traces that touch.
  void join_pieces(std::size_t f) {
    std::vector<Trace>& traces = by_facet_[f];
    if (traces.size() < 2) return;
    const Facet& facet = patches_.facets[f];
    const double touch_m = offsets_.contact(facet.triangle);
    const Vec3 x = glm::normalize(facet.a), y = glm::cross(facet.normal, x);
    struct Piece {
      Trace trace;
      double angle, height, from, to;
      bool operator<(const Piece& o) const {
        if (trace.of_body != o.trace.of_body) return trace.of_body < o.trace.of_body;
        if (angle != o.angle) return angle < o.angle;
        return height != o.height ? height < o.height : from < o.from;
      }
    };
    std::vector<Piece> pieces;
    for (Trace& t : traces) {
      Vec3 front = t.front;
      // Only a body covers one side. Other traces get a canonical orientation.
      const bool reversed = !t.of_body && (glm::dot(front, x) < -1e-9 ||
                                           (glm::dot(front, x) < 1e-9 && glm::dot(front, y) < 0.0));
      if (reversed) {
        front = -front;
        t.front = front;
        t.normal = -t.normal;
        t.reach = -t.reach;
      }
      const Vec3 along = glm::cross(facet.normal, front);
      const auto at = [&](const PlanePoint& p) { return p.x * facet.a + p.y * facet.b; };
      if (glm::dot(at(t.to) - at(t.from), along) < 0.0) std::swap(t.from, t.to);
      const double round = 1e-6;
      pieces.push_back({t, std::round(std::atan2(glm::dot(front, y), glm::dot(front, x)) / round),
                        std::round(glm::dot(front, at(0.5 * (t.from + t.to))) / (4.0 * touch_m)),
                        glm::dot(along, at(t.from)), glm::dot(along, at(t.to))});
    }
    std::sort(pieces.begin(), pieces.end());
    traces.clear();
    const Piece* last = nullptr;
    double end = 0.0;
    for (const Piece& piece : pieces) {
      const bool same = last != nullptr && last->trace.of_body == piece.trace.of_body &&
                        last->angle == piece.angle && last->height == piece.height &&
                        piece.from <= end + 2.0 * touch_m;
      if (!same) {
        traces.push_back(piece.trace);
        end = piece.to;
      } else if (piece.to > end) {
        traces.back().to = piece.trace.to;
        end = piece.to;
      }
      last = &piece;
    }
  }

  struct OneSided {
    std::uint32_t facet;
    std::size_t trace;
    std::uint32_t triangle;
  };

  const scenes::Scene& scene_;
  const Patches& patches_;
  scenes::SurfaceOffsets offsets_;
  std::vector<std::vector<Trace>> by_facet_;
  std::vector<OneSided> of_bodies_;
};

}  // namespace

Traces find_wall_traces(const scenes::Scene& scene, const Patches& patches) {
  return WallFinder(scene, patches).find();
}

}  // namespace earthshine::radiosity
