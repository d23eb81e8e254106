// SPDX-License-Identifier: Apache-2.0
// Meshes of many small triangles.
#pragma once

#include <cmath>

#include "tests/support/scene_builder.h"

namespace earthshine::tests {

// Adds an object of the triangles that mesh(vertices, triangles) appends.
template <class Mesh>
void add_mesh(SceneBuilder& builder, std::uint32_t material, Mesh mesh) {
  scenes::Scene& scene = builder.scene;
  scenes::Object record;
  record.name = "mesh-" + std::to_string(scene.objects.size());
  record.first_triangle = static_cast<std::uint32_t>(scene.triangles.size());
  const auto object = static_cast<std::uint32_t>(scene.objects.size());
  mesh([&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const auto number = static_cast<std::uint32_t>(scene.triangles.size());
    scene.triangles.push_back({{a, b, c}, object, material, 1000000U + number});
  });
  record.triangle_count =
      static_cast<std::uint32_t>(scene.triangles.size()) - record.first_triangle;
  scene.objects.push_back(record);
}

// The parallelogram corner + s a + t b in n x n squares of two triangles; the front is the side
// from which a turns to b counter-clockwise.
inline void fine_wall(SceneBuilder& builder, std::uint32_t material, const Vec3& corner,
                      const Vec3& a, const Vec3& b, std::uint32_t n) {
  std::vector<Vec3>& vertices = builder.scene.vertices;
  const auto first = static_cast<std::uint32_t>(vertices.size());
  for (std::uint32_t i = 0; i <= n; ++i) {
    for (std::uint32_t j = 0; j <= n; ++j) {
      vertices.push_back(corner + double(i) / n * a + double(j) / n * b);
    }
  }
  add_mesh(builder, material, [&](const auto& triangle) {
    for (std::uint32_t i = 0; i < n; ++i) {
      for (std::uint32_t j = 0; j < n; ++j) {
        const std::uint32_t p = first + i * (n + 1) + j, q = p + n + 1;
        triangle(p, q, q + 1);
        triangle(p, q + 1, p + 1);
      }
    }
  });
}

// A sphere of `rings` belts with 2 * rings squares each, front outward.
inline void fine_sphere(SceneBuilder& builder, std::uint32_t material, const Vec3& centre,
                        double radius_m, std::uint32_t rings) {
  std::vector<Vec3>& vertices = builder.scene.vertices;
  const std::uint32_t around = 2 * rings;
  const auto first = static_cast<std::uint32_t>(vertices.size());
  vertices.push_back(centre + Vec3(0, 0, radius_m));
  for (std::uint32_t i = 1; i < rings; ++i) {
    const double theta = base::pi * i / rings;
    for (std::uint32_t j = 0; j < around; ++j) {
      const double phi = 2.0 * base::pi * j / around;
      vertices.push_back(centre + radius_m * Vec3(std::sin(theta) * std::cos(phi),
                                                  std::sin(theta) * std::sin(phi),
                                                  std::cos(theta)));
    }
  }
  vertices.push_back(centre - Vec3(0, 0, radius_m));
  const auto last = static_cast<std::uint32_t>(vertices.size() - 1);
  const auto at = [&](std::uint32_t i, std::uint32_t j) {
    return first + 1 + (i - 1) * around + j % around;
  };
  add_mesh(builder, material, [&](const auto& triangle) {
    for (std::uint32_t j = 0; j < around; ++j) {
      triangle(first, at(1, j), at(1, j + 1));
      triangle(last, at(rings - 1, j + 1), at(rings - 1, j));
      for (std::uint32_t i = 1; i + 1 < rings; ++i) {
        triangle(at(i, j), at(i + 1, j), at(i + 1, j + 1));
        triangle(at(i, j), at(i + 1, j + 1), at(i, j + 1));
      }
    }
  });
}

}  // namespace earthshine::tests
