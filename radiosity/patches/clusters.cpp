// SPDX-License-Identifier: Apache-2.0
#include "radiosity/patches/clusters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "scenes/health/topology.h"
#include "scenes/ray_query.h"

namespace earthshine::radiosity {
namespace {

constexpr float normal_span = 0.19F;
constexpr double crease_cosine = 0.92388;
// A deeper tree would leave too few digits of the parameter for the triangles themselves.
constexpr std::size_t many_patches = std::size_t{1} << 16;

// A small triangle: its centre in units of the wanted edge, and its normal in units of the span.
struct Small {
  std::array<float, 6> at;
  std::uint32_t triangle;
};

using Range = std::pair<std::size_t, std::size_t>;

// The axis with the largest range, and its lower bound.
struct Longest {
  std::size_t axis;
  float low, extent;
};
Longest longest(const std::vector<Small>& all, const Range& range) {
  std::array<float, 6> low = all[range.first].at, high = low;
  for (std::size_t k = range.first + 1; k < range.second; ++k) {
    for (std::size_t axis = 0; axis < 6; ++axis) {
      low[axis] = std::min(low[axis], all[k].at[axis]);
      high[axis] = std::max(high[axis], all[k].at[axis]);
    }
  }
  Longest found{0, low[0], high[0] - low[0]};
  for (std::size_t axis = 1; axis < 6; ++axis) {
    const float extent = high[axis] - low[axis];
    if (extent > found.extent) found = {axis, low[axis], extent};
  }
  return found;
}

// Connected regions of small triangles.
class Regions {
 public:
  Regions(const scenes::Scene& scene, double edge_m) : scene_(scene) {
    std::vector<char> fits;
    for (const scenes::Material& m : scene.materials) {
      fits.push_back(!m.passes_light_on() && !m.lets_light_through() ? 1 : 0);
    }
    const double most_m2 = 2.0 * edge_m * edge_m;  // half of a square with this edge
    const scenes::CoincidentFaces coincident(scene);
    const auto is_covered = [&](std::uint32_t t) {
      return coincident.is_covered(t, true) || coincident.is_covered(t, false);
    };
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
      if (fits[scene.triangles[t].material] == 0 || is_covered(t)) continue;
      const auto [a, b, c] = corners(t);
      const Vec3 ab = b - a, bc = c - b, ca = a - c;
      if (std::max({glm::dot(ab, ab), glm::dot(bc, bc), glm::dot(ca, ca)}) > most_m2) continue;
      const Vec3 middle = (a + b + c) / (3.0 * edge_m);
      const Vec3 normal = glm::normalize(glm::cross(ab, -ca)) / double(normal_span);
      all_.push_back({{float(middle.x), float(middle.y), float(middle.z), float(normal.x),
                       float(normal.y), float(normal.z)},
                      t});
    }
  }

  // Sorts triangles by region and returns the ranges.
  [[nodiscard]] std::vector<Range> sort() {
    std::vector<Range> ranges;
    if (all_.size() < 2) return ranges;
    find_parts();
    std::vector<std::size_t> next(all_.size() + 1, 0);
    for (std::uint32_t k = 0; k < all_.size(); ++k) ++next[root(k) + 1];
    std::partial_sum(next.begin(), next.end(), next.begin());
    for (std::size_t k = 0; k + 1 < next.size(); ++k) {
      if (next[k + 1] - next[k] > 1) ranges.emplace_back(next[k], next[k + 1]);
    }
    std::vector<Small> sorted(all_.size());
    for (std::uint32_t k = 0; k < all_.size(); ++k) sorted[next[root(k)]++] = all_[k];
    all_ = std::move(sorted);
    return ranges;
  }
  [[nodiscard]] std::vector<Small> take() { return std::move(all_); }

 private:
  [[nodiscard]] std::array<Vec3, 3> corners(std::uint32_t t) const {
    const auto& v = scene_.triangles[t].vertex;
    return {scene_.vertices[v[0]], scene_.vertices[v[1]], scene_.vertices[v[2]]};
  }
  std::uint32_t root(std::uint32_t k) {
    while (parent_[k] != k) k = parent_[k] = parent_[parent_[k]];
    return k;
  }
  [[nodiscard]] bool together(const Small& a, const Small& b) const {
    const scenes::Triangle &ta = scene_.triangles[a.triangle], &tb = scene_.triangles[b.triangle];
    if (ta.object != tb.object || ta.material != tb.material) return false;
    double cosine = 0.0;
    for (std::size_t axis = 3; axis < 6; ++axis) cosine += double(a.at[axis]) * double(b.at[axis]);
    return cosine * double(normal_span) * double(normal_span) >= crease_cosine;
  }

  // Buckets edges by their lower vertex; each lists triangles with the other vertex.
  void find_parts() {
    parent_.resize(all_.size());
    std::iota(parent_.begin(), parent_.end(), 0U);
    const std::vector<std::uint32_t> id = scenes::welded(scene_.vertices);
    struct Use {
      std::uint32_t high, small;
    };
    const auto each_edge = [&](const auto& take) {
      for (std::uint32_t k = 0; k < all_.size(); ++k) {
        const auto& v = scene_.triangles[all_[k].triangle].vertex;
        for (std::size_t e = 0; e < 3; ++e) {
          const auto [low, high] = std::minmax(id[v[e]], id[v[(e + 1) % 3]]);
          take(low, Use{high, k});
        }
      }
    };
    std::vector<std::size_t> start(scene_.vertices.size() + 1, 0);
    each_edge([&](std::uint32_t low, const Use&) { ++start[low + 1]; });
    std::partial_sum(start.begin(), start.end(), start.begin());
    std::vector<Use> uses(start.back());
    std::vector<std::size_t> next(start.begin(), start.end() - 1);
    each_edge([&](std::uint32_t low, const Use& use) { uses[next[low]++] = use; });
    for (std::size_t v = 0; v + 1 < start.size(); ++v) {
      std::sort(uses.begin() + std::ptrdiff_t(start[v]),
                uses.begin() + std::ptrdiff_t(start[v + 1]), [](const Use& a, const Use& b) {
                  return a.high != b.high ? a.high < b.high : a.small < b.small;
                });
      for (std::size_t a = start[v]; a < start[v + 1]; ++a) {
        for (std::size_t b = a + 1; b < start[v + 1] && uses[b].high == uses[a].high; ++b) {
          if (!together(all_[uses[a].small], all_[uses[b].small])) continue;
          const std::uint32_t ra = root(uses[a].small), rb = root(uses[b].small);
          parent_[std::max(ra, rb)] = std::min(ra, rb);
        }
      }
    }
  }

  const scenes::Scene& scene_;
  std::vector<Small> all_;
  std::vector<std::uint32_t> parent_;
};

// Divides the range into clusters: into as many equal intervals as it has wanted edges, half of
// them on each side.
void part(std::vector<Small>& all, const Range& range, std::vector<Range>& clusters) {
  const std::size_t count = range.second - range.first;
  if (count < 2) return;
  const Longest of = longest(all, range);
  const float lengths = std::ceil(of.extent - 1e-4F);
  const bool many = count > many_patches;
  if (lengths <= 1.0F && !many) return clusters.push_back(range);
  const float parts = std::max(lengths, 2.0F);
  const float middle = of.low + of.extent * std::floor(0.5F * parts) / parts;
  const auto begin = all.begin() + std::ptrdiff_t(range.first),
             end = all.begin() + std::ptrdiff_t(range.second);
  auto at = std::partition(begin, end, [&](const Small& s) { return s.at[of.axis] < middle; });
  // Many triangles at one place.
  if (at == begin || at == end) at = begin + std::ptrdiff_t(count / 2);
  const auto cut = static_cast<std::size_t>(at - all.begin());
  part(all, {range.first, cut}, clusters);
  part(all, {cut, range.second}, clusters);
}

// Orders the range down to single triangles, by halves.
void order(std::vector<Small>& all, const Range& range) {
  const std::size_t count = range.second - range.first;
  if (count < 3) return;
  const std::size_t axis = longest(all, range).axis;
  const std::size_t middle = range.first + count / 2;
  const auto at = [&](std::size_t k) { return all.begin() + std::ptrdiff_t(k); };
  std::nth_element(
      at(range.first), at(middle), at(range.second), [axis](const Small& a, const Small& b) {
        return a.at[axis] != b.at[axis] ? a.at[axis] < b.at[axis] : a.triangle < b.triangle;
      });
  order(all, {range.first, middle});
  order(all, {middle, range.second});
}

}  // namespace

Clusters find_clusters(const scenes::Scene& scene, double edge_m, Members wanted) {
  Clusters found;
  if (!(edge_m > 0.0)) return found;
  Regions regions(scene, edge_m);
  const std::vector<Range> parts = regions.sort();
  if (parts.empty()) return found;
  std::vector<Small> all = regions.take();
  std::vector<Range> clusters;
  for (const Range& range : parts) part(all, range, clusters);
  // The halves of one quadrilateral already form a facet.
  std::erase_if(clusters, [&](const Range& range) {
    const auto polygon = [&](std::size_t k) { return scene.triangles[all[k].triangle].polygon; };
    return range.second - range.first == 2 && polygon(range.first) == polygon(range.first + 1);
  });
  if (wanted == Members::Ordered) {
    base::parallel_chunks(clusters.size(), 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) order(all, clusters[k]);
    });
  }
  ClusterMembers& members = found.members;
  members.of_triangle.assign(scene.triangles.size(), no_member);
  members.triangle.reserve(all.size());
  for (const auto& [begin, end] : clusters) {
    found.first.push_back(static_cast<std::uint32_t>(members.triangle.size()));
    for (std::size_t k = begin; k < end; ++k) {
      members.of_triangle[all[k].triangle] = static_cast<std::uint32_t>(members.triangle.size());
      members.triangle.push_back(all[k].triangle);
    }
  }
  found.first.push_back(static_cast<std::uint32_t>(members.triangle.size()));
  if (wanted == Members::Unordered) return found;
  const std::size_t count = members.triangle.size();
  members.corner.resize(count);
  members.apex.resize(count);
  members.area_to.resize(count + 1);
  base::parallel_chunks(count, 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t m = begin; m < end; ++m) {
      const auto& v = scene.triangles[members.triangle[m]].vertex;
      const std::array<Vec3, 3> p{scene.vertices[v[0]], scene.vertices[v[1]], scene.vertices[v[2]]};
      members.corner[m] = {v[0], v[1], v[2]};
      members.apex[m] = apex_of(p);
      members.area_to[m + 1] = scenes::triangle_area(scene, members.triangle[m]);
    }
  });
  std::partial_sum(members.area_to.begin(), members.area_to.end(), members.area_to.begin());
  return found;
}

}  // namespace earthshine::radiosity
