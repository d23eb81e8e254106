// SPDX-License-Identifier: Apache-2.0
#include "radiosity/patches/patches.h"

#include <cmath>

#include "radiosity/patches/cluster_members.h"
#include "scenes/reflect/energy.h"
#include "scenes/surface_texture.h"

namespace earthshine::radiosity {
namespace {

Vec3 on_facet(const Facet& f, double s, double t) {
  if (f.parallelogram) return f.corner + s * f.a + t * f.b;
  return f.corner + s * (f.a + t * (f.b - f.a));
}

// Uniform in area: a triangle's area grows with s^2.
Parameters parameters_at(const Facet& f, const Rectangle& r, double x, double y) {
  const double t = r.t0 + y * (r.t1 - r.t0);
  if (f.parallelogram) return {r.s0 + x * (r.s1 - r.s0), t};
  return {std::sqrt(r.s0 * r.s0 + x * (r.s1 * r.s1 - r.s0 * r.s0)), t};
}

Parameters in_triangle(std::uint8_t apex, double u, double v) {
  // Weights of the two corners beside the apex, in order.
  const std::array<double, 3> weight{1.0 - u - v, u, v};
  const double wa = weight[(apex + 1) % 3], wb = weight[(apex + 2) % 3];
  const double s = wa + wb;
  return {s, s > 0.0 ? wb / s : 0.0};
}

// Points of a part are inset from its edges, where rounding could put them behind the walls: by
// this share of their distance to its middle, and more in narrow parts, up to half of it.
constexpr double part_inset = 1e-4;
constexpr double float_rounding = 0x1p-20;  // of single precision, over the facet's size and place

PlanePoint in_plane(const Facet& f, Parameters p) {
  return f.parallelogram ? PlanePoint(p.s, p.t) : PlanePoint(p.s * (1.0 - p.t), p.s * p.t);
}
Parameters from_plane(const Facet& f, const PlanePoint& p) {
  if (f.parallelogram) return {p.x, p.y};
  const double s = p.x + p.y;
  return {s, s > 0.0 ? p.y / s : 0.0};
}

// Uniform in the inset area of a part.
PlanePoint in_outline(const Facet& f, const Outline& o, double x, double y) {
  const auto area = [&](std::size_t b, std::size_t c) {
    const PlanePoint u = o[b] - o[0], v = o[c] - o[0];
    return u.x * v.y - u.y * v.x;
  };
  const double first = area(1, 2), all = first + area(2, 3), share = first / all;
  const bool in_first = x < share || share >= 1.0;
  const double r = std::sqrt(in_first ? x / share : (x - share) / (1.0 - share));
  const PlanePoint &b = o[in_first ? 1 : 2], &c = o[in_first ? 2 : 3];
  const PlanePoint p = o[0] + r * (b - o[0] + y * (c - b));
  double around = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    const PlanePoint edge = o[(k + 1) % 4] - o[k];
    around += glm::length(edge.x * f.a + edge.y * f.b);
  }
  const double width = all * glm::length(glm::cross(f.a, f.b)) / around;
  const double size = glm::length(f.corner) + glm::length(f.a) + glm::length(f.b);
  const double inset = part_inset + std::min(0.5, float_rounding * size / width);
  return p + inset * (0.25 * (o[0] + o[1] + o[2] + o[3]) - p);
}

// The facet, or the triangle of a cluster, that contains the point (x, y) of a patch.
struct Holder {
  Facet facet;
  Parameters where;
};
Holder holder_of(const Patches& patches, std::uint32_t patch, double x, double y) {
  const Facet& f = patches.facets[patches.facet[patch]];
  if (patches.is_part(patch)) {
    return {f, from_plane(f, in_outline(f, patches.outlines[patches.cell[patch].outline], x, y))};
  }
  if (!f.is_cluster()) return {f, parameters_at(f, patches.rectangle(patch), x, y)};
  const ClusterSpan span = span_of(f, patches.cell[patch]);
  const Facet member = patches.clustered->facet(patches.clustered->pick(span, x));
  return {member, parameters_at(member, span.part, x, y)};
}

// Samples per direction of a patch: one per texel, within these bounds.
constexpr int fewest_samples = 24, most_samples = 96;

using ColourAt = Rgb (*)(const scenes::Scene&, const scenes::Material&,
                         const scenes::SurfacePlace&);

Rgb mean_over(const scenes::Scene& scene, const Patches& patches, std::uint32_t patch,
              ColourAt colour_at) {
  const scenes::Material& material = scene.materials[patches.material(patch)];
  const double texels = scenes::texels_per_m(scene, patches.on_triangle(patch, 0.5, 0.5).triangle) *
                        std::sqrt(patches.area_m2[patch]);
  const int samples =
      static_cast<int>(std::clamp(std::ceil(texels), double(fewest_samples), double(most_samples)));
  Rgb sum(0.0), with_holes(0.0);
  int there = 0;
  for (int i = 0; i < samples; ++i) {
    for (int j = 0; j < samples; ++j) {
      // Rows are offset by the golden ratio, so that samples do not align with patterns.
      const double y = (j + 0.5) / samples;
      const double x = (i + glm::fract(0.5 + j * 0.6180339887498949)) / samples;
      const TrianglePlace at = patches.on_triangle(patch, x, y);
      const Rgb colour = colour_at(scene, material, {at.triangle, at.u, at.v});
      with_holes += colour;
      if (!scenes::is_there(scene, at.triangle, at.u, at.v)) continue;
      sum += colour;
      ++there;
    }
  }
  // A patch that is one hole still gets a colour; rays detect the hole.
  return there > 0 ? sum / double(there) : with_holes / double(samples * samples);
}

}  // namespace

TrianglePlace triangle_place(const Facet& facet, Parameters where) {
  const double s = where.s, t = where.t;
  if (facet.parallelogram) {
    if (s >= t) return {facet.triangle, s - t, t};
    return {facet.triangle + 1, s, t - s};
  }
  std::array<double, 3> weight{};
  weight[facet.apex] = 1.0 - s;
  weight[(facet.apex + 1) % 3] = s * (1.0 - t);
  weight[(facet.apex + 2) % 3] = s * t;
  return {facet.triangle, weight[1], weight[2]};
}

Rectangle rectangle_of(const Facet& facet, const Cell& cell) {
  const double rows = std::ldexp(facet.s_count, cell.s_cuts);
  const double columns = std::ldexp(facet.t_count, cell.t_cuts);
  return {cell.s / rows, (cell.s + 1.0) / rows, cell.t / columns, (cell.t + 1.0) / columns};
}

double area_of(const Facet& facet, const Rectangle& r) {
  if (facet.parallelogram) return facet.area_m2 * (r.s1 - r.s0) * (r.t1 - r.t0);
  return facet.area_m2 * (r.s1 * r.s1 - r.s0 * r.s0) * (r.t1 - r.t0);
}

double area_of(const Facet& facet, const Outline& o) {
  const PlanePoint u = o[2] - o[0], v = o[3] - o[1];
  return (facet.parallelogram ? 0.5 : 1.0) * facet.area_m2 * (u.x * v.y - u.y * v.x);
}

double area_of(const Patches& patches, const Facet& facet, const Cell& cell) {
  if (cell.outline != no_outline) return area_of(facet, patches.outlines[cell.outline]);
  if (facet.is_cluster()) return patches.clustered->area(span_of(facet, cell));
  return area_of(facet, rectangle_of(facet, cell));
}

Parameters Patches::parameters(std::uint32_t triangle, double u, double v) const {
  const Facet& f = facets[of_triangle[triangle]];
  if (f.is_cluster()) {
    const std::uint32_t member = clustered->of_triangle[triangle];
    return clustered->parameters(f, member, in_triangle(clustered->apex[member], u, v));
  }
  if (f.parallelogram) {
    return second_half[triangle] != 0 ? Parameters{u, u + v} : Parameters{u + v, v};
  }
  return in_triangle(f.apex, u, v);
}

std::uint32_t Patches::find(std::uint32_t triangle, double u, double v, bool front) const {
  const Facet& f = facets[of_triangle[triangle]];
  const std::uint32_t first = front ? f.first_front : f.first_back;
  if (first == no_patch) return no_patch;
  if (f.is_cluster() && f.tree == no_tree) return first;
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
    if ((entry & parted_cell) != 0) {
      const std::uint32_t at = entry & pair_of;
      return {tree[at] + part_at(tree[at + 1], in_plane(of, where)), x, y};
    }
    double& along = (entry & halves_t) != 0 ? y : x;
    const std::uint32_t half = along >= 0.5 ? 1 : 0;
    along = 2.0 * along - half;
    entry = tree[(entry & pair_of) + half];
  }
  return {entry, x, y};
}

std::uint32_t Patches::part_at(std::uint32_t first_node, const PlanePoint& p) const {
  for (std::uint32_t node = first_node;;) {
    const PartNode& at = part_nodes[node];
    const std::int32_t side = at.side[glm::dot(at.normal, p) >= at.reach ? 1 : 0];
    if (side < 0) return static_cast<std::uint32_t>(~side);
    node = first_node + static_cast<std::uint32_t>(side);
  }
}

Rectangle Patches::rectangle(std::uint32_t patch) const {
  return rectangle_of(facets[facet[patch]], cell[patch]);
}

std::array<Vec3, 4> Patches::corners(std::uint32_t patch) const {
  const auto oriented = [&](const std::array<Vec3, 4>& p) {
    return is_back[patch] != 0 ? std::array<Vec3, 4>{p[0], p[3], p[2], p[1]} : p;
  };
  const auto of = [&](const Facet& f, const Rectangle& r) {
    return oriented({on_facet(f, r.s0, r.t0), on_facet(f, r.s1, r.t0), on_facet(f, r.s1, r.t1),
                     on_facet(f, r.s0, r.t1)});
  };
  const Facet& f = facets[facet[patch]];
  if (is_part(patch)) {
    const Outline& o = outlines[cell[patch].outline];
    const auto at = [&](const PlanePoint& p) { return f.corner + p.x * f.a + p.y * f.b; };
    return oriented({at(o[0]), at(o[1]), at(o[2]), at(o[3])});
  }
  if (!f.is_cluster()) return of(f, rectangle(patch));
  const ClusterSpan span = span_of(f, cell[patch]);
  if (span.count > 1) return oriented(clustered->corners(span));
  return of(clustered->facet(span.first), span.part);
}

scenes::Box Patches::box(std::uint32_t patch) const {
  const Facet& f = facets[facet[patch]];
  if (f.is_cluster()) return clustered->box(span_of(f, cell[patch]));
  const std::array<Vec3, 4> c = corners(patch);
  return {glm::min(glm::min(c[0], c[1]), glm::min(c[2], c[3])),
          glm::max(glm::max(c[0], c[1]), glm::max(c[2], c[3]))};
}

SurfacePoint Patches::at(std::uint32_t patch, double x, double y) const {
  const auto [f, where] = holder_of(*this, patch, x, y);
  const bool second = f.parallelogram && where.s < where.t;
  return {on_facet(f, where.s, where.t), is_back[patch] != 0 ? -f.normal : f.normal,
          f.triangle + (second ? 1U : 0U)};
}

TrianglePlace Patches::on_triangle(std::uint32_t patch, double x, double y) const {
  const auto [f, where] = holder_of(*this, patch, x, y);
  return triangle_place(f, where);
}

Vec3 Patches::normal(std::uint32_t patch) const {
  const Facet& f = facets[facet[patch]];
  const Vec3 n = f.is_cluster() ? clustered->normal(span_of(f, cell[patch])) : f.normal;
  return is_back[patch] != 0 ? -n : n;
}

Vec3 Patches::normal_at(std::uint32_t triangle, bool front) const {
  const Facet& f = facets[of_triangle[triangle]];
  const Vec3 n =
      f.is_cluster() ? clustered->facet(clustered->of_triangle[triangle]).normal : f.normal;
  return front ? n : -n;
}

bool Patches::is_several(std::uint32_t patch) const {
  const Facet& f = facets[facet[patch]];
  return f.is_cluster() && span_of(f, cell[patch]).count > 1;
}

Rgb patch_diffuse(const scenes::Scene& scene, const Patches& patches, std::uint32_t patch) {
  const scenes::Material& material = scene.materials[patches.material(patch)];
  if (!material.maps || !material.maps->vary_diffuse()) return material.diffuse;
  return mean_over(scene, patches, patch, scenes::textured_diffuse);
}

Rgb patch_emit(const scenes::Scene& scene, const Patches& patches, std::uint32_t patch) {
  const scenes::Material& material = scene.materials[patches.material(patch)];
  if (!material.maps || !material.maps->emit.texture) return material.emit;
  return mean_over(scene, patches, patch, scenes::textured_emit);
}

PatchAlbedos::PatchAlbedos(const scenes::Scene& scene)
    : scene_(scene), by_material_(scenes::bihemispherical_albedos(scene)) {}

Rgb PatchAlbedos::of(const Patches& patches, std::uint32_t patch) const {
  const std::uint32_t m = patches.material(patch);
  if (!scene_.materials[m].maps) return by_material_[m];
  return by_material_[m] + patch_diffuse(scene_, patches, patch) - scene_.materials[m].diffuse;
}

}  // namespace earthshine::radiosity
