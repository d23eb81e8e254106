// SPDX-License-Identifier: Apache-2.0
// A circular orbit about a spherical Earth: directions of Sun, Earth and the Earth's north pole
// from the spacecraft, and its passage through the Earth's shadow. Directions are unit vectors in
// the scene's frame: x aft, y starboard, z out of the bay.
//
// Along the orbit the local-vertical frame is (velocity v, orbit normal n = r x v, zenith r). The
// position phi is the angle from orbit noon in the direction of motion. The direction of the Sun is
//   cos beta cos phi r - cos beta sin phi v + sin beta n.
// During one orbit Sun and orbital plane are fixed (the Sun moves by 1 deg, the node by some 7 deg
// a day).
#pragma once

#include <optional>
#include <string_view>

#include "scenes/scene.h"

namespace earthshine::scenes {

// The Earth's gravitational constant times its mass, WGS 84 (NIMA TR8350.2, 2000), m^3/s^2.
inline constexpr double earth_gm_m3_s2 = 3.986004418e14;

// Kepler: 2 pi sqrt(a^3 / GM), a = base::earth_radius_m + altitude_m.
[[nodiscard]] double orbit_period_s(double altitude_m);

// The named attitudes.
//   bay-to-earth: z to the Earth, nose forward; bay-to-space: z to the zenith, nose forward;
//   tail-down: tail to the Earth, bay forward; bay-to-sun: z to the Sun, nose toward n.
inline constexpr std::string_view orbit_attitudes[] = {"bay-to-earth", "bay-to-space", "bay-to-sun",
                                                       "tail-down"};
// The attitude of Orbit::inertial_as at Orbit::inertial_at_deg, fixed in inertial space.
inline constexpr std::string_view inertial_attitude = "inertial";

// The scene's axes x and z as components along (velocity, normal, zenith).
struct BodyAxes {
  Vec3 aft, out_of_bay;
  // Unit vector in scene axes.
  [[nodiscard]] Vec3 in_scene(const Vec3& d) const;
};
// Axes of a named attitude for the Sun's direction. Throws base::Error (Input) for unknown names.
[[nodiscard]] BodyAxes named_axes(std::string_view attitude, const Vec3& sun);

struct OrbitState {
  double position_deg = 0.0;  // as requested, not reduced to one revolution
  double time_s = 0.0;        // since orbit noon, negative before it
  Vec3 sun{0.0}, earth{0.0};  // toward the Sun and the Earth's centre
  Vec3 velocity{0.0};         // the direction of flight
  Vec3 north{0.0};            // along the Earth's axis, northward
  double latitude_deg = 0.0;  // of the point below the spacecraft: asin(sin i sin u)
};

// Any position, including beyond one revolution. Throws base::Error (Input) for an unknown
// attitude, and if a table of attitudes has no row on both sides (a single row is valid
// everywhere).
[[nodiscard]] OrbitState orbit_state(const Orbit& orbit, double position_deg);

// Sets the directions of Sun, Earth and the Earth's north pole for an orbit position. Throws
// base::Error (Input) like orbit_state, and for a scene without [orbit].
void move_along_orbit(Scene& scene, double position_deg);

// Part of one revolution from orbit noon on that is in shadow: positions from 0 to 360 deg and
// times since that noon. The middle is orbit midnight, 180 deg; 0 to 360 if the shadow never ends.
struct ShadowSpan {
  double begin_deg = 0.0, end_deg = 0.0;
  double begin_s = 0.0, end_s = 0.0;
};
struct Eclipse {
  std::optional<ShadowSpan> penumbra;  // part of the Sun is hidden: visible_sun_share < 1
  std::optional<ShadowSpan> umbra;     // the Earth hides all of it; within the penumbra
};

// Closed form. The Sun is at acos(-cos beta cos phi) from the Earth's centre. Its disc, of angular
// radius r, touches the Earth's disc, of half angle rho, at rho + r and is hidden at rho - r. With
// eta = acos(cos(rho +- r) / cos beta) the spans are 180 deg -+ eta.
[[nodiscard]] Eclipse find_eclipse(const Orbit& orbit, double sun_angular_radius_deg);

}  // namespace earthshine::scenes
