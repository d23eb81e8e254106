// SPDX-License-Identifier: Apache-2.0
// Scenes for the case library: named objects of polygons. Each polygon becomes one patch (or two,
// if a quadrilateral is not a parallelogram), so that the case decides its division into patches.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "scenes/scene.h"

namespace earthshine::tests {

class CaseScene {
 public:
  scenes::Scene scene;

  std::uint32_t material(double diffuse, double emit = 0.0, bool two_sided = false);
  std::uint32_t mirror();

  // Starts a new object for the following polygons. Returns its number.
  std::size_t object(const std::string& name, std::uint32_t material);

  // The front is the side from which the corners run counter-clockwise.
  void triangle(const Vec3& a, const Vec3& b, const Vec3& c);
  void quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
  // Parallelogram corner + s u + t v in rows x columns cells; front along u x v.
  void grid(const Vec3& corner, const Vec3& u, const Vec3& v, int rows, int columns);
  // Rectangle at height z; front up or down.
  void level(double x0, double x1, double y0, double y1, double z, bool up, int rows, int columns);

  // Rings with n corners about the z axis, between polygons of circumradius r0 and r1 (r0 may be 0)
  // at heights z0 and z1. Flat rings are disks and annuli, steep ones cylinders and cones. The
  // front is up for flat rings with r0 < r1, inward for cylinders with z0 < z1; `flip` reverses it.
  void ring(int n, double r0, double z0, double r1, double z1, bool flip = false);

  // Geodesic sphere of 20 4^level triangles with the surface area of a sphere of this radius; the
  // front is outside unless `inward`.
  void sphere(const Vec3& centre, double radius, int level, bool inward = false);

 private:
  std::uint32_t vertex(const Vec3& p);
  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c);

  std::uint32_t material_ = 0;
  std::uint32_t polygon_ = 0;
};

// Circumradius of the regular n-gon with the area, or the circumference, of a circle.
[[nodiscard]] double same_area_radius(int n, double radius);
[[nodiscard]] double same_length_radius(int n, double radius);

}  // namespace earthshine::tests
