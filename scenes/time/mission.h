// SPDX-License-Identifier: Apache-2.0
// A spacecraft as a function of time: trajectory, attitude, and the resulting sky.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "scenes/time/attitude_history.h"
#include "scenes/time/trajectory.h"

namespace earthshine::scenes {

// [time]: start, start + step, ... to stop.
struct TimeSpan {
  Instant start, stop;
  double step_s = 0.0;  // 0: a single time

  [[nodiscard]] std::size_t count() const;
  [[nodiscard]] Instant at(std::size_t k) const { return start + step_s * static_cast<double>(k); }
};

struct Mission {
  TimeSpan time;
  Instant moment;         // of the scene's own Sun, Earth and joints
  bool has_span = false;  // [time] gives more than one moment
  std::shared_ptr<const Trajectory> trajectory;
  std::string attitude = "bay-to-earth";     // of orbit_attitudes or "inertial"; empty: history
  std::string inertial_as = "bay-to-earth";  // attitude at time.start, then fixed
  std::shared_ptr<const AttitudeHistory> history;
  glm::dmat3 body_axes{1.0};  // columns: the history's body axes in the scene
  EarthClock clock;
  // Where the scene leaves them open, both follow the Sun's distance.
  bool sun_illuminance_by_date = true, sun_radius_by_date = true;
  bool ellipsoid = true;  // what hides the Sun: WGS 84, or a sphere of base::earth_radius_m
};

struct MissionState {
  Vec3 sun{0.0}, earth{0.0}, north{0.0};  // in the scene, unit
  double limb_deg = 0.0;                  // from the Earth's centre to its limb toward the Sun
  double distance_m = 0.0;                // from the Earth's centre
  double sun_distance_m = 0.0;            // from the spacecraft
  double beta_deg = 0.0;                  // elevation of the Sun above the orbital plane
  double position_deg = 0.0;              // from orbit noon in the direction of motion, 0 to 360
  GroundPoint below;
};

// Throws base::Error (Input) outside the trajectory or the attitude history.
[[nodiscard]] MissionState mission_state(const Mission& mission, Instant t);

// Takes directions in GCRS to the scene's axes.
[[nodiscard]] glm::dmat3 scene_axes(const Mission& mission, Instant t);

// Of the scene; null without.
[[nodiscard]] const Mission* mission_of(const Scene& scene);

// Sets the scene's Sun, Moon, Earth and circle, and what its albedo goes by, to that moment of its
// mission. The Earth's disc is round; its limb toward the Sun is the ellipsoid's.
void move_to_moment(Scene& scene, Instant t);

// When the Earth hides the Sun; ends outside the span asked for
// are left out.
struct EclipseTimes {
  std::optional<Instant> penumbra_begin, umbra_begin, umbra_end, penumbra_end;
};
// Eclipses between two times of the trajectory, in order: sampled every 15 s, then bisected to 1
// ms.
[[nodiscard]] std::vector<EclipseTimes> eclipses_between(const Mission& mission, Instant from,
                                                         Instant to, double sun_angular_radius_deg);

// From the Earth's centre to its limb, as seen from `position_m` on the side of `toward` (unit),
// rad. The ellipsoid of WGS 84 about `pole` (unit), both in GCRS.
[[nodiscard]] double ellipsoid_limb_rad(const Vec3& position_m, const Vec3& toward,
                                        const Vec3& pole);

// Of the Kepler orbit through the state at t, s; none on a parabola or hyperbola.
[[nodiscard]] std::optional<double> period_at(const Mission& mission, Instant t);

// How far the spacecraft goes around the Earth from one time to a later one, with all full
// revolutions, deg. Across a gap of the trajectory they follow from the period before it; neither
// time is in a gap. Throws base::Error (Input) as Trajectory::at.
[[nodiscard]] double revolved_deg(const Mission& mission, Instant from, Instant to);

}  // namespace earthshine::scenes
