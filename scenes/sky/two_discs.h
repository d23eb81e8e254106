// SPDX-License-Identifier: Apache-2.0
// Two overlapping discs on the sphere of directions, such as the Sun's and the Earth's. Angles in
// radians; discs up to a hemisphere.
#pragma once

#include <algorithm>

namespace earthshine::scenes {

// Solid angle of one disc, sr.
[[nodiscard]] double disc_solid_angle(double radius);

// Arc of the rim of a disc of radius `rim` that another disc, of radius `other` at distance
// `separation`, covers: half the arc's angle about the rim's centre, 0 to pi.
[[nodiscard]] double covered_half_arc(double rim, double other, double separation);

// Solid angle of the intersection, sr: two sectors minus the kite of both centres and the
// intersections of the rims. Tovchigrechko and Vakser 2001 have the same sum. Here half-angle
// formulas give the angles and L'Huilier's formula the kite, so that discs of a thousandth of a
// degree are accurate to nine digits.
[[nodiscard]] double shared_solid_angle(double a, double b, double separation);

// A disc and another that may hide part of it: the Sun's and the Earth's.
struct SunAndEarth {
  double radius, limb, separation;
  // Solid angle of the part of the Sun within `rim` of its middle that the Earth does not hide.
  [[nodiscard]] double left(double rim) const {
    return disc_solid_angle(rim) - shared_solid_angle(rim, limb, separation);
  }
  // Of the Sun's disc, where the two touch.
  [[nodiscard]] double sun_share() const {
    return std::clamp(left(radius) / disc_solid_angle(radius), 0.0, 1.0);
  }
  [[nodiscard]] bool touch() const {
    return separation < radius + limb && separation + radius > limb;
  }
};

}  // namespace earthshine::scenes
