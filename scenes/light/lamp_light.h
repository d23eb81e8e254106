// SPDX-License-Identifier: Apache-2.0
// Light sources of finite extent: sampled illuminance at a point, and emitted flux.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "scenes/scene.h"
#include "scenes/specular_paths.h"

namespace earthshine::scenes {

// One sample of a source from a point, before the shadow test.
struct LightSample {
  Vec3 direction{0.0};      // unit, toward the source
  double distance_m = 0.0;  // infinite for the sky
  Rgb normal_illuminance_lx{
      0.0};  // on a plane facing `direction`, divided by the sample's density; without occlusion
  std::uint32_t mirror = no_mirror;  // that reflects it; distance_m is then the whole path
  Vec3 lift_m{0.0};  // offset from the source's surface (surface_offset.h), toward the point
};

// The shadow ray of a point's sample from `origin`, off the point's surface, to the same place of
// the source, or its mirror image. It ends just before the source, which may be a surface of the
// scene. reach_m is 0 if the source is at the point.
struct ShadowSegment {
  Vec3 direction{0.0};
  double reach_m = 0.0;
};
[[nodiscard]] ShadowSegment shadow_segment(const LightSample& sample, const Vec3& point,
                                           const Vec3& origin);

// Cosine of half the field, beyond which a spot lamp is dark.
[[nodiscard]] double field_cosine(const Lamp& lamp);
// Relative intensity of a spot by the angle from its axis: 1 inside beam_deg, a smoothstep in the
// cosine, 0 outside field_deg. Its flux is exactly I 2 pi (1 - (cos(beam/2) + cos(field/2)) / 2).
[[nodiscard]] double spot_profile(const Lamp& lamp, double cos_angle);

// Precomputed cosines of a spot lamp.
struct SpotCone {
  double beam_cosine, field_cosine;
  [[nodiscard]] double profile(double cos_angle) const;
};
[[nodiscard]] SpotCone spot_cone(const Lamp& lamp);

// Measure in which (u, v) are uniform: the one with least noise at the point, or always the
// source's area, so that the points do not depend on the receiver.
enum class Spread { Best, OverArea };

// (u, v) in [0,1)^2 select the point of a rectangle or disk; other lamps ignore them.
[[nodiscard]] LightSample sample_lamp(const Lamp& lamp, const Vec3& point, double u, double v,
                                      Spread spread = Spread::Best);

// Sample of a spot lamp with precomputed `cone`.
[[nodiscard]] LightSample sample_spot(const Lamp& lamp, const SpotCone& cone, const Vec3& point);

// 0 for a distant lamp: the light received depends on the surfaces.
[[nodiscard]] Rgb lamp_flux_lm(const Lamp& lamp);

// A ray that leaves the lamp, with its flux relative to the mean ray (1 on average). Not for a
// distant lamp.
struct EmittedRay {
  Vec3 origin, direction;
  double weight = 1.0;
  Vec3 lift_m{0.0};  // offset from the source's surface (surface_offset.h)
};
[[nodiscard]] EmittedRay emit_from_lamp(const Lamp& lamp, double u, double v, double x, double y);

// Distance at which a ray hits the emitting side of a rectangle or disk lamp, and the radiance
// there; no value for lamps without a surface.
struct LampHit {
  double distance_m;
  Rgb radiance;
};
[[nodiscard]] std::optional<LampHit> hit_lamp(const Lamp& lamp, const Vec3& origin,
                                              const Vec3& direction);

// Light from a distant disc of directions, sampled uniformly in its solid angle.
class Cone {
 public:
  Cone(const Vec3& axis, double half_angle_rad);
  [[nodiscard]] Vec3 sample(double u, double v) const;
  // Samples in two steps: local coordinates about the axis, common to cones of the same width, then
  // the direction.
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

// Whether light may arrive from outside the scene: Sun, Earth or a distant lamp.
[[nodiscard]] bool has_light_outside(const Scene& scene);

// Light of a source that a flat mirror reflects to a point.
//
// sample: of the source, as seen from the mirror image of `point`. The result is seen from the
// point; its light is 0 if the path misses the mirror. It excludes the mirror's reflectance, which
// RayQuery::light_shares applies at the hit point. Flat mirrors preserve areas and angles, so that
// the length of the whole path replaces the distance.
[[nodiscard]] LightSample thrown(const LightSample& sample, const FlatMirror& mirror,
                                 std::uint32_t number, const Vec3& point);

// False if no path from a distant disc of this angle, in radians, meets the mirror; needs no
// sample.
[[nodiscard]] bool disc_may_be_thrown(const Vec3& direction, double angle, const FlatMirror& mirror,
                                      const Vec3& point);

// Properties that differ between kinds of lamps, one row each. Their light is in lamp_light.h,
// their keys in scenes/read/lamp.cpp.

struct LampRow {
  std::string_view type;  // name in scene files
  // Emitting surface, for lamps with an exitance: area in m^2, and radius of the bounding sphere in
  // m. Null for lamps with an intensity.
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
// A wide lamp has a surface: it can be visible, partly hidden, distributed.
[[nodiscard]] constexpr bool is_wide(LampKind kind) { return row_of(kind).area != nullptr; }

}  // namespace earthshine::scenes
