// SPDX-License-Identifier: Apache-2.0
// Two discs on the sphere of directions, as the Sun's and the Earth's, one before the other. Angles
// in radians, of discs up to a half sphere.
#pragma once

namespace earthshine::scenes {

// Of one disc, sr.
[[nodiscard]] double disc_solid_angle(double radius);

// Of the rim of a disc of radius `rim` that the other, of radius `other` about a centre at
// `separation`, covers: half of the arc about the rim's own centre, 0 to pi.
[[nodiscard]] double covered_half_arc(double rim, double other, double separation);

// Solid angle of what both cover, sr: two sectors less the kite of both centres and the points
// where the rims cross (Tovchigrechko and Vakser 2001 give the same sum; here the angles are by
// half-angle formulas and the kite by L'Huilier's, so that discs of a thousandth of a degree keep
// nine digits).
[[nodiscard]] double shared_solid_angle(double a, double b, double separation);

// A disc and another that may hide some of it: the Sun's and the Earth's.
struct SunAndEarth {
  double radius, limb, separation;
  // Solid angle of what the Earth leaves of the Sun, as far as `rim` from its middle.
  [[nodiscard]] double left(double rim) const {
    return disc_solid_angle(rim) - shared_solid_angle(rim, limb, separation);
  }
  [[nodiscard]] bool touch() const {
    return separation < radius + limb && separation + radius > limb;
  }
};

}  // namespace earthshine::scenes
