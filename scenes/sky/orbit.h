// SPDX-License-Identifier: Apache-2.0
// A circular orbit about a spherical Earth: where Sun, Earth and the Earth's north pole stand as
// the spacecraft sees them, and when it is in the Earth's shadow. Directions are unit vectors in
// the scene's frame: x aft, y starboard, z out of the bay.
//
// Along the orbit the local-vertical frame is (velocity v, orbit normal n = r x v, zenith r). The
// position phi is the angle from orbit noon along the motion, the Sun
//   cos beta cos phi r - cos beta sin phi v + sin beta n.
// Over the hours of an orbit Sun and orbit plane stand still (the Sun moves 1 deg, the node some
// 7 deg a day).
#pragma once

#include <optional>
#include <string_view>

#include "scenes/scene.h"

namespace earthshine::scenes {

// The Earth's gravitational constant times its mass, WGS 84 (NIMA TR8350.2, 2000), m^3/s^2.
inline constexpr double earth_gm_m3_s2 = 3.986004418e14;

// Kepler: 2 pi sqrt(a^3 / GM), a = base::earth_radius_m + altitude_m.
[[nodiscard]] double orbit_period_s(double altitude_m);

// The attitudes that have a name.
//   bay-to-earth: z to the Earth, nose forward; bay-to-space: z to the zenith, nose forward;
//   tail-down: tail to the Earth, bay forward; bay-to-sun: z to the Sun, nose toward n.
inline constexpr std::string_view orbit_attitudes[] = {"bay-to-earth", "bay-to-space", "bay-to-sun",
                                                       "tail-down"};
// The attitude that Orbit::inertial_as has at Orbit::inertial_at_deg, kept in inertial space.
inline constexpr std::string_view inertial_attitude = "inertial";

// The scene's axes x and z, by their components along (velocity, normal, zenith).
struct BodyAxes {
  Vec3 aft, out_of_bay;
  // Along the scene's axes, unit.
  [[nodiscard]] Vec3 in_scene(const Vec3& d) const;
};
// Of an attitude that has a name, with the Sun there. Throws base::Error (Input) for another.
[[nodiscard]] BodyAxes named_axes(std::string_view attitude, const Vec3& sun);

struct OrbitState {
  double position_deg = 0.0;  // as asked, not brought to one turn
  double time_s = 0.0;        // since orbit noon, negative before it
  Vec3 sun{0.0}, earth{0.0};  // toward the Sun and the Earth's centre
  Vec3 velocity{0.0};         // the direction of flight
  Vec3 north{0.0};            // along the Earth's axis, northward
  double latitude_deg = 0.0;  // of the point below the spacecraft: asin(sin i sin u)
};

// Any position, beyond one turn too. Throws base::Error (Input) for an attitude that is none of
// orbit_attitudes, and where a table of attitudes has no row on both sides (one row holds
// everywhere).
[[nodiscard]] OrbitState orbit_state(const Orbit& orbit, double position_deg);

// Sets the scene's Sun and Earth, and the pole of its albedo by latitude, to that position. Throws
// base::Error (Input) like orbit_state, and for a scene without [orbit].
void move_along_orbit(Scene& scene, double position_deg);

// The part of one turn, from orbit noon on, that is in shadow: positions from 0 to 360 deg and the
// times since that noon. The middle is orbit midnight, 180 deg; 0 to 360 when it never ends.
struct ShadowSpan {
  double begin_deg = 0.0, end_deg = 0.0;
  double begin_s = 0.0, end_s = 0.0;
};
struct Eclipse {
  std::optional<ShadowSpan> penumbra;  // some of the Sun's disc is hidden: visible_sun_share < 1
  std::optional<ShadowSpan> umbra;     // all of it, within the penumbra
};

// Closed form. The Sun stands at acos(-cos beta cos phi) from the Earth's centre; its disc, of the
// angular radius r, touches the Earth's, of the half angle rho, at rho + r and is gone at rho - r.
// With eta = acos(cos(rho +- r) / cos beta) the spans are 180 deg -+ eta.
[[nodiscard]] Eclipse find_eclipse(const Orbit& orbit, double sun_angular_radius_deg);

}  // namespace earthshine::scenes
