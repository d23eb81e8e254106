// SPDX-License-Identifier: Apache-2.0
#include "scenes/health/topology.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

namespace earthshine::scenes {
namespace {

struct EdgeUse {
  std::uint32_t low, high, triangle;  // the triangle counted from the object's first
  bool rising;                        // from low to high
  [[nodiscard]] auto edge() const { return std::tie(low, high); }
};

// Sets of triangles, each with whether it is wound against the first of its set.
class Winding {
 public:
  explicit Winding(std::size_t count) : parent_(count), against_(count, 0) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }
  struct Place {
    std::uint32_t root;
    char against;
  };
  [[nodiscard]] Place find(std::uint32_t t) {
    std::uint32_t root = t;
    char against = 0;
    while (parent_[root] != root) {
      against = static_cast<char>(against ^ against_[root]);
      root = parent_[root];
    }
    // Paths are made short, or a strip of a million triangles takes a million steps each.
    char rest = against;
    while (parent_[t] != root && t != root) {
      const std::uint32_t next = parent_[t];
      const auto own = static_cast<char>(rest ^ against_[t]);
      parent_[t] = root;
      against_[t] = rest;
      rest = own;
      t = next;
    }
    return {root, against};
  }
  // Whether that agrees with what is known already.
  bool unite(std::uint32_t a, std::uint32_t b, bool against) {
    const Place pa = find(a), pb = find(b);
    const auto apart = static_cast<char>(pa.against ^ pb.against ^ static_cast<char>(against));
    if (pa.root == pb.root) return apart == 0;
    parent_[std::max(pa.root, pb.root)] = std::min(pa.root, pb.root);
    against_[std::max(pa.root, pb.root)] = apart;
    return true;
  }

 private:
  std::vector<std::uint32_t> parent_;
  std::vector<char> against_;
};

std::vector<EdgeUse> edge_uses(const Scene& scene, const Object& object,
                               std::span<const std::uint32_t> ids) {
  std::vector<EdgeUse> uses;
  uses.reserve(std::size_t{3} * object.triangle_count);
  for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
    const Triangle& triangle = scene.triangles[object.first_triangle + t];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = ids[triangle.vertex[k]], b = ids[triangle.vertex[(k + 1) % 3]];
      if (a != b) uses.push_back({std::min(a, b), std::max(a, b), t, a < b});
    }
  }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  return uses;
}

// Turns the part's orientation to that of most of its area and measures it.
void measure(const Scene& scene, SurfacePart& part) {
  double kept = 0.0, turned = 0.0;
  part.low = part.high = scene.vertices[scene.triangles[part.triangles.front()].vertex[0]];
  const Vec3 origin = part.low;
  for (std::size_t k = 0; k < part.triangles.size(); ++k) {
    const auto& v = scene.triangles[part.triangles[k]].vertex;
    const Vec3 a = scene.vertices[v[0]] - origin, b = scene.vertices[v[1]] - origin,
               c = scene.vertices[v[2]] - origin;
    (part.turned[k] != 0 ? turned : kept) += glm::length(glm::cross(b - a, c - a));
    part.volume_m3 += (part.turned[k] != 0 ? -1.0 : 1.0) * glm::dot(a, glm::cross(b, c)) / 6.0;
    for (const std::uint32_t corner : v) {
      part.low = glm::min(part.low, scene.vertices[corner]);
      part.high = glm::max(part.high, scene.vertices[corner]);
    }
  }
  if (turned <= kept) return;
  for (char& t : part.turned) t = t == 0 ? 1 : 0;
  part.volume_m3 = -part.volume_m3;
}

}  // namespace

std::vector<std::uint32_t> welded(std::span<const Vec3> vertices) {
  std::vector<std::uint32_t> order(vertices.size()), id(vertices.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto key = [&](std::uint32_t v) {
    return std::tie(vertices[v].x, vertices[v].y, vertices[v].z);
  };
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool same = k > 0 && key(order[k - 1]) == key(order[k]);
    id[order[k]] = same ? id[order[k - 1]] : order[k];
  }
  return id;
}

std::vector<SurfacePart> surface_parts(const Scene& scene, const Object& object,
                                       std::span<const std::uint32_t> ids) {
  const std::vector<EdgeUse> uses = edge_uses(scene, object, ids);
  Winding winding(object.triangle_count);
  std::vector<std::uint32_t> torn;  // a triangle of each edge that contradicts
  for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
    while (end < uses.size() && uses[end].edge() == uses[begin].edge()) ++end;
    if (end - begin != 2) continue;
    const EdgeUse &a = uses[begin], &b = uses[begin + 1];
    if (!winding.unite(a.triangle, b.triangle, a.rising == b.rising)) torn.push_back(a.triangle);
  }
  std::map<std::uint32_t, std::size_t> number;
  std::vector<SurfacePart> parts;
  for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
    const auto [root, against] = winding.find(t);
    const auto [entry, fresh] = number.emplace(root, parts.size());
    if (fresh) parts.emplace_back();
    parts[entry->second].triangles.push_back(object.first_triangle + t);
    parts[entry->second].turned.push_back(against);
  }
  const auto part_of = [&](std::uint32_t t) -> SurfacePart& {
    return parts[number.at(winding.find(t).root)];
  };
  for (const std::uint32_t t : torn) part_of(t).orientable = false;
  for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
    while (end < uses.size() && uses[end].edge() == uses[begin].edge()) ++end;
    const std::size_t count = end - begin;
    if (count > 2) ++part_of(uses[begin].triangle).crowded_edges;
    if (count == 1) ++part_of(uses[begin].triangle).open_edges;
    for (std::size_t k = begin; count > 2 && k < end; ++k) {
      part_of(uses[k].triangle).crowded = true;
    }
    if (count == 2 && uses[begin].rising == uses[begin + 1].rising) {
      ++part_of(uses[begin].triangle).mixed_edges;
    }
  }
  for (SurfacePart& part : parts) measure(scene, part);
  return parts;
}

double solid_angle_of(const Scene& scene, const SurfacePart& part, const Vec3& point) {
  if (glm::any(glm::lessThan(point, part.low)) || glm::any(glm::greaterThan(point, part.high))) {
    return 0.0;
  }
  double angle = 0.0;
  for (std::size_t k = 0; k < part.triangles.size(); ++k) {
    const auto& v = scene.triangles[part.triangles[k]].vertex;
    const Vec3 a = scene.vertices[v[0]] - point, b = scene.vertices[v[1]] - point,
               c = scene.vertices[v[2]] - point;
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    const double over = glm::dot(a, glm::cross(b, c));
    const double under =
        la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
    angle += (part.turned[k] != 0 ? -2.0 : 2.0) * std::atan2(over, under);
  }
  return std::abs(angle);
}

}  // namespace earthshine::scenes
