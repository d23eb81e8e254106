// SPDX-License-Identifier: Apache-2.0
// Directions to a flat figure, uniform in its solid angle. Near a lamp they have much less noise
// than points uniform over its area, whose light varies as cos / r^2.
#pragma once

#include "base/units.h"

namespace earthshine::scenes {

struct SolidAngleSample {
  Vec3 direction{0.0};  // unit
  double solid_angle_sr = 0.0;
};

// Rectangle corner + [0,1] edge_u + [0,1] edge_v with perpendicular edges, seen from `point`, which
// is not in its plane (Urena, Fajardo and King 2013, "An area-preserving parametrization for
// spherical rectangles").
[[nodiscard]] SolidAngleSample sample_rectangle(const Vec3& point, const Vec3& corner,
                                                const Vec3& edge_u, const Vec3& edge_v, double u,
                                                double v);

// Triangle corner, corner + edge1, corner + edge2 (Arvo 1995, "Stratified sampling of spherical
// triangles"). Solid angle 0 if it vanishes by rounding.
[[nodiscard]] SolidAngleSample sample_triangle(const Vec3& point, const Vec3& corner,
                                               const Vec3& edge1, const Vec3& edge2, double u,
                                               double v);

}  // namespace earthshine::scenes
