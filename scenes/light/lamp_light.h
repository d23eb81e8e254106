// SPDX-License-Identifier: Apache-2.0
// What a source of finite extent gives a point: one sample of its light, and where its flux goes.
#pragma once

#include <optional>

#include "scenes/light_ways.h"
#include "scenes/scene.h"

namespace earthshine::scenes {

// One shadowed sample of a source, seen from a point.
struct LightSample {
  Vec3 direction{0.0};      // unit, toward the source
  double distance_m = 0.0;  // infinite for the sky
  Rgb normal_illuminance_lx{
      0.0};  // on a plane facing `direction`, divided by the sample's density; nothing in between
  std::uint32_t mirror = no_mirror;  // that throws it; the distance is that of the whole way
};

// The cosine of half the field, beyond which a spot lamp sends nothing.
[[nodiscard]] double field_cosine(const Lamp& lamp);
// Shape of a spot's intensity against the angle from its axis: 1 inside beam_deg, smoothstep in the
// cosine, 0 outside field_deg. Its flux is I 2 pi (1 - (cos(beam/2) + cos(field/2)) / 2) exactly.
[[nodiscard]] double spot_profile(const Lamp& lamp, double cos_angle);

// What (u, v) are even over: what leaves least noise where the point is, or always the same points
// of the source, wherever it is seen from.
enum class Spread { Best, OverArea };

// (u, v) in [0,1)^2 choose the point of a rectangle or disk; other lamps do not use them.
[[nodiscard]] LightSample sample_lamp(const Lamp& lamp, const Vec3& point, double u, double v,
                                      Spread spread = Spread::Best);

[[nodiscard]] Rgb lamp_flux_lm(const Lamp& lamp);

// A ray leaving the lamp, and its share of the flux relative to the mean ray (1 on average).
struct EmittedRay {
  Vec3 origin, direction;
  double weight = 1.0;
};
[[nodiscard]] EmittedRay emit_from_lamp(const Lamp& lamp, double u, double v, double x, double y);

// Distance at which a ray meets the shining side of a rectangle or disk lamp and its radiance
// there; nothing for lamps without a surface.
struct LampHit {
  double distance_m;
  Rgb radiance;
};
[[nodiscard]] std::optional<LampHit> hit_lamp(const Lamp& lamp, const Vec3& origin,
                                              const Vec3& direction);

// A direction with density cos / pi about frame.normal.
[[nodiscard]] Vec3 cosine_direction(const base::Frame3& frame, double x, double y);

// Light that reaches a point from a distant disc of directions, sampled uniformly over its solid
// angle.
[[nodiscard]] Vec3 sample_cone(const Vec3& axis, double half_angle_rad, double u, double v);
[[nodiscard]] double cone_solid_angle_sr(double half_angle_rad);

}  // namespace earthshine::scenes
