// SPDX-License-Identifier: Apache-2.0
// Cases with round bodies, made of polygons with the same area (disks, spheres) or circumference
// (cylinders). The remaining error was computed for the polygons: contour integrals between regular
// n-gons for disks and cavities, sums of point-to-polygon factors over the faces for geodesic
// spheres.
#include <cmath>

#include "tests/support/case_builders.h"

namespace earthshine::tests {
namespace {

constexpr int corners = 64;        // of disks: errors of their factors are below 1.3e-6
constexpr int smooth_sides = 512;  // of cylinders: errors below 1e-5

void disk(CaseScene& s, double inner, double outer, double z, bool up) {
  s.ring(corners, same_area_radius(corners, inner), z, same_area_radius(corners, outer), z, !up);
}

void disk_pair(double inner1, double outer1, double inner2, double outer2, double h, Case& c) {
  const std::uint32_t m = c.made.material(0.5);
  c.from = c.made.object("first", m);
  disk(c.made, inner1, outer1, 0.0, true);
  c.to = c.made.object("second", m);
  disk(c.made, inner2, outer2, h, false);
  c.rays = 4096;
  c.model_error = 1.3e-6;
}

void disks(const CaseRecord& r, Case& c) { disk_pair(0, r.at("r1"), 0, r.at("r2"), r.at("h"), c); }
void disk_to_annulus(const CaseRecord& r, Case& c) {
  disk_pair(0, r.at("r1"), r.at("ri"), r.at("ro"), r.at("h"), c);
}
void annuli(const CaseRecord& r, Case& c) {
  disk_pair(r.at("r1i"), r.at("r1o"), r.at("r2i"), r.at("r2o"), r.at("h"), c);
}

// A surface element: a square of 0.1 mm, at least 1 cm from all bodies. 32 x 32 patches, so that it
// casts many rays.
void element(const Vec3& at, const Vec3& normal, Case& c) {
  constexpr double size = 1e-4;
  const base::Frame3 frame = base::frame_around(normal);
  c.from = c.made.object("element", c.made.material(0.5));
  c.made.grid(at - 0.5 * size * (frame.tangent + frame.bitangent), size * frame.tangent,
              size * frame.bitangent, 32, 32);
  c.rays = 256;
  c.model_error = 1e-6;
}

void element_to_disk(const CaseRecord& r, Case& c) {
  element(Vec3(0), Vec3(0, 0, 1), c);
  c.to = c.made.object("disk", 0);
  disk(c.made, 0, r.at("r"), r.at("h"), false);
}

void element_to_facing_rectangle(const CaseRecord& r, Case& c) {
  element(Vec3(0), Vec3(0, 0, 1), c);
  c.to = c.made.object("rectangle", 0);
  c.made.level(0, r.at("a"), 0, r.at("b"), r.at("c"), false, 4, 4);
}

void element_to_wall(const CaseRecord& r, Case& c) {
  element(Vec3(0), Vec3(0, 0, 1), c);
  c.to = c.made.object("rectangle", 0);
  c.made.grid({r.at("c"), 0, 0}, {0, 0, r.at("a")}, {0, r.at("b"), 0}, 4, 4);
}

void element_to_sphere(const CaseRecord& r, Case& c) {
  const double h = r.at("H"), tilt = base::radians(r.at("theta_deg"));
  element({0, 0, -h}, {std::sin(tilt), 0, std::cos(tilt)}, c);
  c.to = c.made.object("sphere", 0);
  const bool close = h < 1.1;  // close enough for facets to matter
  c.made.sphere(Vec3(0), 1.0, close ? 5 : 4);
  c.rays = close ? 128 : 256;
  c.model_error = close ? 2e-5 : 7e-6;
}

void sphere_to(const char* name, double radius, double height, Case& c) {
  const std::uint32_t m = c.made.material(0.5);
  c.from = c.made.object("sphere", m);
  c.made.sphere({0, 0, height}, radius, 4);
  c.to = c.made.object(name, m);
  c.rays = 256;
  c.model_error = 1e-5;
}

void sphere_to_disk(const CaseRecord& r, Case& c) {
  sphere_to("disk", r.at("r_sphere"), r.at("h"), c);
  disk(c.made, 0, r.at("r_disk"), 0.0, true);
}

void sphere_to_rectangle(const CaseRecord& r, Case& c) {
  sphere_to("rectangle", 0.5 * r.at("c"), r.at("c"), c);
  c.made.level(0, r.at("a"), 0, r.at("b"), 0.0, true, 16, 16);
}

void sphere_to_sphere(const CaseRecord& r, Case& c) {
  sphere_to("other", r.at("r1"), r.at("s"), c);
  c.made.sphere(Vec3(0), r.at("r2"), 4);
}

// Convex bodies inside each other: the factor is exactly a ratio of areas.
void spheres_in_spheres(const CaseRecord& r, Case& c) {
  const std::uint32_t m = c.made.material(0.5);
  c.from = c.made.object("outer", m);
  c.made.sphere(Vec3(0), r.at("r2"), 3, true);
  c.to = c.made.object("inner", m);
  c.made.sphere(Vec3(0), r.at("r1"), 3);
  c.rays = 512;
}

void tube(CaseScene& s, int n, double radius, double h, bool inward) {
  const double r = same_length_radius(n, radius);
  s.ring(n, r, 0, r, h, !inward);
}

void endless_cylinders(const CaseRecord& r, Case& c) {
  const double r1 = same_length_radius(corners, r.at("r1")),
               r2 = same_length_radius(corners, r.at("r2"));
  const std::uint32_t m = c.made.material(0.5);
  c.from = c.to = c.made.object("outer", m);
  tube(c.made, corners, r.at("r2"), strip_length, true);
  c.made.object("inner", m);
  tube(c.made, corners, r.at("r1"), strip_length, false);
  c.made.object("ends", c.made.mirror());
  c.made.ring(corners, r1, 0, r2, 0);
  c.made.ring(corners, r1, strip_length, r2, strip_length, true);
  c.rays = 4096;
}

void cylinders(const CaseRecord& r, Case& c, bool to_inner) {
  const std::uint32_t m = c.made.material(0.5);
  c.from = c.to = c.made.object("outer", m);
  tube(c.made, smooth_sides, r.at("r2"), r.at("h"), true);
  const std::size_t inner = c.made.object("inner", m);
  tube(c.made, smooth_sides, r.at("r1"), r.at("h"), false);
  if (to_inner) c.to = inner;
  c.rays = 1024;
  c.model_error = 1e-5;
}
void outer_to_inner(const CaseRecord& r, Case& c) { cylinders(r, c, true); }
void outer_to_itself(const CaseRecord& r, Case& c) { cylinders(r, c, false); }

// Objects 0, 1, 2: base, top, side.
void closed_cylinder(double radius, double h, Case& c) {
  const double r = same_area_radius(smooth_sides, radius);
  const std::uint32_t m = c.made.material(0.5);
  c.made.object("base", m);
  c.made.ring(smooth_sides, 0, 0, r, 0);
  c.made.object("top", m);
  c.made.ring(smooth_sides, 0, h, r, h, true);
  c.made.object("side", m);
  c.made.ring(smooth_sides, r, 0, r, h);
  c.rays = 512;
  c.model_error = 5e-6;
}

void cavity(const CaseRecord& r, Case& c, std::size_t from, std::size_t to) {
  closed_cylinder(r.at("r"), r.at("h"), c);
  c.from = from;
  c.to = to;
}
void side_to_itself(const CaseRecord& r, Case& c) { cavity(r, c, 2, 2); }
void base_to_side(const CaseRecord& r, Case& c) { cavity(r, c, 0, 2); }
void side_to_base(const CaseRecord& r, Case& c) { cavity(r, c, 2, 0); }

// All three zones together: the values are for a network of whole surfaces.
void cylinder_network(const CaseRecord& r, Case& c) {
  closed_cylinder(1.0, 1.5, c);
  c.kind = CaseKind::Network;
  c.zone_reflectance = r.parameters.at("rho");
  c.zone_exitance = r.parameters.at("E");
  c.from = r.name.find("side") != std::string::npos ? 2 : 0;
}

// Base over lateral area is the sine of the faces' half angle, so that a pyramid with this angle
// has exactly the cone's factor.
void cone(const CaseRecord& r, Case& c) {
  const double half_angle = base::radians(r.at("half_angle_deg"));
  const double radius = 1.0 / std::cos(base::pi / corners), h = 1.0 / std::tan(half_angle);
  const std::uint32_t m = c.made.material(0.5);
  c.to = c.made.object("base", m);
  c.made.ring(corners, 0, 0, radius, 0);
  c.from = c.made.object("lateral", m);
  c.made.ring(corners, radius, 0, 0, h);
  c.rays = 4096;
}

constexpr CaseBuilder builders[] = {{"coaxial_disks", disks},
                                    {"disk_r1_to_annulus", disk_to_annulus},
                                    {"annulus_", annuli},
                                    {"dA_on_axis_to_disk", element_to_disk},
                                    {"dA_corner_to_parallel_rect", element_to_facing_rectangle},
                                    {"dA_corner_to_perp_rect", element_to_wall},
                                    {"dA_to_sphere", element_to_sphere},
                                    {"sphere_to_coaxial_disk", sphere_to_disk},
                                    {"sphere_to_rect", sphere_to_rectangle},
                                    {"sphere_r", sphere_to_sphere},
                                    {"concentric_spheres", spheres_in_spheres},
                                    {"infinite_concentric_cyl_outer_self", endless_cylinders},
                                    {"finite_concentric_cyl_outer_to_inner", outer_to_inner},
                                    {"finite_concentric_cyl_outer_self", outer_to_itself},
                                    {"cylinder_inside_self", side_to_itself},
                                    {"cylinder_base_to_side", base_to_side},
                                    {"cylinder_side_to_base", side_to_base},
                                    {"closed_cylinder_3zone", cylinder_network},
                                    {"cone_", cone}};

}  // namespace

std::span<const CaseBuilder> round_builders() { return builders; }

}  // namespace earthshine::tests
