// SPDX-License-Identifier: Apache-2.0
#include "scenes/time/mission.h"

#include <algorithm>
#include <cmath>

#include "scenes/sky/moon.h"
#include "scenes/sky/orbit.h"
#include "scenes/sky/sky.h"

namespace earthshine::scenes {
namespace {

constexpr double sun_radius_m = 695.7e6;  // IAU 2015 resolution B3
constexpr double eclipse_step_s = 15.0;
constexpr double eclipse_error_s = 1e-3;
// Of sqrt(r^3 / GM). A fall from r to the centre takes sqrt(2) / 3 of it at least, so that a step
// on an ellipse ends beyond r / 2, and goes less than half a revolution.
constexpr double longest_step_share = 0.3;

// Unit vectors in GCRS.
struct LocalFrame {
  Vec3 velocity, normal, zenith;

  explicit LocalFrame(const State& state)
      : normal(glm::normalize(glm::cross(state.position_m, state.velocity_m_s))),
        zenith(glm::normalize(state.position_m)) {
    velocity = glm::cross(normal, zenith);
  }
  [[nodiscard]] Vec3 components(const Vec3& d) const {
    return {glm::dot(d, velocity), glm::dot(d, normal), glm::dot(d, zenith)};
  }
  [[nodiscard]] Vec3 from_components(const Vec3& c) const {
    return c.x * velocity + c.y * normal + c.z * zenith;
  }
};

// From the spacecraft: in low orbit 0.003 deg from the direction at the Earth's centre.
Vec3 sun_offset_m(const State& state, Instant t) {
  return sun_direction(t) * sun_distance_m(t) - state.position_m;
}
Vec3 sun_from(const State& state, Instant t) { return glm::normalize(sun_offset_m(state, t)); }

// Transforms directions from GCRS to the scene.
class SceneAxes {
 public:
  SceneAxes(const Mission& mission, const LocalFrame& local, const Vec3& sun, Instant t)
      : local_(local) {
    if (mission.history) {
      to_body_ = mission.body_axes * glm::mat3_cast(glm::conjugate(mission.history->at(
                                         t, mission.trajectory->longest_gap_s(t))));
    } else if (mission.attitude == inertial_attitude) {
      const State kept = mission.trajectory->at(mission.time.start);
      const LocalFrame frame(kept);
      const Vec3 sun_then = sun_from(kept, mission.time.start);
      const BodyAxes axes = named_axes(mission.inertial_as, frame.components(sun_then));
      axes_ = {local.components(frame.from_components(axes.aft)),
               local.components(frame.from_components(axes.out_of_bay))};
    } else {
      axes_ = named_axes(mission.attitude, local.components(sun));
    }
  }
  [[nodiscard]] Vec3 operator()(const Vec3& d) const {
    if (to_body_) return glm::normalize(*to_body_ * d);
    return axes_.in_scene(local_.components(d));
  }

 private:
  LocalFrame local_;
  BodyAxes axes_{};
  std::optional<glm::dmat3> to_body_;
};

double angle_between(const Vec3& a, const Vec3& b) {
  return 2.0 * std::atan2(glm::length(a - b), glm::length(a + b));
}

Vec3 pole_at(const Mission& mission, Instant t) {
  return to_gcrs(Frame::Itrf, t, mission.clock) * Vec3(0.0, 0.0, 1.0);
}

// From the Earth's centre to its limb on the side of the Sun, rad.
double limb_rad(const Mission& mission, const State& state, const Vec3& sun, Instant t) {
  if (mission.ellipsoid) return ellipsoid_limb_rad(state.position_m, sun, pole_at(mission, t));
  return earth_half_angle_rad(glm::length(state.position_m) - base::earth_radius_m);
}

// How far the Sun's middle is from the Earth's limb, rad: negative behind it.
double above_limb(const Mission& mission, Instant t) {
  const State state = mission.trajectory->at(t);
  const Vec3 sun = sun_from(state, t);
  return angle_between(sun, -glm::normalize(state.position_m)) - limb_rad(mission, state, sun, t);
}

// The share of the Sun's disc that the Earth leaves uncovered at the Moon's centre, without the
// light that the atmosphere refracts into the shadow.
double sunlit_share(const Mission& mission, const Vec3& moon, const Vec3& sun, Instant t) {
  const Vec3 direction = glm::normalize(sun - moon);
  const double sun_rad = std::asin(sun_radius_m / glm::length(sun - moon));
  const SunAndEarth discs{sun_rad, limb_rad(mission, {moon, {}}, direction, t),
                          angle_between(direction, -glm::normalize(moon))};
  return discs.sun_share();
}

// The Sun's values at one astronomical unit are the defaults: illuminance by the inverse square.
void set_sun(Sun& sun, const Mission& mission, const MissionState& state) {
  const double units = state.sun_distance_m / astronomical_unit_m;
  sun.direction = state.sun;
  if (mission.sun_illuminance_by_date) sun.illuminance_lx = Sun().illuminance_lx / (units * units);
  if (mission.sun_radius_by_date) sun.angular_radius_deg = Sun().angular_radius_deg / units;
}

// The Moon from the spacecraft.
void move_moon(Scene& scene, const Mission& mission, Instant t) {
  const State state = mission.trajectory->at(t);
  const Vec3 moon = moon_position_m(t), sun = sun_direction(t) * sun_distance_m(t);
  const Vec3 away = moon - state.position_m;
  const Vec3 direction = glm::normalize(away);
  const double limb = limb_rad(mission, state, direction, t);
  scene.moon->direction = glm::normalize(scene_axes(mission, t) * direction);
  scene.moon->phase_deg =
      base::degrees(angle_between(glm::normalize(sun - moon), glm::normalize(-away)));
  scene.moon->hidden = angle_between(direction, -glm::normalize(state.position_m)) < limb;
  // The scene's Sun is the one at the spacecraft.
  const double units = glm::length(sun - state.position_m) / astronomical_unit_m;
  const Rgb sun_lx = scene.sun ? scene.sun->illuminance_lx * (units * units) : Sun().illuminance_lx;
  scene.moon->illuminance_lx = sunlit_share(mission, moon, sun, t) *
                               moon_illuminance_lx(sun_lx, scene.moon->phase_deg, glm::length(away),
                                                   glm::length(sun - moon));
}

}  // namespace

std::size_t TimeSpan::count() const {
  if (!(step_s > 0.0)) return 1;
  return static_cast<std::size_t>(std::floor((stop - start) / step_s + 1e-6)) + 1;
}

MissionState mission_state(const Mission& mission, Instant t) {
  const State state = mission.trajectory->at(t);
  const LocalFrame local(state);
  const Vec3 to_sun = sun_offset_m(state, t), sun = glm::normalize(to_sun);
  const SceneAxes in_scene(mission, local, sun, t);
  MissionState found;
  found.distance_m = glm::length(state.position_m);
  found.sun_distance_m = glm::length(to_sun);
  found.sun = in_scene(sun);
  found.earth = in_scene(-local.zenith);
  found.north = in_scene(pole_at(mission, t));
  found.limb_deg = base::degrees(limb_rad(mission, state, sun, t));
  const Vec3 s = local.components(sun);
  found.beta_deg = base::degrees(std::asin(std::clamp(s.y, -1.0, 1.0)));
  found.position_deg = base::degrees(std::atan2(-s.x, s.z));
  if (found.position_deg < 0.0) found.position_deg += 360.0;
  found.below = point_below(state.position_m, t, mission.clock);
  return found;
}

glm::dmat3 scene_axes(const Mission& mission, Instant t) {
  const State state = mission.trajectory->at(t);
  const SceneAxes in_scene(mission, LocalFrame(state), sun_from(state, t), t);
  return {in_scene({1.0, 0.0, 0.0}), in_scene({0.0, 1.0, 0.0}), in_scene({0.0, 0.0, 1.0})};
}

const Mission* mission_of(const Scene& scene) {
  return scene.orbit && scene.orbit->files ? scene.orbit->files->mission.get() : nullptr;
}

void move_to_moment(Scene& scene, Instant t) {
  const Mission& mission = *mission_of(scene);
  const MissionState state = mission_state(mission, t);
  scene.orbit->altitude_m = state.distance_m - base::earth_radius_m;
  scene.orbit->beta_deg = state.beta_deg;
  scene.orbit->position_deg = state.position_deg;
  if (scene.sun) set_sun(*scene.sun, mission, state);
  if (scene.moon) move_moon(scene, mission, t);
  if (!scene.earth) return;
  scene.earth->direction = state.earth;
  scene.earth->altitude_m = scene.orbit->altitude_m;
  scene.earth->half_angle_deg = state.limb_deg;
  if (scene.earth->by_latitude) scene.earth->by_latitude->north = state.north;
  if (scene.earth->grid) {
    scene.earth->to_ground =
        glm::transpose(scene_axes(mission, t) * to_gcrs(Frame::Itrf, t, mission.clock));
  }
}

double ellipsoid_limb_rad(const Vec3& position_m, const Vec3& toward, const Vec3& pole) {
  // Stretched along the pole the ellipsoid is a sphere; lines stay lines. Directions cos x e +
  // sin x s, e toward the centre and s across it, touch the sphere where
  // (p d)^2 = (d d) (p p - a^2), a quadratic equation in tan x.
  const auto stretched = [&](const Vec3& v) {
    return v + (1.0 / (1.0 - earth_flattening) - 1.0) * glm::dot(v, pole) * pole;
  };
  const Vec3 centre = -glm::normalize(position_m);
  const Vec3 across = toward - glm::dot(toward, centre) * centre;
  const Vec3 side =
      glm::length(across) > 0.0 ? glm::normalize(across) : base::frame_around(centre).tangent;
  const Vec3 p = stretched(position_m), e = stretched(centre), s = stretched(side);
  const double beyond = glm::dot(p, p) - earth_equator_m * earth_equator_m;
  const double pe = glm::dot(p, e), ps = glm::dot(p, s);
  const double a = ps * ps - glm::dot(s, s) * beyond;
  const double b = 2.0 * (pe * ps - glm::dot(e, s) * beyond);
  const double c = pe * pe - glm::dot(e, e) * beyond;
  // One root on each side of the centre; a < 0 < c outside the ellipsoid.
  const double root = std::sqrt(b * b - 4.0 * a * c);
  return std::atan((-b - root) / (2.0 * a));
}

std::vector<EclipseTimes> eclipses_between(const Mission& mission, Instant from, Instant to,
                                           double sun_angular_radius_deg) {
  const double sun_rad = base::radians(sun_angular_radius_deg);
  // 0: in the Sun, 1: in the penumbra, 2: in the umbra.
  const auto depth = [&](Instant t) {
    const double above = above_limb(mission, t);
    return above >= sun_rad ? 0 : above > -sun_rad ? 1 : 2;
  };
  std::vector<EclipseTimes> found;
  const auto cross = [&](Instant low, Instant high, int limit, bool enters) {
    while (high - low > eclipse_error_s) {
      const Instant middle = low + 0.5 * (high - low);
      ((depth(middle) >= limit) == enters ? high : low) = middle;
    }
    if (found.empty() || (enters && limit == 1)) found.emplace_back();
    EclipseTimes& eclipse = found.back();
    (limit == 1 ? (enters ? eclipse.penumbra_begin : eclipse.penumbra_end)
                : (enters ? eclipse.umbra_begin : eclipse.umbra_end)) = high;
  };
  int before = depth(from);
  if (before > 0) found.emplace_back();
  for (Instant t = from; t < to;) {
    const Instant next = std::min(t + eclipse_step_s, to);
    const int now = depth(next);
    for (int limit = before + 1; limit <= now; ++limit) cross(t, next, limit, true);
    for (int limit = before; limit > now; --limit) cross(t, next, limit, false);
    before = now;
    t = next;
  }
  return found;
}

std::optional<double> period_at(const Mission& mission, Instant t) {
  const State state = mission.trajectory->at(t);
  // 1 / a by vis-viva: v^2 = GM (2 / r - 1 / a).
  const double per_m = 2.0 / glm::length(state.position_m) -
                       glm::dot(state.velocity_m_s, state.velocity_m_s) / earth_gm_m3_s2;
  if (!(per_m > 0.0)) return std::nullopt;
  return 2.0 * base::pi / (per_m * std::sqrt(per_m * earth_gm_m3_s2));
}

double revolved_deg(const Mission& mission, Instant from, Instant to) {
  const Trajectory& trajectory = *mission.trajectory;
  double revolved = 0.0;
  for (Instant t = from; t < to;) {
    const State before = trajectory.at(t);
    const double r = glm::length(before.position_m);
    const double step = std::min(trajectory.longest_gap_s(t),
                                 longest_step_share * r * std::sqrt(r / earth_gm_m3_s2));
    const Instant wanted = std::min(t + step, to), next = trajectory.next_state(wanted);
    double angle = base::degrees(angle_between(glm::normalize(before.position_m),
                                               glm::normalize(trajectory.at(next).position_m)));
    if (next > wanted) {
      const Vec3 ahead = glm::cross(before.position_m, trajectory.at(next).position_m);
      if (glm::dot(ahead, glm::cross(before.position_m, before.velocity_m_s)) < 0.0) {
        angle = 360.0 - angle;
      }
      const auto period = period_at(mission, t);
      const double expected = period ? 360.0 * (next - t) / *period : angle;
      angle = expected + std::remainder(angle - expected, 360.0);
    }
    revolved += angle;
    t = next;
  }
  return revolved;
}

}  // namespace earthshine::scenes
