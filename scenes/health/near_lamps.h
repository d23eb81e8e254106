// SPDX-License-Identifier: Apache-2.0
// Lamps that stand so near a surface that what it reflects of them is hard to find.
#pragma once

#include "base/units.h"
#include "scenes/scene.h"

namespace earthshine::scenes {

// The point of the triangle a, b, c that is nearest to p (Ericson, "Real-Time Collision Detection",
// 2005, 5.1.5).
[[nodiscard]] Vec3 nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

// A warning for each lamp without size that is less than a centimetre, and less than a thousandth
// of the surfaces' extent, from a surface: half of its light falls on a spot that no path finds by
// chance.
void name_near_lamps(Scene& scene);

}  // namespace earthshine::scenes
