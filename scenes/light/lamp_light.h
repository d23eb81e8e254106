// SPDX-License-Identifier: Apache-2.0
// What a source of finite extent gives a point: one sample of its light, and where its flux goes.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "scenes/scene.h"
#include "scenes/specular_paths.h"

namespace earthshine::scenes {

// One shadowed sample of a source, seen from a point.
struct LightSample {
  Vec3 direction{0.0};      // unit, toward the source
  double distance_m = 0.0;  // infinite for the sky
  Rgb normal_illuminance_lx{
      0.0};  // on a plane facing `direction`, divided by the sample's density; nothing in between
  std::uint32_t mirror = no_mirror;  // that throws it; the distance is that of the whole way
  Vec3 lift_m{0.0};  // of a surface: off it, by its offset (surface_offset.h), toward the point
};

// The shadow ray of a point's sample that starts at `origin`, off the point's surface: it goes to
// the same place of the source, or its image in a mirror, and stops short of it, which may be a
// surface of the scene. reach_m is 0 where the source is at the point.
struct ShadowSegment {
  Vec3 direction{0.0};
  double reach_m = 0.0;
};
[[nodiscard]] ShadowSegment shadow_segment(const LightSample& sample, const Vec3& point,
                                           const Vec3& origin);

// The cosine of half the field, beyond which a spot lamp sends nothing.
[[nodiscard]] double field_cosine(const Lamp& lamp);
// Shape of a spot's intensity against the angle from its axis: 1 inside beam_deg, smoothstep in the
// cosine, 0 outside field_deg. Its flux is I 2 pi (1 - (cos(beam/2) + cos(field/2)) / 2) exactly.
[[nodiscard]] double spot_profile(const Lamp& lamp, double cos_angle);

// The two cosines, for who asks of a spot lamp often.
struct SpotCone {
  double beam_cosine, field_cosine;
  [[nodiscard]] double profile(double cos_angle) const;
};
[[nodiscard]] SpotCone spot_cone(const Lamp& lamp);

// What (u, v) are even over: what leaves least noise where the point is, or always the same points
// of the source, wherever it is seen from.
enum class Spread { Best, OverArea };

// (u, v) in [0,1)^2 choose the point of a rectangle or disk; other lamps do not use them.
[[nodiscard]] LightSample sample_lamp(const Lamp& lamp, const Vec3& point, double u, double v,
                                      Spread spread = Spread::Best);

// The same of a spot lamp, whose cone is `cone`.
[[nodiscard]] LightSample sample_spot(const Lamp& lamp, const SpotCone& cone, const Vec3& point);

// Of a distant lamp 0: how much of its light is caught depends on the surfaces.
[[nodiscard]] Rgb lamp_flux_lm(const Lamp& lamp);

// Not of a distant lamp. A ray leaving the lamp, and its share of the flux relative to the mean ray (1 on average).
struct EmittedRay {
  Vec3 origin, direction;
  double weight = 1.0;
  Vec3 lift_m{0.0};  // of a surface: off it, by its offset (surface_offset.h)
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

// Light that reaches a point from a distant disc of directions, sampled uniformly over its solid
// angle.
class Cone {
 public:
  Cone(const Vec3& axis, double half_angle_rad);
  [[nodiscard]] Vec3 sample(double u, double v) const;
  // The same in two steps: coordinates about the axis, which cones as wide share, to a direction.
  [[nodiscard]] Vec3 local(double u, double v) const;
  [[nodiscard]] Vec3 at(const Vec3& local) const { return frame_.to_world(local); }

 private:
  base::Frame3 frame_;
  double most_;  // 1 - cos at its edge
};
[[nodiscard]] inline Vec3 sample_cone(const Vec3& axis, double half_angle_rad, double u, double v) {
  return Cone(axis, half_angle_rad).sample(u, v);
}
[[nodiscard]] double cone_solid_angle_sr(double half_angle_rad);

// Whether light may come from outside of all surfaces: Sun, Earth or a distant lamp.
[[nodiscard]] bool has_light_outside(const Scene& scene);

// Light of a source that a flat mirror throws onto a point: that of the source's image.

// sample: of the source itself, as the mirror's image of `point` sees it. What comes out is seen
// from the point; its light is 0 where the mirror lies elsewhere. The mirror's own share is not in
// it: RayQuery::light_shares has that of the very place. Flat mirrors keep areas and angles, so
// that the whole way takes the place of the distance.
[[nodiscard]] LightSample thrown(const LightSample& sample, const FlatMirror& mirror,
                                 std::uint32_t number, const Vec3& point);

// False where the mirror lies elsewhere for all of a distant disc of that angle, in radians: told
// without a sample.
[[nodiscard]] bool disc_may_be_thrown(const Vec3& direction, double angle, const FlatMirror& mirror,
                                      const Vec3& point);

// What tells the kinds of lamps apart, a row each; their light is in lamp_light.h, their keys in
// scenes/read/lamp.cpp.

struct LampRow {
  std::string_view type;  // as scene files have it
  // Of the surface that shines, by its exitance: m^2, and the radius of the ball around it in m.
  // Null for what shines from a point, by its intensity.
  double (*area)(const Lamp&);
  double (*radius)(const Lamp&);
};
// In LampKind's order.
inline constexpr std::array<LampRow, 6> lamp_rows = {{
    {"point", nullptr, nullptr},
    {"spot", nullptr, nullptr},
    {"rectangle",
     [](const Lamp& lamp) { return glm::length(glm::cross(lamp.edge_u, lamp.edge_v)); },
     [](const Lamp& lamp) {
       return 0.5 * glm::max(glm::length(lamp.edge_u + lamp.edge_v),
                             glm::length(lamp.edge_u - lamp.edge_v));
     }},
    {"disk", [](const Lamp& lamp) { return base::pi * lamp.radius_m * lamp.radius_m; },
     [](const Lamp& lamp) { return lamp.radius_m; }},
    {"ies", nullptr, nullptr},
    {"distant", nullptr, nullptr},
}};

[[nodiscard]] constexpr const LampRow& row_of(LampKind kind) {
  return lamp_rows[static_cast<std::size_t>(kind)];
}
// A wide lamp has a surface: it can be seen, hidden in part, distributed.
[[nodiscard]] constexpr bool is_wide(LampKind kind) { return row_of(kind).area != nullptr; }

}  // namespace earthshine::scenes
