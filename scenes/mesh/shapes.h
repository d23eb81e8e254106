// SPDX-License-Identifier: Apache-2.0
// Shapes as meshes: polygons with outward normals. Vertices of round shapes lie on the true
// surface, so that the polygons have slightly less area.
#pragma once

#include <span>

#include "base/units.h"
#include "scenes/mesh.h"

namespace earthshine::scenes {

inline constexpr int fewest_segments = 3;
inline constexpr int most_segments = 4096;

enum class QuadFault { None, NoArea, NotFlat, NotConvex };
// Checks that it is convex, and flat to 1e-6 of its size.
[[nodiscard]] QuadFault check_quad(std::span<const Vec3, 4> corners);

[[nodiscard]] Mesh make_quad(std::span<const Vec3, 4> corners);
[[nodiscard]] Mesh make_box(const Vec3& low, const Vec3& high);
// Latitudes and longitudes: `segments` around the z axis, half as many from pole to pole.
[[nodiscard]] Mesh make_sphere(const Vec3& center, double radius, int segments);
[[nodiscard]] Mesh make_cylinder(const Vec3& from, const Vec3& to, double radius, int segments,
                                 bool caps);
// A triangle fan around the centre; `normal` of unit length.
[[nodiscard]] Mesh make_disk(const Vec3& center, const Vec3& normal, double radius, int segments);

}  // namespace earthshine::scenes
