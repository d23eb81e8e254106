// SPDX-License-Identifier: Apache-2.0
// Cases between rectangles: the scene has exactly the geometry of the case.
#include <cmath>
#include <optional>

#include "tests/support/case_builders.h"

namespace earthshine::tests {
namespace {

constexpr int cells = 4;  // rectangles are divided into 4 x 4 patches
constexpr int many_rays = 16384;

void facing_squares(const CaseRecord& r, Case& c) {
  const double a = r.at("a"), b = r.at("b"), h = r.at("c");
  const std::uint32_t m = c.made.material(0.5);
  c.from = c.made.object("first", m);
  c.made.level(0, a, 0, b, 0, true, cells, cells);
  c.to = c.made.object("second", m);
  c.made.level(0, a, 0, b, h, false, cells, cells);
  c.rays = many_rays;
}

void facing_rectangles_anywhere(const CaseRecord& r, Case& c) {
  const std::uint32_t m = c.made.material(0.5);
  c.from = c.made.object("first", m);
  c.made.level(r.at("x", 0), r.at("x", 1), r.at("y", 0), r.at("y", 1), 0, true, cells, cells);
  c.to = c.made.object("second", m);
  c.made.level(r.at("xi", 0), r.at("xi", 1), r.at("eta", 0), r.at("eta", 1), r.at("z"), false,
               cells, cells);
  c.rays = many_rays;
}

// From a floor of width w to a wall of height h, both of length l, at an angle.
void hinged(double w, double h, double l, double angle, Case& c) {
  const std::uint32_t m = c.made.material(0.5);
  c.from = c.made.object("first", m);
  c.made.grid({0, 0, 0}, {w, 0, 0}, {0, l, 0}, cells, cells);
  c.to = c.made.object("second", m);
  c.made.grid({0, 0, 0}, {0, l, 0}, {h * std::cos(angle), 0, h * std::sin(angle)}, cells, cells);
  c.rays = many_rays;
}

void perpendicular(const CaseRecord& r, Case& c) {
  hinged(r.at("w"), r.at("h"), r.at("l"), 0.5 * base::pi, c);
}

void inclined(const CaseRecord& r, Case& c) {
  hinged(r.at("b"), r.at("a"), r.at("c"), base::radians(r.at("phi_deg")), c);
}

void perpendicular_anywhere(const CaseRecord& r, Case& c) {
  const std::uint32_t m = c.made.material(0.5);
  c.from = c.made.object("first", m);
  c.made.level(r.at("x", 0), r.at("x", 1), r.at("y", 0), r.at("y", 1), 0, true, cells, cells);
  c.to = c.made.object("second", m);
  const double low = r.at("xi", 0), left = r.at("eta", 0);
  c.made.grid({0, left, low}, {0, r.at("eta", 1) - left, 0}, {0, 0, r.at("xi", 1) - low}, cells,
              cells);
  c.rays = many_rays;
}

// Mirrors at both ends of strips along y within [0, w] x [0, h].
void mirror_ends(double w, double h, Case& c) {
  const double l = strip_length;
  c.made.object("ends", c.made.mirror());
  c.made.grid({0, 0, 0}, {0, 0, h}, {w, 0, 0}, 1, 1);
  c.made.grid({0, l, 0}, {w, 0, 0}, {0, 0, h}, 1, 1);
}

void facing_strips(const CaseRecord& r, Case& c) {
  const double w = r.at("w"), h = r.at("h"), l = strip_length;
  const std::uint32_t m = c.made.material(0.5);
  c.from = c.made.object("first", m);
  c.made.level(0, w, 0, l, 0, true, 2 * cells, 1);
  c.to = c.made.object("second", m);
  c.made.level(0, w, 0, l, h, false, 2 * cells, 1);
  mirror_ends(w, h, c);
  c.rays = 2 * many_rays;
}

void perpendicular_strips(const CaseRecord& r, Case& c) {
  const double w = r.at("w"), h = r.at("h"), l = strip_length;
  const std::uint32_t m = c.made.material(0.5);
  c.from = c.made.object("first", m);
  c.made.level(0, w, 0, l, 0, true, 2 * cells, 1);
  c.to = c.made.object("second", m);
  c.made.grid({0, 0, 0}, {0, l, 0}, {0, 0, h}, 1, 2 * cells);
  mirror_ends(w, h, c);
  c.rays = 2 * many_rays;
}

// A face of the unit cube seen from inside, front along u x v, and one of its n x n cells.
struct Face {
  Vec3 corner, u, v;
  int n = 0, i = 0, j = 0;  // n = 0: no cell
};

// The face without its cell.
void add_rest(const Face& f, CaseScene& scene) {
  const auto part = [&](double u0, double u1, double v0, double v1) {
    if (u1 <= u0 || v1 <= v0) return;
    scene.grid(f.corner + u0 * f.u + v0 * f.v, (u1 - u0) * f.u, (v1 - v0) * f.v, 1, 1);
  };
  if (f.n == 0) {
    scene.grid(f.corner, f.u, f.v, 2, 2);
    return;
  }
  const double n = f.n, u0 = f.i / n, u1 = (f.i + 1) / n, v0 = f.j / n, v1 = (f.j + 1) / n;
  part(0, u0, 0, 1);
  part(u1, 1, 0, 1);
  part(u0, u1, 0, v0);
  part(u0, u1, v1, 1);
}

void add_cell(const Face& f, CaseScene& scene) {
  const double n = f.n;
  scene.grid(f.corner + (f.i / n) * f.u + (f.j / n) * f.v, f.u / n, f.v / n, cells, cells);
}

// The closed room with one cell of the floor and one of the ceiling or of the wall x = 0.
void cube_cells(const CaseRecord& r, Case& c, const std::optional<Face>& second) {
  const Vec3 o(0), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  const int n = int(r.at("n"));
  const Face floor{o, x, y, n, int(r.at("i")), int(r.at("j"))};
  std::vector<Face> faces{floor,
                          {z, y, x, 0, 0, 0},
                          {o, y, z, 0, 0, 0},
                          {x, z, y, 0, 0, 0},
                          {o, z, x, 0, 0, 0},
                          {y, x, z, 0, 0, 0}};
  const std::uint32_t m = c.made.material(0.5);
  c.made.object("rest", m);
  for (const Face& f : faces) {
    const bool taken = second && f.corner == second->corner && f.u == second->u;
    add_rest(taken ? *second : f, c.made);
  }
  c.from = c.made.object("first", m);
  add_cell(floor, c.made);
  c.to = every_object;
  if (second) {
    c.to = c.made.object("second", m);
    add_cell(*second, c.made);
  }
  c.rays = 4 * many_rays;
}

void facing_cells(const CaseRecord& r, Case& c) {
  const int n = int(r.at("n")), k = int(r.at("k")), l = int(r.at("l"));
  cube_cells(r, c, Face{{0, 0, 1}, {0, 1, 0}, {1, 0, 0}, n, l, k});
}

void perpendicular_cells(const CaseRecord& r, Case& c) {
  const int n = int(r.at("n")), k = int(r.at("k")), l = int(r.at("l"));
  cube_cells(r, c, Face{{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, n, l, k});
}

void cube_cell(const CaseRecord& r, Case& c) { cube_cells(r, c, std::nullopt); }

void blocked_squares(const CaseRecord& r, Case& c) {
  const double h = r.at("h"), half = 0.5 * r.at("blocker_side"), z = r.at("blocker_z");
  const std::uint32_t m = c.made.material(0.5);
  c.from = c.made.object("first", m);
  c.made.level(-0.5, 0.5, -0.5, 0.5, 0, true, cells, cells);
  c.to = c.made.object("second", m);
  c.made.level(-0.5, 0.5, -0.5, 0.5, h, false, cells, cells);
  c.made.object("blocker", c.made.material(0.5, 0.0, true));
  c.made.level(-half, half, -half, half, z, true, cells, cells);
  c.rays = many_rays;
}

constexpr CaseBuilder builders[] = {{"parallel_unit_squares", facing_squares},
                                    {"parallel_", facing_rectangles_anywhere},
                                    {"perp_common_edge", perpendicular},
                                    {"perp_", perpendicular_anywhere},
                                    {"inclined_", inclined},
                                    {"infinite_strips_parallel", facing_strips},
                                    {"infinite_perp", perpendicular_strips},
                                    {"cube_n4_par", facing_cells},
                                    {"cube_n16_par", facing_cells},
                                    {"cube_n4_perp", perpendicular_cells},
                                    {"cube_n16_perp", perpendicular_cells},
                                    {"cube_n24_perp", perpendicular_cells},
                                    {"cube_n8_row_sum", cube_cell},
                                    {"occluded_", blocked_squares}};

}  // namespace

std::span<const CaseBuilder> rectangle_builders() { return builders; }

}  // namespace earthshine::tests
