// SPDX-License-Identifier: Apache-2.0
#include "radiosity/patches/patches.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace earthshine::radiosity {
namespace {

constexpr std::uint64_t most_patches = std::uint64_t{1} << 26;

std::uint32_t divisions(double length_m, double edge_m) {
  // A length that is a whole number of edges up to rounding is not cut once more. One cut more
  // often than there may be patches is refused by their number, which must not be more than a
  // number holds.
  const double count = std::ceil(length_m / edge_m - 1e-9);
  return static_cast<std::uint32_t>(std::clamp(count, 1.0, most_patches + 1.0));
}

// Triangles k and k + 1 are the halves (0,1,2), (0,2,3) of a parallelogram.
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
  Facet facet;
  const auto& vertex = scene.triangles[k].vertex;
  std::array<Vec3, 3> p{scene.vertices[vertex[0]], scene.vertices[vertex[1]],
                        scene.vertices[vertex[2]]};
  // The apex is the corner opposite the shortest edge; edge k runs between corners k + 1 and k + 2.
  double shortest = std::numeric_limits<double>::infinity();
  for (std::uint8_t corner = 0; corner < 3; ++corner) {
    const double length = glm::length(p[(corner + 1) % 3] - p[(corner + 2) % 3]);
    if (length < shortest) {
      shortest = length;
      facet.apex = corner;
    }
  }
  facet.corner = p[facet.apex];
  facet.a = p[(facet.apex + 1) % 3] - facet.corner;
  facet.b = p[(facet.apex + 2) % 3] - facet.corner;
  const Vec3 cross = glm::cross(facet.a, facet.b);
  facet.area_m2 = 0.5 * glm::length(cross);
  facet.normal = glm::normalize(cross);
  facet.s_count = divisions(std::max(glm::length(facet.a), glm::length(facet.b)), edge_m);
  facet.t_count = divisions(shortest, edge_m);
  return facet;
}

Vec3 on_facet(const Facet& f, double s, double t) {
  if (f.parallelogram) return f.corner + s * f.a + t * f.b;
  return f.corner + s * (f.a + t * (f.b - f.a));
}

}  // namespace

Rectangle rectangle_of(const Facet& facet, const Cell& cell) {
  const double rows = std::ldexp(facet.s_count, cell.s_cuts);
  const double columns = std::ldexp(facet.t_count, cell.t_cuts);
  return {cell.s / rows, (cell.s + 1.0) / rows, cell.t / columns, (cell.t + 1.0) / columns};
}

double area_of(const Facet& facet, const Rectangle& r) {
  if (facet.parallelogram) return facet.area_m2 * (r.s1 - r.s0) * (r.t1 - r.t0);
  return facet.area_m2 * (r.s1 * r.s1 - r.s0 * r.s0) * (r.t1 - r.t0);
}

Parameters Patches::parameters(std::uint32_t triangle, double u, double v) const {
  const Facet& f = facets[of_triangle[triangle]];
  if (f.parallelogram) {
    return second_half[triangle] != 0 ? Parameters{u, u + v} : Parameters{u + v, v};
  }
  // Weights of the two corners beside the apex, in order.
  const std::array<double, 3> weight{1.0 - u - v, u, v};
  const double wa = weight[(f.apex + 1) % 3], wb = weight[(f.apex + 2) % 3];
  const double s = wa + wb;
  return {s, s > 0.0 ? wb / s : 0.0};
}

std::uint32_t Patches::find(std::uint32_t triangle, double u, double v, bool front) const {
  const Facet& f = facets[of_triangle[triangle]];
  const std::uint32_t first = front ? f.first_front : f.first_back;
  if (first == no_patch) return no_patch;
  return first + leaf(f, parameters(triangle, u, v));
}

Patches::Place Patches::place(const Facet& of, Parameters where) const {
  double x = std::clamp(where.s, 0.0, 1.0) * of.s_count,
         y = std::clamp(where.t, 0.0, 1.0) * of.t_count;
  const auto row = std::min(static_cast<std::uint32_t>(x), of.s_count - 1);
  const auto column = std::min(static_cast<std::uint32_t>(y), of.t_count - 1);
  const std::uint32_t grid_cell = row * of.t_count + column;
  x -= row;
  y -= column;
  if (of.tree == no_tree) return {grid_cell, x, y};
  std::uint32_t entry = tree[of.tree + grid_cell];
  while ((entry & split_cell) != 0) {
    double& along = (entry & halves_t) != 0 ? y : x;
    const std::uint32_t half = along >= 0.5 ? 1 : 0;
    along = 2.0 * along - half;
    entry = tree[(entry & ~(split_cell | halves_t)) + half];
  }
  return {entry, x, y};
}

Rectangle Patches::rectangle(std::uint32_t patch) const {
  return rectangle_of(facets[facet[patch]], cell[patch]);
}

std::array<Vec3, 4> Patches::corners(std::uint32_t patch) const {
  const Facet& f = facets[facet[patch]];
  const Rectangle r = rectangle(patch);
  const Vec3 p00 = on_facet(f, r.s0, r.t0), p10 = on_facet(f, r.s1, r.t0);
  const Vec3 p11 = on_facet(f, r.s1, r.t1), p01 = on_facet(f, r.s0, r.t1);
  if (is_back[patch] != 0) return {p00, p01, p11, p10};
  return {p00, p10, p11, p01};
}

Vec3 Patches::point(std::uint32_t patch, double x, double y) const {
  const Facet& f = facets[facet[patch]];
  const Rectangle r = rectangle(patch);
  const double t = r.t0 + y * (r.t1 - r.t0);
  if (f.parallelogram) return on_facet(f, r.s0 + x * (r.s1 - r.s0), t);
  // Area grows with s^2: uniform in the trapezoid between s0 and s1.
  return on_facet(f, std::sqrt(r.s0 * r.s0 + x * (r.s1 * r.s1 - r.s0 * r.s0)), t);
}

Vec3 Patches::normal(std::uint32_t patch) const {
  const Vec3& n = facets[facet[patch]].normal;
  return is_back[patch] != 0 ? -n : n;
}

namespace {

// Calls take(facet, pair) for every facet in the scene's order, its patches numbered, and gives
// their number.
template <class Take>
std::uint64_t for_each_facet(const scenes::Scene& scene, double edge_m, Take take) {
  std::uint64_t total = 0;
  for (std::size_t k = 0; k < scene.triangles.size(); ++k) {
    const bool pair = forms_parallelogram(scene, k);
    Facet facet = pair ? parallelogram_facet(scene, k, edge_m) : triangle_facet(scene, k, edge_m);
    facet.triangle = static_cast<std::uint32_t>(k);
    facet.material = scene.triangles[k].material;
    facet.object = scene.triangles[k].object;
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
    take(facet, pair);
    if (pair) ++k;
  }
  return total;
}

}  // namespace

std::size_t count_patches(const scenes::Scene& scene, double edge_m) {
  return for_each_facet(scene, edge_m, [](const Facet&, bool) {});
}

Patches subdivide(const scenes::Scene& scene, double edge_m) {
  Patches patches;
  patches.of_triangle.resize(scene.triangles.size());
  patches.second_half.assign(scene.triangles.size(), 0);
  for_each_facet(scene, edge_m, [&](const Facet& facet, bool pair) {
    const auto index = static_cast<std::uint32_t>(patches.facets.size());
    patches.of_triangle[facet.triangle] = index;
    if (pair) {
      patches.of_triangle[facet.triangle + 1] = index;
      patches.second_half[facet.triangle + 1] = 1;
    }
    const int sides = facet.first_back == no_patch ? 1 : 2;
    for (int side = 0; side < sides; ++side) {
      for (std::uint32_t c = 0; c < facet.leaves; ++c) {
        const Cell cell{c / facet.t_count, c % facet.t_count};
        patches.area_m2.push_back(area_of(facet, rectangle_of(facet, cell)));
        patches.facet.push_back(index);
        patches.cell.push_back(cell);
        patches.is_back.push_back(static_cast<std::uint8_t>(side));
      }
    }
    patches.facets.push_back(facet);
  });
  return patches;
}

}  // namespace earthshine::radiosity
