// SPDX-License-Identifier: Apache-2.0
#include "scenes/round/edge_curves.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/free_memory.h"
#include "scenes/mesh/triangulate.h"

namespace earthshine::scenes {
namespace {

constexpr double same_normal = 1e-4;        // 1 - |cosine|: within 0.8 degrees
constexpr double flat_deg = 0.05;           // smaller rotations are flat
constexpr double least_cosine = 0.5;        // between a curve's end and its chord
constexpr std::uint32_t most_pieces = 256;  // of an edge

double angle_deg(const Vec3& a, const Vec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), std::abs(glm::dot(a, b))) * 180.0 / base::pi;
}

// The inner Bezier point next to `from`, a third of the distance to `to`.
Vec3 inner_point(const Vec3& from, const Vec3& to, const std::vector<Vec3>& normals) {
  const Vec3 offset = to - from;
  const auto alike = [&](const Vec3& normal) {
    return 1.0 - std::abs(glm::dot(normal, normals.front())) < same_normal;
  };
  Vec3 along = offset;
  if (std::all_of(normals.begin(), normals.end(), alike)) {
    along = offset - glm::dot(offset, normals.front()) * normals.front();
  } else if (normals.size() == 2) {  // a crease follows both of its faces
    const Vec3 crease = glm::normalize(glm::cross(normals[0], normals[1]));
    along = glm::dot(offset, crease) * crease;
  }
  const double chord = glm::length(offset), tangent = glm::length(along);
  const double cosine = chord * tangent > 0.0 ? glm::dot(offset, along) / (chord * tangent) : 0.0;
  // A curve nearly perpendicular to its edge is rejected. The length suits an arc at the angle phi
  // to its chord: (4/3) tan(phi/2) radii, where the chord is 2 sin(phi) radii.
  if (cosine < least_cosine) return from + offset / 3.0;
  return from + along * (2.0 / 3.0 * chord / (tangent * (1.0 + cosine)));
}

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

// The polygons around each place: entries first[k] to first[k + 1] for id k.
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

Vec3 point_on(const EdgeCurve& curve, double t) {
  const auto& [a, b, c, d] = curve.points;
  const double s = 1.0 - t;
  return s * s * s * a + 3.0 * s * s * t * b + 3.0 * s * t * t * c + t * t * t * d;
}

std::uint32_t EdgeCurves::add(std::uint32_t a, std::uint32_t b, const Vec3& normal_a,
                              const Vec3& normal_b) {
  const auto number = static_cast<std::uint32_t>(uses_.size());
  uses_.push_back(a < b ? Use{a, b, number, normal_a, normal_b}
                        : Use{b, a, number, normal_b, normal_a});
  return number;
}

void EdgeCurves::find(const std::vector<Vec3>& place, double step_deg) {
  std::sort(uses_.begin(), uses_.end(), [](const Use& a, const Use& b) {
    return std::tie(a.low, a.high, a.number) < std::tie(b.low, b.high, b.number);
  });
  of_use_.resize(uses_.size());
  curves_.reserve(uses_.size() / 2 + 1);  // most edges have two faces
  for (std::size_t begin = 0, end = 0; begin < uses_.size(); begin = end) {
    for (; end < uses_.size() && uses_[end].low == uses_[begin].low &&
           uses_[end].high == uses_[begin].high;
         ++end) {
      of_use_[uses_[end].number] = static_cast<std::uint32_t>(curves_.size());
    }
    curves_.push_back(curve_of({&uses_[begin], end - begin}, place, step_deg));
  }
  base::release(uses_);
}

// Curve of one edge.
EdgeCurve EdgeCurves::curve_of(std::span<const Use> uses, const std::vector<Vec3>& place,
                               double step_deg) {
  std::vector<Vec3> low, high;
  double angle = 0.0;
  for (const Use& use : uses) {
    low.push_back(use.at_low);
    high.push_back(use.at_high);
    angle = std::max(angle, angle_deg(use.at_low, use.at_high));
  }
  EdgeCurve curve;
  const Vec3 &a = place[uses.front().low], &b = place[uses.front().high];
  curve.points = {a, inner_point(a, b, low), inner_point(b, a, high), b};
  angle = std::max(angle, angle_deg(curve.points[1] - a, b - curve.points[2]));
  if (angle > flat_deg) {
    curve.pieces = std::clamp(static_cast<std::uint32_t>(std::ceil(angle / step_deg - 1e-6)),
                              std::uint32_t{1}, most_pieces);
  }
  return curve;
}

std::vector<Vec3> corner_normals(const Mesh& mesh, const std::vector<std::uint32_t>& ids,
                                 std::optional<double> crease_deg) {
  const std::vector<Vec3> areas = area_vectors(mesh);
  const Around around = crease_deg ? polygons_around(mesh, ids) : Around{};
  const double crease_cosine = std::cos(base::radians(crease_deg.value_or(0.0)));
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
          // Beyond a right angle a neighbour of opposite winding is equally likely.
          if (glm::dot(unit(other), own) >= crease_cosine) sum += other;
        }
        if (glm::length(sum) > 0.0) normals[k] = unit(sum);
      }
    }
  }
  return normals;
}

}  // namespace earthshine::scenes
