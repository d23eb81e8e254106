// SPDX-License-Identifier: Apache-2.0
#include "radiosity/bodies/moved_parts.h"

#include <algorithm>
#include <limits>

#include "radiosity/patches/cluster_members.h"

namespace earthshine::radiosity {
namespace {

constexpr std::size_t leaves = 256;

}  // namespace

MovedParts::MovedParts(const std::vector<Vec3>& then, const ClosedBodies& bodies_then,
                       const scenes::Scene& now, const ClosedBodies& bodies_now,
                       const Patches& patches, double margin_m)
    : unmoved_(patches.count(), 0) {
  // Everything may have changed.
  if (then.size() != now.vertices.size() || bodies_then.has_dark_outside() ||
      bodies_now.has_dark_outside()) {
    return;
  }
  const double rounding_m = body_rounding * scenes::box_around(now.vertices).diagonal();
  std::vector<char> moved(now.triangles.size(), 0);
  std::vector<scenes::Box> items;
  std::vector<scenes::Box> of_object(now.objects.size());
  for (std::uint32_t t = 0; t < now.triangles.size(); ++t) {
    const auto& vertex = now.triangles[t].vertex;
    if (std::ranges::none_of(vertex, [&](std::uint32_t v) { return then[v] != now.vertices[v]; })) {
      continue;
    }
    moved[t] = 1;
    for (const std::vector<Vec3>* pose : {&then, &now.vertices}) {
      scenes::Box box;
      for (const std::uint32_t v : vertex) box.add((*pose)[v]);
      of_object[now.triangles[t].object].add(box);
      items.push_back({box.low - rounding_m, box.high + rounding_m});
    }
  }
  std::vector<scenes::Box> around = differing_bodies(bodies_then, bodies_now);
  for (const scenes::Box& box : of_object) {
    if (box.low.x <= box.high.x) around.push_back(box);
  }
  for (std::uint32_t i = 0; i < patches.count(); ++i) {
    const Facet& facet = patches.facets[patches.facet[i]];
    bool stays = moved[facet.triangle] == 0;
    if (facet.parallelogram) stays = stays && moved[facet.triangle + 1] == 0;
    for (std::uint32_t m = 0; stays && m < facet.members; ++m) {
      stays = moved[patches.clustered->triangle[facet.first_member + m]] == 0;
    }
    if (!stays) continue;
    const auto [low, high] = patches.box(i);
    const scenes::Box own{low - (margin_m + rounding_m), high + (margin_m + rounding_m)};
    unmoved_[i] =
        std::ranges::none_of(around, [&](const scenes::Box& box) { return own.meets(box); });
  }
  most_of_leaf_ = std::max<std::size_t>(1, items.size() / leaves);
  if (!items.empty()) build(items, 0, items.size());
}

void MovedParts::build(std::vector<scenes::Box>& items, std::size_t begin, std::size_t end) {
  const std::size_t number = nodes_.size();
  scenes::Box all;
  for (std::size_t k = begin; k < end; ++k) all.add(items[k]);
  const bool is_leaf = end - begin <= most_of_leaf_;
  nodes_.push_back({all, 0, is_leaf});
  if (!is_leaf) {
    const Vec3 size = all.high - all.low;
    const int axis = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
    const std::size_t middle = begin + (end - begin) / 2;
    const auto at = [&](std::size_t k) { return items.begin() + static_cast<std::ptrdiff_t>(k); };
    std::nth_element(at(begin), at(middle), at(end),
                     [axis](const scenes::Box& a, const scenes::Box& b) {
                       return a.low[axis] + a.high[axis] < b.low[axis] + b.high[axis];
                     });
    build(items, begin, middle);
    build(items, middle, end);
  }
  nodes_[number].skip = static_cast<std::uint32_t>(nodes_.size());
}

bool MovedParts::meets(const Vec3& from, const Vec3& direction, double t_max,
                       double radius_m) const {
  const Vec3 inverse = 1.0 / direction;
  for (std::size_t k = 0; k < nodes_.size();) {
    const Node& node = nodes_[k];
    double enter = 0.0, leave = t_max;
    for (int axis = 0; axis < 3; ++axis) {
      const double low = node.box.low[axis] - radius_m - from[axis];
      const double high = node.box.high[axis] + radius_m - from[axis];
      if (direction[axis] == 0.0) {
        if (low > 0.0 || high < 0.0) leave = -1.0;
        continue;
      }
      const double a = low * inverse[axis], b = high * inverse[axis];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    if (enter > leave) {
      k = node.skip;
    } else if (node.is_leaf) {
      return true;
    } else {
      ++k;
    }
  }
  return false;
}

bool MovedParts::on_ray(const Vec3& origin, const Vec3& direction) const {
  return meets(origin, direction, std::numeric_limits<double>::infinity(), 0.0);
}

bool MovedParts::between(const Vec3& a, double radius_a_m, const Vec3& b, double radius_b_m) const {
  if (!meets(a, b - a, 1.0, std::max(radius_a_m, radius_b_m))) return false;
  // The hull is thinner toward the smaller ball.
  constexpr int pieces = 4;
  const auto radius_at = [&](double t) { return (1.0 - t) * radius_a_m + t * radius_b_m; };
  for (int k = 0; k < pieces; ++k) {
    const double from = double(k) / pieces, to = double(k + 1) / pieces;
    if (meets(a + from * (b - a), (to - from) * (b - a), 1.0,
              std::max(radius_at(from), radius_at(to)))) {
      return true;
    }
  }
  return false;
}

}  // namespace earthshine::radiosity
