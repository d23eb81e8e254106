// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scenes/mesh/triangulate.h"

namespace earthshine::scenes {
namespace {

using Three = std::array<std::uint32_t, 3>;
using Four = std::array<std::uint32_t, 4>;

Mesh empty_shape() {
  Mesh mesh;
  mesh.part_sets.emplace_back();
  return mesh;
}

void add(Mesh& mesh, const Three& corners) { add_polygon(mesh, corners, 0, no_index); }
void add(Mesh& mesh, const Four& corners) { add_polygon(mesh, corners, 0, no_index); }

// Unit vector k of n around the frame's normal. Exact at the quarters, so that opposite sides of a
// round shape are symmetric.
Vec3 round(const base::Frame3& frame, std::uint32_t k, std::uint32_t n) {
  const std::uint32_t quarter = 4 * k / n;
  const bool exact = 4 * k % n == 0;
  constexpr double cosines[] = {1.0, 0.0, -1.0, 0.0};
  constexpr double sines[] = {0.0, 1.0, 0.0, -1.0};
  const double angle = 2.0 * base::pi * k / n;
  const double c = exact ? cosines[quarter % 4] : std::cos(angle);
  const double s = exact ? sines[quarter % 4] : std::sin(angle);
  return frame.tangent * c + frame.bitangent * s;
}

// A fan of triangles around `center`, over the ring of n vertices from `rim`. forward: the ring is
// counter-clockwise seen from the front.
void add_fan(Mesh& mesh, const Vec3& center, std::uint32_t rim, std::uint32_t n, bool forward) {
  const auto hub = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(center);
  for (std::uint32_t k = 0; k < n; ++k) {
    const std::uint32_t here = rim + k;
    const std::uint32_t after = rim + (k + 1) % n;
    add(mesh, forward ? Three{hub, here, after} : Three{hub, after, here});
  }
}

}  // namespace

QuadFault check_quad(std::span<const Vec3, 4> corners) {
  double size = 0.0;
  for (const Vec3& corner : corners) size = std::max(size, glm::length(corner - corners[0]));
  const Vec3 area = vector_area(corners);
  if (!(glm::length(area) > 1e-12 * size * size)) return QuadFault::NoArea;
  const Vec3 normal = glm::normalize(area);
  const Vec3 middle = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
  for (const Vec3& corner : corners) {
    if (std::abs(glm::dot(corner - middle, normal)) > 1e-6 * size) return QuadFault::NotFlat;
  }
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 before = corners[i] - corners[(i + 3) % 4];
    const Vec3 after = corners[(i + 1) % 4] - corners[i];
    if (!(glm::dot(glm::cross(before, after), normal) > 0.0)) return QuadFault::NotConvex;
  }
  return QuadFault::None;
}

Mesh make_quad(std::span<const Vec3, 4> corners) {
  Mesh mesh = empty_shape();
  mesh.vertices.assign(corners.begin(), corners.end());
  add(mesh, Four{0, 1, 2, 3});
  return mesh;
}

Mesh make_box(const Vec3& low, const Vec3& high) {
  Mesh mesh = empty_shape();
  for (unsigned i = 0; i < 8; ++i) {  // bit 0: x, bit 1: y, bit 2: z
    mesh.vertices.emplace_back((i & 1U) != 0 ? high.x : low.x, (i & 2U) != 0 ? high.y : low.y,
                               (i & 4U) != 0 ? high.z : low.z);
  }
  for (const Four& face : {Four{0, 4, 6, 2}, Four{1, 3, 7, 5}, Four{0, 1, 5, 4}, Four{2, 6, 7, 3},
                           Four{0, 2, 3, 1}, Four{4, 5, 7, 6}}) {
    add(mesh, face);
  }
  return mesh;
}

Mesh make_sphere(const Vec3& center, double radius, int segments) {
  Mesh mesh = empty_shape();
  const auto n = static_cast<std::uint32_t>(segments);
  const std::uint32_t rings = std::max(2U, n / 2);  // bands from pole to pole
  const base::Frame3 frame{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
  for (std::uint32_t j = 1; j < rings; ++j) {
    const double latitude = base::pi * (0.5 - static_cast<double>(j) / rings);
    for (std::uint32_t k = 0; k < n; ++k) {
      const Vec3 direction =
          std::cos(latitude) * round(frame, k, n) + std::sin(latitude) * frame.normal;
      mesh.vertices.push_back(center + radius * direction);
    }
  }
  for (std::uint32_t j = 0; j + 2 < rings; ++j) {
    for (std::uint32_t k = 0; k < n; ++k) {
      const std::uint32_t upper = j * n;
      const std::uint32_t lower = upper + n;
      const std::uint32_t after = (k + 1) % n;
      add(mesh, Four{upper + k, lower + k, lower + after, upper + after});
    }
  }
  add_fan(mesh, center + radius * frame.normal, 0, n, true);
  add_fan(mesh, center - radius * frame.normal, (rings - 2) * n, n, false);
  return mesh;
}

Mesh make_cylinder(const Vec3& from, const Vec3& to, double radius, int segments, bool caps) {
  Mesh mesh = empty_shape();
  const auto n = static_cast<std::uint32_t>(segments);
  const base::Frame3 frame = base::frame_around(glm::normalize(to - from));
  for (const Vec3& end : {from, to}) {
    for (std::uint32_t k = 0; k < n; ++k)
      mesh.vertices.push_back(end + radius * round(frame, k, n));
  }
  for (std::uint32_t k = 0; k < n; ++k) {
    const std::uint32_t after = (k + 1) % n;
    add(mesh, Four{k, after, n + after, n + k});
  }
  if (caps) {
    add_fan(mesh, from, 0, n, false);
    add_fan(mesh, to, n, n, true);
  }
  return mesh;
}

Mesh make_disk(const Vec3& center, const Vec3& normal, double radius, int segments) {
  Mesh mesh = empty_shape();
  const auto n = static_cast<std::uint32_t>(segments);
  const base::Frame3 frame = base::frame_around(normal);
  for (std::uint32_t k = 0; k < n; ++k)
    mesh.vertices.push_back(center + radius * round(frame, k, n));
  add_fan(mesh, center, 0, n, true);
  return mesh;
}

}  // namespace earthshine::scenes
