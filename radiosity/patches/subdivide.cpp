// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "radiosity/patches/clusters.h"
#include "radiosity/patches/patches.h"

namespace earthshine::radiosity {
namespace {

constexpr std::uint64_t most_patches = std::uint64_t{1} << 26;

std::uint32_t divisions(double length_m, double edge_m) {
  // A length of an integer number of edges, to rounding, is not divided once more. The limit
  // prevents integer overflow; the later check of the number of patches rejects such divisions.
  const double count = std::ceil(length_m / edge_m - 1e-9);
  return static_cast<std::uint32_t>(std::clamp(count, 1.0, most_patches + 1.0));
}

// Whether triangles k and k + 1 are the halves (0,1,2), (0,2,3) of a parallelogram.
bool forms_parallelogram(const scenes::Scene& scene, std::size_t k) {
  if (k + 1 >= scene.triangles.size()) return false;
  const scenes::Triangle& first = scene.triangles[k];
  const scenes::Triangle& second = scene.triangles[k + 1];
  if (first.polygon != second.polygon || first.material != second.material ||
      first.object != second.object) {
    return false;
  }
  if (first.vertex[0] != second.vertex[0] || first.vertex[2] != second.vertex[1]) return false;
  const Vec3& p0 = scene.vertices[first.vertex[0]];
  const Vec3& p1 = scene.vertices[first.vertex[1]];
  const Vec3& p2 = scene.vertices[first.vertex[2]];
  const Vec3& p3 = scene.vertices[second.vertex[2]];
  const double size = glm::length(p2 - p0);
  return glm::length((p1 - p0) - (p2 - p3)) <= 1e-6 * size;
}

Facet parallelogram_facet(const scenes::Scene& scene, std::size_t k, double edge_m) {
  Facet facet;
  facet.parallelogram = true;
  facet.corner = scene.vertices[scene.triangles[k].vertex[0]];
  facet.a = scene.vertices[scene.triangles[k].vertex[1]] - facet.corner;
  facet.b = scene.vertices[scene.triangles[k + 1].vertex[2]] - facet.corner;
  const Vec3 cross = glm::cross(facet.a, facet.b);
  facet.area_m2 = glm::length(cross);
  facet.normal = cross / facet.area_m2;
  facet.s_count = divisions(glm::length(facet.a), edge_m);
  facet.t_count = divisions(glm::length(facet.b), edge_m);
  return facet;
}

Facet triangle_facet(const scenes::Scene& scene, std::size_t k, double edge_m) {
  const auto& vertex = scene.triangles[k].vertex;
  Facet facet = facet_of_triangle(scene.vertices[vertex[0]], scene.vertices[vertex[1]],
                                  scene.vertices[vertex[2]]);
  const TriangleLengths lengths = lengths_of(facet);
  facet.s_count = divisions(lengths.s_m, edge_m);
  facet.t_count = divisions(lengths.t_m, edge_m);
  return facet;
}

// Calls take(facet) for every facet in scene order, then for the clusters, with numbered patches.
// Returns the number of patches.
template <class Take>
std::uint64_t for_each_facet(const scenes::Scene& scene, double edge_m, const Clusters& clusters,
                             Take take) {
  std::uint64_t total = 0;
  const auto number = [&](Facet& facet) {
    facet.material = scene.triangles[facet.triangle].material;
    facet.object = scene.triangles[facet.triangle].object;
    const bool sheet = scene.materials[facet.material].two_sided;
    const std::uint64_t cells = std::uint64_t{facet.s_count} * facet.t_count;
    if (total + 2 * cells > most_patches) {
      throw base::Error(
          base::Blame::Input, scene.path.string(),
          fmt::format("patches of {:g} m cut the scene into more than {}", edge_m, most_patches),
          {}, "Raise quality.patch_edge");
    }
    facet.leaves = static_cast<std::uint32_t>(cells);
    facet.first_front = static_cast<std::uint32_t>(total);
    total += cells;
    if (sheet) {
      facet.first_back = static_cast<std::uint32_t>(total);
      total += cells;
    }
    take(facet);
  };
  const ClusterMembers& members = clusters.members;
  const auto is_apart = [&](std::size_t k) {
    return members.of_triangle.empty() || members.of_triangle[k] == no_member;
  };
  for (std::size_t k = 0; k < scene.triangles.size(); ++k) {
    if (!is_apart(k)) continue;
    const bool pair = forms_parallelogram(scene, k) && is_apart(k + 1);
    Facet facet = pair ? parallelogram_facet(scene, k, edge_m) : triangle_facet(scene, k, edge_m);
    facet.triangle = static_cast<std::uint32_t>(k);
    number(facet);
    if (pair) ++k;
  }
  for (std::size_t c = 0; c < clusters.count(); ++c) {
    Facet facet;
    facet.first_member = clusters.first[c];
    facet.members = clusters.first[c + 1] - facet.first_member;
    facet.triangle = members.triangle[facet.first_member];
    number(facet);
  }
  return total;
}

}  // namespace

std::size_t count_patches(const scenes::Scene& scene, double edge_m) {
  return for_each_facet(scene, edge_m, find_clusters(scene, edge_m, Members::Unordered),
                        [](const Facet&) {});
}

Patches subdivide(const scenes::Scene& scene, double edge_m, double cluster_edge_m) {
  Patches patches;
  Clusters clusters = find_clusters(scene, cluster_edge_m, Members::Ordered);
  const auto count = static_cast<std::uint64_t>(for_each_facet(
      scene, edge_m, clusters, [&](const Facet& facet) { patches.facets.push_back(facet); }));
  if (clusters.count() > 0) {
    clusters.members.vertices = scene.vertices;
    patches.clustered = std::make_shared<const ClusterMembers>(std::move(clusters.members));
    patches.cluster_edge_m = cluster_edge_m;
  }
  patches.of_triangle.resize(scene.triangles.size());
  patches.second_half.assign(scene.triangles.size(), 0);
  patches.area_m2.reserve(count);
  patches.facet.reserve(count);
  patches.cell.reserve(count);
  patches.is_back.reserve(count);
  for (std::uint32_t index = 0; index < patches.facets.size(); ++index) {
    Facet& facet = patches.facets[index];
    if (facet.is_cluster()) {
      const ClusterSpan whole{facet.first_member, facet.members, {0.0, 1.0, 0.0, 1.0}};
      facet.area_m2 = patches.clustered->area(whole);
      facet.normal = patches.clustered->normal(whole);
      for (std::uint32_t m = 0; m < facet.members; ++m) {
        patches.of_triangle[patches.clustered->triangle[facet.first_member + m]] = index;
      }
    } else {
      patches.of_triangle[facet.triangle] = index;
      if (facet.parallelogram) {
        patches.of_triangle[facet.triangle + 1] = index;
        patches.second_half[facet.triangle + 1] = 1;
      }
    }
    const int sides = facet.first_back == no_patch ? 1 : 2;
    for (int side = 0; side < sides; ++side) {
      for (std::uint32_t c = 0; c < facet.leaves; ++c) {
        const Cell cell{c / facet.t_count, c % facet.t_count};
        patches.area_m2.push_back(area_of(patches, facet, cell));
        patches.facet.push_back(index);
        patches.cell.push_back(cell);
        patches.is_back.push_back(static_cast<std::uint8_t>(side));
      }
    }
  }
  return patches;
}

}  // namespace earthshine::radiosity
