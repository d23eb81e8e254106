// SPDX-License-Identifier: Apache-2.0
#include "scenes/health/topology.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>

#include "base/numbers/random.h"
#include "scenes/triangle_point.h"

namespace earthshine::scenes {
namespace {

// Union-find of triangles with relative winding.
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
    // Path compression: without it a strip of a million triangles takes a million steps per search.
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
  // Returns whether this agrees with earlier unions.
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

// The edges of an object with the triangles that use them.
class Edges {
 public:
  // A triangle, as an offset from the object's first, and whether it runs from the edge's lower
  // vertex to the higher one. Packed into integers for fast sorting by edge and triangle.
  class Use {
   public:
    Use() = default;
    Use(std::uint32_t high, std::uint32_t triangle, bool rising)
        : packed_(std::uint64_t{high} << 32U | std::uint64_t{triangle} << 1U | (rising ? 1U : 0U)) {
    }
    [[nodiscard]] std::uint32_t triangle() const {
      return static_cast<std::uint32_t>(packed_ & 0xFFFFFFFFU) >> 1U;
    }
    [[nodiscard]] bool rising() const { return (packed_ & 1U) != 0; }
    [[nodiscard]] std::uint64_t high() const { return packed_ >> 32U; }
    bool operator<(const Use& other) const { return packed_ < other.packed_; }

   private:
    std::uint64_t packed_ = 0;
  };

  Edges(const Scene& scene, const Object& object, std::span<const std::uint32_t> ids) {
    const auto each_use = [&](const auto& take) {
      for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
        const auto& v = scene.triangles[object.first_triangle + t].vertex;
        const std::array<std::uint32_t, 3> id{ids[v[0]], ids[v[1]], ids[v[2]]};
        for (std::size_t k = 0; k < 3; ++k) {
          const std::uint32_t a = id[k], b = id[(k + 1) % 3];
          if (a != b) take(std::min(a, b), Use(std::max(a, b), t, a < b));
        }
      }
    };
    std::uint32_t lowest = 0xFFFFFFFFU, highest = 0;
    std::size_t count = 0;
    each_use([&](std::uint32_t low, const Use&) {
      lowest = std::min(lowest, low);
      highest = std::max(highest, low);
      ++count;
    });
    if (count == 0) return;
    std::vector<std::uint32_t> lows;  // for a small object on vertices of a large one
    const bool sparse = std::size_t{highest} - lowest > 8 * count;
    if (sparse) {
      each_use([&](std::uint32_t low, const Use&) { lows.push_back(low); });
      std::sort(lows.begin(), lows.end());
      lows.erase(std::unique(lows.begin(), lows.end()), lows.end());
    }
    const auto place_of = [&](std::uint32_t low) -> std::size_t {
      if (!sparse) return low - lowest;
      return static_cast<std::size_t>(std::lower_bound(lows.begin(), lows.end(), low) -
                                      lows.begin());
    };
    // Bucket sort by the lower vertex; each bucket is small.
    end_.assign(place_of(highest) + 2, 0);
    each_use([&](std::uint32_t low, const Use&) { ++end_[place_of(low) + 1]; });
    std::partial_sum(end_.begin(), end_.end(), end_.begin());
    uses_.resize(count);
    each_use([&](std::uint32_t low, const Use& use) { uses_[end_[place_of(low)]++] = use; });
    end_.pop_back();
    std::uint32_t begin = 0;
    for (const std::uint32_t end : end_) {
      std::sort(uses_.begin() + begin, uses_.begin() + end);
      begin = end;
    }
  }

  // Calls take(uses) for each edge.
  template <class Take>
  void each(const Take& take) const {
    std::uint32_t begin = 0;
    for (const std::uint32_t end : end_) {
      while (begin < end) {
        std::uint32_t next = begin + 1;
        while (next < end && uses_[next].high() == uses_[begin].high()) ++next;
        take(std::span<const Use>(uses_.data() + begin, next - begin));
        begin = next;
      }
    }
  }

 private:
  std::vector<std::uint32_t> end_;  // end of the uses at each lower vertex
  std::vector<Use> uses_;
};

// Sets the part's orientation to that with the larger area and measures it.
void measure(const Scene& scene, SurfacePart& part) {
  double kept = 0.0, flipped = 0.0;
  part.low = part.high = scene.vertices[scene.triangles[part.triangles.front()].vertex[0]];
  const Vec3 origin = part.low;
  for (std::size_t k = 0; k < part.triangles.size(); ++k) {
    const Corners at = corners_of(scene, part.triangles[k]).seen_from(origin);
    (part.flipped[k] != 0 ? flipped : kept) += glm::length(at.normal());
    part.volume_m3 += (part.flipped[k] != 0 ? -1.0 : 1.0) * at.triple_product() / 6.0;
    for (const std::uint32_t corner : scene.triangles[part.triangles[k]].vertex) {
      part.low = glm::min(part.low, scene.vertices[corner]);
      part.high = glm::max(part.high, scene.vertices[corner]);
    }
  }
  if (flipped <= kept) return;
  for (char& t : part.flipped) t = t == 0 ? 1 : 0;
  part.volume_m3 = -part.volume_m3;
}

}  // namespace

std::vector<std::uint32_t> welded(std::span<const Vec3> vertices) {
  // Hash table of the first vertex at each position, at most half full.
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
  const Edges edges(scene, object, ids);
  using Uses = std::span<const Edges::Use>;
  Winding winding(object.triangle_count);
  std::vector<std::uint32_t> torn;  // one triangle of each contradicting edge
  edges.each([&](Uses uses) {
    if (uses.size() != 2) return;
    const std::uint32_t a = uses[0].triangle(), b = uses[1].triangle();
    if (!winding.unite(a, b, uses[0].rising() == uses[1].rising())) torn.push_back(a);
  });
  std::vector<std::uint32_t> number(object.triangle_count);  // part of each triangle
  std::vector<SurfacePart> parts;
  for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
    const auto [root, against] = winding.find(t);
    if (root == t) {  // the part's first triangle
      number[t] = static_cast<std::uint32_t>(parts.size());
      parts.emplace_back();
    }
    number[t] = number[root];
    parts[number[t]].triangles.push_back(object.first_triangle + t);
    parts[number[t]].flipped.push_back(against);
  }
  const auto part_of = [&](std::uint32_t t) -> SurfacePart& { return parts[number[t]]; };
  for (const std::uint32_t t : torn) part_of(t).orientable = false;
  edges.each([&](Uses uses) {
    SurfacePart& part = part_of(uses[0].triangle());
    if (uses.size() == 1) ++part.open_edges;
    if (uses.size() == 2 && uses[0].rising() == uses[1].rising()) ++part.mixed_edges;
    if (uses.size() <= 2) return;
    ++part.crowded_edges;
    for (const Edges::Use& use : uses) part_of(use.triangle()).crowded = true;
  });
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
    angle += part.flipped[k] != 0 ? -own : own;
  }
  return std::abs(angle);
}

}  // namespace earthshine::scenes
