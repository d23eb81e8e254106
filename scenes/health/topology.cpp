// SPDX-License-Identifier: Apache-2.0
#include "scenes/health/topology.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <tuple>

#include "base/numbers/random.h"
#include "scenes/triangle_point.h"

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
  const auto each = [&](const auto& take) {
    for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
      const Triangle& triangle = scene.triangles[object.first_triangle + t];
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = ids[triangle.vertex[k]], b = ids[triangle.vertex[(k + 1) % 3]];
        if (a != b) take(EdgeUse{std::min(a, b), std::max(a, b), t, a < b});
      }
    }
  };
  const auto in_order = [](const EdgeUse& a, const EdgeUse& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  };
  std::uint32_t lowest = 0xFFFFFFFFU, highest = 0;
  std::size_t count = 0;
  each([&](const EdgeUse& use) {
    lowest = std::min(lowest, use.low);
    highest = std::max(highest, use.low);
    ++count;
  });
  if (count == 0) return {};
  const std::size_t places = std::size_t{highest} - lowest + 1;
  if (places > 8 * count) {  // a small object on vertices of a large one
    std::vector<EdgeUse> uses;
    uses.reserve(count);
    each([&](const EdgeUse& use) { uses.push_back(use); });
    std::sort(uses.begin(), uses.end(), in_order);
    return uses;
  }
  // Each goes to the place of its lower vertex; there are few at any.
  std::vector<std::uint32_t> next(places + 1, 0);
  each([&](const EdgeUse& use) { ++next[use.low - lowest + 1]; });
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<EdgeUse> uses(next.back());
  each([&](const EdgeUse& use) { uses[next[use.low - lowest]++] = use; });
  for (auto begin = uses.begin(), end = begin; begin != uses.end(); begin = end) {
    while (end != uses.end() && end->low == begin->low) ++end;
    std::sort(begin, end, in_order);
  }
  return uses;
}

// Turns the part's orientation to that of most of its area and measures it.
void measure(const Scene& scene, SurfacePart& part) {
  double kept = 0.0, turned = 0.0;
  part.low = part.high = scene.vertices[scene.triangles[part.triangles.front()].vertex[0]];
  const Vec3 origin = part.low;
  for (std::size_t k = 0; k < part.triangles.size(); ++k) {
    const Corners at = corners_of(scene, part.triangles[k]).seen_from(origin);
    (part.turned[k] != 0 ? turned : kept) += glm::length(at.normal());
    part.volume_m3 += (part.turned[k] != 0 ? -1.0 : 1.0) * at.triple_product() / 6.0;
    for (const std::uint32_t corner : scene.triangles[part.triangles[k]].vertex) {
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
  // A table of the first vertex at each place, at most half full.
  constexpr std::uint32_t empty = 0xFFFFFFFFU;
  const std::size_t slots = std::bit_ceil(2 * vertices.size() + 1);
  std::vector<std::uint32_t> table(slots, empty), id(vertices.size());
  for (std::uint32_t v = 0; v < vertices.size(); ++v) {
    std::uint64_t hash = 0;
    for (int c = 0; c < 3; ++c) {
      hash = base::mix64(hash ^ std::bit_cast<std::uint64_t>(vertices[v][c] + 0.0));  // -0 is 0
    }
    std::size_t at = hash & (slots - 1);
    while (table[at] != empty && vertices[table[at]] != vertices[v]) at = (at + 1) & (slots - 1);
    if (table[at] == empty) table[at] = v;
    id[v] = table[at];
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
  std::vector<std::uint32_t> number(object.triangle_count);  // of the part
  std::vector<SurfacePart> parts;
  for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
    const auto [root, against] = winding.find(t);
    if (root == t) {  // the part's first triangle
      number[t] = static_cast<std::uint32_t>(parts.size());
      parts.emplace_back();
    }
    number[t] = number[root];
    parts[number[t]].triangles.push_back(object.first_triangle + t);
    parts[number[t]].turned.push_back(against);
  }
  const auto part_of = [&](std::uint32_t t) -> SurfacePart& { return parts[number[t]]; };
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
    const double own = corners_of(scene, part.triangles[k]).seen_from(point).solid_angle();
    angle += part.turned[k] != 0 ? -own : own;
  }
  return std::abs(angle);
}

}  // namespace earthshine::scenes
