// SPDX-License-Identifier: Apache-2.0
#include "raytrace/witness/edges.h"

#include <algorithm>
#include <cmath>

#include "scenes/health/topology.h"
#include "scenes/ray_query.h"

namespace earthshine::raytrace {
namespace {

// Cosine between the normals of coplanar triangles.
constexpr double same_plane = 1.0 - 1e-9;

}  // namespace

std::vector<SceneEdge> find_edges(const scenes::Scene& scene) {
  struct Side {
    std::uint64_t key;
    std::uint32_t triangle;
  };
  const std::vector<std::uint32_t> number = scenes::welded(scene.vertices);
  std::vector<Side> sides;
  sides.reserve(3 * scene.triangles.size());
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    const auto& v = scene.triangles[t].vertex;
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(number[v[k]], number[v[(k + 1) % 3]]);
      if (low != high) sides.push_back({(std::uint64_t{low} << 32U) | high, t});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& one, const Side& other) {
    return one.key != other.key ? one.key < other.key : one.triangle < other.triangle;
  });
  std::vector<SceneEdge> edges;
  for (std::size_t k = 0; k < sides.size();) {
    std::size_t end = k + 1;
    while (end < sides.size() && sides[end].key == sides[k].key) ++end;
    SceneEdge edge{scene.vertices[sides[k].key >> 32U], scene.vertices[sides[k].key & 0xFFFFFFFFU]};
    const std::uint32_t first = sides[k].triangle, second = sides[end - 1].triangle;
    edge.is_border =
        end != k + 2 || scene.triangles[first].material != scene.triangles[second].material;
    if (!edge.is_border) {
      edge.normal_a = scenes::triangle_normal(scene, first);
      edge.normal_b = scenes::triangle_normal(scene, second);
    }
    if (edge.is_border || glm::dot(edge.normal_a, edge.normal_b) < same_plane) {
      edges.push_back(edge);
    }
    k = end;
  }
  return edges;
}

}  // namespace earthshine::raytrace
