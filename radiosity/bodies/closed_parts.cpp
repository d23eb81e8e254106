// SPDX-License-Identifier: Apache-2.0
#include "radiosity/bodies/closed_parts.h"

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <tuple>

#include "scenes/health/topology.h"

namespace earthshine::radiosity {
namespace {

constexpr std::uint32_t none = 0xFFFFFFFFU;

struct EdgeUse {
  std::uint32_t low, high, object, triangle;
  int way;
  [[nodiscard]] auto edge() const { return std::tie(low, high); }
  [[nodiscard]] auto key() const { return std::tie(low, high, object, triangle); }
};

}  // namespace

ClosedParts find_closed_parts(const scenes::Scene& scene) {
  const std::vector<std::uint32_t> id = scenes::welded(scene.vertices);
  std::vector<EdgeUse> uses;
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    const scenes::Triangle& triangle = scene.triangles[t];
    const scenes::Material& material = scene.materials[triangle.material];
    if (material.two_sided || material.lets_light_through()) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = id[triangle.vertex[k]], b = id[triangle.vertex[(k + 1) % 3]];
      if (a != b)
        uses.push_back({std::min(a, b), std::max(a, b), triangle.object, t, a < b ? 1 : -1});
    }
  }
  std::sort(uses.begin(), uses.end(),
            [](const EdgeUse& a, const EdgeUse& b) { return a.key() < b.key(); });

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
    // An object whose own faces close at this edge hangs together there without the others: a box
    // in the corner of a room is no part of the room.
    int net = 0;
    std::uint32_t loose = none;
    while (end < uses.size() && uses[end].edge() == uses[begin].edge()) {
      const std::size_t first = end;
      int own = 0;
      for (; end < uses.size() && uses[end].edge() == uses[begin].edge() &&
             uses[end].object == uses[first].object;
           ++end) {
        own += uses[end].way;
        unite(uses[first].triangle, uses[end].triangle);
      }
      if (own == 0) continue;
      net += own;
      if (loose != none) unite(loose, uses[first].triangle);
      loose = uses[first].triangle;
    }
    const auto [low, high] = uses[begin].edge();
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

}  // namespace earthshine::radiosity
