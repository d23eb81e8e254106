// SPDX-License-Identifier: Apache-2.0
#include "radiosity/bodies/closed_parts.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <span>

#include "scenes/health/topology.h"
#include "scenes/triangle_point.h"

namespace earthshine::radiosity {
namespace {

constexpr std::uint32_t no_triangle = 0xFFFFFFFFU;

struct EdgeUse {
  std::uint32_t low, high, object, triangle;
  int sign;  // 1 from low to high, else -1
  [[nodiscard]] std::uint64_t edge() const { return (std::uint64_t{low} << 32U) | high; }
  [[nodiscard]] std::uint64_t face() const { return (std::uint64_t{object} << 32U) | triangle; }
};

constexpr double touch_share = 1e-6;  // of the scene's diagonal
constexpr double flat = 1e-6;         // tolerance of cosines for coplanar faces

using Rim = std::span<const ClosedParts::RimEdge>;

class Stopper {
 public:
  Stopper(const scenes::Scene& scene, const ClosedParts& parts) : scene_(scene), parts_(parts) {
    Vec3 low(std::numeric_limits<double>::infinity()), high = -low;
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
      const auto [a, b, c] = corners_of(scene, t);
      low = glm::min(low, glm::min(a, glm::min(b, c)));
      high = glm::max(high, glm::max(a, glm::max(b, c)));
      normals_.push_back(glm::cross(b - a, c - a));
      const double length = glm::length(normals_.back());
      if (length > 0.0) normals_.back() /= length;
    }
    touch_m_ = touch_share * glm::length(high - low);
  }

  // Triangles that close the hole; empty if it is open.
  [[nodiscard]] std::vector<Vec3> close(Rim rim) const {
    const Vec3 hub = at(rim.front().from);
    std::vector<Vec3> cap;
    Vec3 outward(0.0);  // twice the cap's area
    for (const auto& edge : rim) {
      const Vec3 from = at(edge.from), to = at(edge.to);
      cap.insert(cap.end(), {hub, to, from});
      outward += glm::cross(to - hub, from - hub);
    }
    const double area = glm::length(outward);
    if (!(area > touch_m_ * touch_m_)) return {};
    outward /= area;
    if (!is_flat(rim, hub, outward)) return {};
    const std::vector<std::uint32_t> grounds = touching(rim.front().part, hub, outward);
    if (grounds.empty()) return {};
    for (const auto& edge : rim) {
      const Vec3 from = at(edge.from), middle = 0.5 * (from + at(edge.to));
      if (!rests(grounds, from) || !rests(grounds, middle)) return {};
    }
    return cap;
  }

 private:
  [[nodiscard]] Vec3 at(std::uint32_t vertex) const { return scene_.vertices[vertex]; }

  [[nodiscard]] bool is_flat(Rim rim, const Vec3& hub, const Vec3& normal) const {
    return std::all_of(rim.begin(), rim.end(), [&](const auto& edge) {
      return std::abs(glm::dot(at(edge.from) - hub, normal)) <= touch_m_;
    });
  }

  // Triangles of other parts in the hole's plane that face it.
  [[nodiscard]] std::vector<std::uint32_t> touching(std::uint32_t part, const Vec3& hub,
                                                    const Vec3& outward) const {
    std::vector<std::uint32_t> found;
    for (std::uint32_t t = 0; t < normals_.size(); ++t) {
      if (glm::dot(normals_[t], outward) > flat - 1.0 || parts_.of[t] == part) continue;
      if (std::abs(glm::dot(corners_of(scene_, t).a - hub, normals_[t])) > touch_m_) continue;
      const scenes::Material& material = scene_.materials[scene_.triangles[t].material];
      if (material.two_sided || material.lets_light_through()) continue;
      found.push_back(t);
    }
    return found;
  }

  [[nodiscard]] bool rests(const std::vector<std::uint32_t>& grounds, const Vec3& p) const {
    return std::any_of(grounds.begin(), grounds.end(), [&](std::uint32_t t) {
      const auto [a, b, c] = corners_of(scene_, t);
      const auto inside_of = [&](const Vec3& from, const Vec3& to) {
        const Vec3 offset = to - from;
        const double aside = glm::dot(glm::cross(offset, p - from), normals_[t]);
        return aside >= -touch_m_ * glm::length(offset);
      };
      return inside_of(a, b) && inside_of(b, c) && inside_of(c, a);
    });
  }

  const scenes::Scene& scene_;
  const ClosedParts& parts_;
  std::vector<Vec3> normals_;
  double touch_m_ = 0.0;
};

// Sorts the uses of all edges by edge, object and triangle.
void sort_by_edge(std::vector<EdgeUse>& uses, std::size_t vertices) {
  // Bucket sort by the lower vertex: each bucket has a handful of edges.
  std::vector<std::uint32_t> first(vertices + 1, 0);
  for (const EdgeUse& use : uses) ++first[use.low + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<EdgeUse> sorted(uses.size());
  std::vector<std::uint32_t> next = first;
  for (const EdgeUse& use : uses) sorted[next[use.low]++] = use;
  for (std::size_t v = 0; v < vertices; ++v) {
    std::sort(sorted.begin() + first[v], sorted.begin() + first[v + 1],
              [](const EdgeUse& a, const EdgeUse& b) {
                return a.high != b.high ? a.high < b.high : a.face() < b.face();
              });
  }
  uses.swap(sorted);
}

// Of opaque one-sided faces, sorted.
std::vector<EdgeUse> edge_uses(const scenes::Scene& scene, const std::vector<char>& left_out) {
  std::vector<std::uint32_t> id;
  std::vector<EdgeUse> uses;
  uses.reserve(3 * scene.triangles.size());
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    const scenes::Triangle& triangle = scene.triangles[t];
    const scenes::Material& material = scene.materials[triangle.material];
    if (material.two_sided || material.lets_light_through()) continue;
    if (!left_out.empty() && left_out[triangle.object] != 0) continue;
    if (id.empty()) id = scenes::welded(scene.vertices);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = id[triangle.vertex[k]], b = id[triangle.vertex[(k + 1) % 3]];
      if (a != b)
        uses.push_back({std::min(a, b), std::max(a, b), triangle.object, t, a < b ? 1 : -1});
    }
  }
  sort_by_edge(uses, id.size());
  return uses;
}

}  // namespace

ClosedParts find_closed_parts(const scenes::Scene& scene, const std::vector<char>& left_out) {
  const std::vector<EdgeUse> uses = edge_uses(scene, left_out);
  ClosedParts parts;
  parts.of.resize(scene.triangles.size());
  std::iota(parts.of.begin(), parts.of.end(), 0U);
  const auto root = [&](std::uint32_t t) {
    while (parts.of[t] != t) t = parts.of[t] = parts.of[parts.of[t]];
    return t;
  };
  const auto unite = [&](std::uint32_t a, std::uint32_t b) {
    const std::uint32_t ra = root(a), rb = root(b);
    parts.of[std::max(ra, rb)] = std::min(ra, rb);
  };
  for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
    // If an object's own faces are closed at this edge, they are connected without the others: a
    // box in the corner of a room is no part of the room.
    int net = 0;
    std::uint32_t loose = no_triangle;
    while (end < uses.size() && uses[end].edge() == uses[begin].edge()) {
      const std::size_t first = end;
      int own = 0;
      for (; end < uses.size() && uses[end].edge() == uses[begin].edge() &&
             uses[end].object == uses[first].object;
           ++end) {
        own += uses[end].sign;
        unite(uses[first].triangle, uses[end].triangle);
      }
      if (own == 0) continue;
      net += own;
      if (loose != no_triangle) unite(loose, uses[first].triangle);
      loose = uses[first].triangle;
    }
    const auto& [low, high, object, triangle, sign] = uses[begin];
    for (int k = 0; k < std::abs(net); ++k) {
      parts.rims.push_back({loose, net > 0 ? low : high, net > 0 ? high : low});
    }
  }
  parts.closed.assign(parts.of.size(), 0);
  for (const EdgeUse& use : uses) parts.closed[root(use.triangle)] = 1;
  for (ClosedParts::RimEdge& edge : parts.rims) {
    edge.part = root(edge.part);
    parts.closed[edge.part] = 0;
  }
  std::stable_sort(parts.rims.begin(), parts.rims.end(),
                   [](const auto& a, const auto& b) { return a.part < b.part; });
  for (std::uint32_t t = 0; t < parts.of.size(); ++t) parts.of[t] = root(t);
  return parts;
}

std::map<std::uint32_t, std::vector<Vec3>> find_stoppers(const scenes::Scene& scene,
                                                         const ClosedParts& parts) {
  std::map<std::uint32_t, std::vector<Vec3>> stoppers;
  if (parts.rims.empty()) return stoppers;
  const Stopper stopper(scene, parts);
  for (auto begin = parts.rims.begin(); begin != parts.rims.end();) {
    const auto end = std::find_if(begin, parts.rims.end(),
                                  [&](const auto& edge) { return edge.part != begin->part; });
    std::vector<Vec3> cap = stopper.close({begin, end});
    if (!cap.empty()) stoppers.emplace(begin->part, std::move(cap));
    begin = end;
  }
  return stoppers;
}

}  // namespace earthshine::radiosity
