// SPDX-License-Identifier: Apache-2.0
#include "scenes/round/corner_normals.h"

#include <cmath>

#include "scenes/mesh/triangulate.h"

namespace earthshine::scenes {
namespace {

std::vector<Vec3> area_vectors(const Mesh& mesh) {
  std::vector<Vec3> areas;
  std::vector<Vec3> corners;
  for (const MeshPolygon& polygon : mesh.polygons) {
    corners.clear();
    for (std::uint32_t k = 0; k < polygon.count; ++k) {
      corners.push_back(mesh.vertices[mesh.indices[polygon.first + k]]);
    }
    areas.push_back(vector_area(corners));
  }
  return areas;
}

Vec3 unit(const Vec3& v) {
  const double length = glm::length(v);
  return length > 0.0 ? v / length : Vec3(0.0);
}

// The polygons around each place: those of id k from first[k] to first[k + 1].
struct Around {
  std::vector<std::uint32_t> first, polygon;
};

Around polygons_around(const Mesh& mesh, const std::vector<std::uint32_t>& ids) {
  Around around;
  around.first.assign(ids.size() + 1, 0);
  for (const std::uint32_t index : mesh.indices) ++around.first[ids[index] + 1];
  for (std::size_t k = 0; k < ids.size(); ++k) around.first[k + 1] += around.first[k];
  around.polygon.resize(mesh.indices.size());
  std::vector<std::uint32_t> next = around.first;
  for (std::uint32_t p = 0; p < mesh.polygons.size(); ++p) {
    const MeshPolygon& polygon = mesh.polygons[p];
    for (std::uint32_t k = 0; k < polygon.count; ++k) {
      around.polygon[next[ids[mesh.indices[polygon.first + k]]]++] = p;
    }
  }
  return around;
}

}  // namespace

std::vector<Vec3> corner_normals(const Mesh& mesh, const std::vector<std::uint32_t>& ids,
                                 std::optional<double> crease_deg) {
  const std::vector<Vec3> areas = area_vectors(mesh);
  const Around around = crease_deg ? polygons_around(mesh, ids) : Around{};
  const double least_cosine = std::cos(base::radians(crease_deg.value_or(0.0)));
  std::vector<Vec3> normals(mesh.indices.size());
  for (std::size_t p = 0; p < mesh.polygons.size(); ++p) {
    const MeshPolygon& polygon = mesh.polygons[p];
    const Vec3 own = unit(areas[p]);
    for (std::uint32_t k = polygon.first; k < polygon.first + polygon.count; ++k) {
      normals[k] = own;
      const std::uint32_t of_file =
          k < mesh.normal_indices.size() ? mesh.normal_indices[k] : no_index;
      if (of_file != no_index && glm::length(mesh.normals[of_file]) > 0.5F) {
        const Vec3 normal = unit(Vec3(mesh.normals[of_file]));
        normals[k] = glm::dot(normal, own) < 0.0 ? -normal : normal;
      } else if (crease_deg) {
        Vec3 sum(0.0);
        const std::uint32_t id = ids[mesh.indices[k]];
        for (std::uint32_t n = around.first[id]; n < around.first[id + 1]; ++n) {
          const Vec3& other = areas[around.polygon[n]];
          // Beyond a right angle a neighbour that is wound the other way is as likely.
          if (glm::dot(unit(other), own) >= least_cosine) sum += other;
        }
        if (glm::length(sum) > 0.0) normals[k] = unit(sum);
      }
    }
  }
  return normals;
}

}  // namespace earthshine::scenes
