// SPDX-License-Identifier: Apache-2.0
// Colour, vectors and constants shared by every layer. Photometric units throughout
// (docs/theory.md): linear RGB with Rec. 709 primaries, lengths in metres, angles in radians unless
// the name says _deg.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

namespace earthshine {

// Any photometric quantity per channel; the variable's name has its meaning and unit.
using Rgb = glm::dvec3;
using Vec3 = glm::dvec3;

namespace base {

inline constexpr double pi = std::numbers::pi;

[[nodiscard]] constexpr double squared(double x) { return x * x; }
inline constexpr double earth_radius_m = 6371e3;

// Y = 0.2126 R + 0.7152 G + 0.0722 B (Rec. 709).
[[nodiscard]] inline double luminance(const Rgb& radiance) {
  return 0.2126 * radiance.r + 0.7152 * radiance.g + 0.0722 * radiance.b;
}

[[nodiscard]] inline double max_component(const Rgb& c) {
  return std::max(c.r, std::max(c.g, c.b));
}

[[nodiscard]] inline bool is_lit(const Rgb& c) { return max_component(c) > 0.0; }

// sin(pi x) / (pi x)
[[nodiscard]] inline double sinc(double x) { return x == 0.0 ? 1.0 : std::sin(pi * x) / (pi * x); }

[[nodiscard]] constexpr double radians(double degrees) { return degrees * (pi / 180.0); }
[[nodiscard]] constexpr double degrees(double radians_) { return radians_ * (180.0 / pi); }

// Right-handed orthonormal frame whose third axis is the unit vector `normal`
// (Duff et al. 2017, "Building an Orthonormal Basis, Revisited": no singularity).
struct Frame3 {
  Vec3 tangent, bitangent, normal;
  [[nodiscard]] Vec3 to_world(const Vec3& local) const {
    return tangent * local.x + bitangent * local.y + normal * local.z;
  }
};
[[nodiscard]] inline Frame3 frame_around(const Vec3& n) {
  const double sign = std::copysign(1.0, n.z);
  const double a = -1.0 / (sign + n.z);
  const double b = n.x * n.y * a;
  return {{1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}

}  // namespace base
}  // namespace earthshine
