// SPDX-License-Identifier: Apache-2.0
#include "scenes/health/crossings.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

namespace earthshine::scenes {
namespace {

// Share of the scene's extent: resolution of single precision, in which most meshes are stored.
constexpr double tolerance_share = 2e-6;
constexpr std::size_t most_pairs = 50'000'000;
constexpr std::size_t leaf = 4;

struct Span {
  double low, high;
};

// Interval of a triangle on the common line of its plane and the other triangle's plane. distance:
// signed distances of the corners from the other plane, on both sides of the tolerance.
Span meets_plane(const std::array<Vec3, 3>& corner, const std::array<double, 3>& distance,
                 const Vec3& line) {
  Span span{1e300, -1e300};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const double from = distance[k], to = distance[next];
    if (from * to > 0.0 || from == to) continue;
    const Vec3 point = corner[k] + (from / (from - to)) * (corner[next] - corner[k]);
    const double at = glm::dot(line, point);
    span = {std::min(span.low, at), std::max(span.high, at)};
  }
  return span;
}

struct Plane {
  Vec3 normal;  // unit
  double offset;
};

Plane plane_of(const std::array<Vec3, 3>& corner) {
  const Vec3 normal = glm::normalize(glm::cross(corner[1] - corner[0], corner[2] - corner[0]));
  return {normal, glm::dot(normal, corner[0])};
}

std::array<double, 3> distances(const std::array<Vec3, 3>& corner, const Plane& plane) {
  std::array<double, 3> distance{};
  for (std::size_t k = 0; k < 3; ++k)
    distance[k] = glm::dot(plane.normal, corner[k]) - plane.offset;
  return distance;
}

// Whether corners lie on both sides.
bool on_both_sides(const std::array<double, 3>& distance, double tolerance) {
  const auto [low, high] = std::minmax_element(distance.begin(), distance.end());
  return *low<-tolerance&& * high> tolerance;
}

// Length of the line in which two triangles intersect, m; 0 without intersection.
double shared_line(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, double tolerance) {
  const Plane plane_b = plane_of(b);
  const auto a_from_b = distances(a, plane_b);
  if (!on_both_sides(a_from_b, tolerance)) return 0.0;
  const Plane plane_a = plane_of(a);
  const auto b_from_a = distances(b, plane_a);
  if (!on_both_sides(b_from_a, tolerance)) return 0.0;
  const Vec3 line = glm::cross(plane_a.normal, plane_b.normal);
  const double length = glm::length(line);
  if (!(length > 1e-9)) return 0.0;
  const Span on_a = meets_plane(a, a_from_b, line / length),
             on_b = meets_plane(b, b_from_a, line / length);
  const double shared = std::min(on_a.high, on_b.high) - std::max(on_a.low, on_b.low);
  return shared > tolerance ? shared : 0.0;
}

// A bounding-box tree over all triangles, in place.
class Tree {
 public:
  explicit Tree(const Scene& scene) : scene_(scene), order_(scene.triangles.size()) {
    for (std::uint32_t t = 0; t < order_.size(); ++t) {
      order_[t] = t;
      Box box;
      for (const std::uint32_t v : scene.triangles[t].vertex) box.add(scene.vertices[v]);
      boxes_.push_back(box);
    }
    if (!order_.empty()) build(0, order_.size());
  }

  // Calls visit(a, b) for pairs of different objects with overlapping boxes, until it returns
  // false.
  template <class Visit>
  void pairs(Visit visit) const {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> open{{0, 0}};
    while (!open.empty()) {
      const auto [m, n] = open.back();
      open.pop_back();
      const Node &a = nodes_[m], &b = nodes_[n];
      // Skips pairs of nodes of the same object.
      if (a.object == b.object && a.object != several) continue;
      if (!a.box.meets(b.box)) continue;
      if (a.second == 0 && b.second == 0) {
        for (std::size_t i = a.begin; i < a.end; ++i) {
          for (std::size_t j = m == n ? i + 1 : b.begin; j < b.end; ++j) {
            const std::uint32_t s = order_[i], t = order_[j];
            if (scene_.triangles[s].object == scene_.triangles[t].object) continue;
            if (boxes_[s].meets(boxes_[t]) && !visit(s, t)) return;
          }
        }
      } else if (m == n) {
        open.insert(open.end(), {{a.first, a.first}, {a.second, a.second}, {a.first, a.second}});
      } else if (b.second == 0 || (a.second != 0 && a.end - a.begin > b.end - b.begin)) {
        open.insert(open.end(), {{a.first, n}, {a.second, n}});
      } else {
        open.insert(open.end(), {{m, b.first}, {m, b.second}});
      }
    }
  }

 private:
  static constexpr std::uint32_t several = 0xFFFFFFFFU;
  struct Node {
    Box box;
    std::size_t begin, end;
    std::uint32_t first = 0, second = 0;  // 0: a leaf
    std::uint32_t object = several;       // if all its triangles have the same object
  };

  std::uint32_t build(std::size_t begin, std::size_t end) {
    Node node{{}, begin, end};
    Box middles;
    node.object = scene_.triangles[order_[begin]].object;
    for (std::size_t k = begin; k < end; ++k) {
      node.box.add(boxes_[order_[k]]);
      middles.add(boxes_[order_[k]].middle());
      if (scene_.triangles[order_[k]].object != node.object) node.object = several;
    }
    const auto number = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back(node);
    if (end - begin <= leaf) return number;
    const Vec3 size = middles.high - middles.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto middle = begin + (end - begin) / 2;
    const auto at = [&](std::size_t k) { return order_.begin() + static_cast<std::ptrdiff_t>(k); };
    std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t s, std::uint32_t t) {
      const double a = boxes_[s].middle()[axis], b = boxes_[t].middle()[axis];
      return a != b ? a < b : s < t;
    });
    const std::uint32_t first = build(begin, middle), second = build(middle, end);
    nodes_[number].first = first;
    nodes_[number].second = second;
    return number;
  }

  const Scene& scene_;
  std::vector<std::uint32_t> order_;
  std::vector<Box> boxes_;
  std::vector<Node> nodes_;
};

// Number of points on an object, distributed over its triangles.
constexpr std::size_t probes = 64;
constexpr std::size_t most_angles = 20'000'000;  // limit of all solid angles computed

// Bodies with coplanar faces have no crossing triangles, but one may be partly inside the other.
class Bodies {
 public:
  explicit Bodies(const Scene& scene) : scene_(scene) {
    for (const Object& object : scene.objects) boxes_.push_back(bounds_of(scene, object));
  }

  [[nodiscard]] bool boxes_overlap(std::uint32_t a, std::uint32_t b, double tolerance) const {
    return glm::all(glm::greaterThan(glm::min(boxes_[a].high, boxes_[b].high),
                                     glm::max(boxes_[a].low, boxes_[b].low) + tolerance));
  }

  // Whether part of `other` is inside the body and part outside. False if the body has no inside.
  [[nodiscard]] bool holds_part_of(std::uint32_t body, std::uint32_t other) {
    const Object &outer = scene_.objects[body], &inner = scene_.objects[other];
    const SurfaceHealth& surface = outer.surface;
    if (surface.parts != 1 || surface.closed_parts != 1) return false;
    std::size_t inside = 0, outside = 0;
    const std::size_t count = std::min<std::size_t>(probes, inner.triangle_count);
    for (std::size_t k = 0; k < count && angles_ < most_angles; ++k) {
      const auto t = static_cast<std::uint32_t>(k * inner.triangle_count / count);
      const auto [a, b, c] = corners_of(scene_, inner.first_triangle + t);
      const Vec3 middle = (a + b + c) / 3.0;
      double angle = 0.0;
      for (std::uint32_t n = 0; n < outer.triangle_count; ++n) {
        angle += corners_of(scene_, outer.first_triangle + n).seen_from(middle).solid_angle();
      }
      angles_ += outer.triangle_count;
      const double winding = std::abs(angle) / (4.0 * base::pi);
      inside += winding > 0.99 ? 1 : 0;
      outside += winding < 0.01 ? 1 : 0;
    }
    return inside > 0 && outside > 0;
  }
  [[nodiscard]] bool gave_up() const { return angles_ >= most_angles; }

 private:
  const Scene& scene_;
  std::vector<Box> boxes_;
  std::size_t angles_ = 0;
};

}  // namespace

Crossings find_crossings(const Scene& scene) {
  Crossings found;
  if (scene.triangles.empty()) return found;
  const double tolerance = tolerance_share * box_around(scene.vertices).diagonal();
  struct Pair {
    std::set<std::uint32_t> triangles;
    double line_m = 0.0;
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, Pair> pairs;
  std::size_t looked_at = 0;
  const auto corners = [&](std::uint32_t t) {
    const auto [a, b, c] = corners_of(scene, t);
    return std::array{a, b, c};
  };
  Tree(scene).pairs([&](std::uint32_t s, std::uint32_t t) {
    if (++looked_at > most_pairs) {
      found.complete = false;
      return false;
    }
    const double line_m = shared_line(corners(s), corners(t), tolerance);
    if (line_m <= 0.0) return true;
    Pair& pair = pairs[std::minmax(scene.triangles[s].object, scene.triangles[t].object)];
    pair.triangles.insert({s, t});
    pair.line_m += line_m;
    return true;
  });
  Bodies bodies(scene);
  for (std::uint32_t a = 0; a < scene.objects.size() && !bodies.gave_up(); ++a) {
    for (std::uint32_t b = a + 1; b < scene.objects.size() && !bodies.gave_up(); ++b) {
      if (!bodies.boxes_overlap(a, b, tolerance) || pairs.contains({a, b})) continue;
      if (bodies.holds_part_of(a, b) || bodies.holds_part_of(b, a)) {
        pairs[{a, b}] = {};
      }
    }
  }
  found.complete = found.complete && !bodies.gave_up();
  for (const auto& [objects, pair] : pairs) {
    found.pairs.push_back({objects.first, objects.second, pair.triangles.size(), pair.line_m});
  }
  return found;
}

}  // namespace earthshine::scenes
