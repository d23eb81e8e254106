// SPDX-License-Identifier: Apache-2.0
// What a source of finite extent gives a point: one sample of its light, and where its flux goes.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "scenes/scene.h"

namespace earthshine::scenes {

// One shadowed sample of a source, seen from a point.
struct LightSample {
  Vec3 direction{0.0};      // unit, toward the source
  double distance_m = 0.0;  // infinite for the sky
  Rgb normal_illuminance_lx{
      0.0};  // on a plane facing `direction`, divided by the sample's density; nothing in between
};

// Shape of a spot's intensity against the angle from its axis: 1 inside beam_deg, smoothstep in the
// cosine, 0 outside field_deg. Its flux is I 2 pi (1 - (cos(beam/2) + cos(field/2)) / 2) exactly.
[[nodiscard]] double spot_profile(const Lamp& lamp, double cos_angle);

// (u, v) in [0,1)^2 choose the point of a rectangle or disk; other lamps do not use them.
[[nodiscard]] LightSample sample_lamp(const Lamp& lamp, const Vec3& point, double u, double v);

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

// The emitting triangles of one light group, chosen in proportion to their flux. Sheets shine from
// both sides.
class EmitterSet {
 public:
  void add(const Scene& scene, std::uint32_t triangle);
  [[nodiscard]] bool empty() const { return triangles_.empty(); }
  [[nodiscard]] Rgb flux_lm() const { return flux_lm_; }
  // u chooses the triangle and, rescaled, the point together with v. Zero illuminance if the point
  // sees the dark side.
  [[nodiscard]] LightSample sample(const Vec3& point, double u, double v) const;
  [[nodiscard]] EmittedRay emit(double u, double v, double x, double y) const;

 private:
  struct Emitter {
    Vec3 corner, edge1, edge2, normal;
    double area_m2;
    Rgb exitance;
    bool two_sided;
  };
  [[nodiscard]] const Emitter& choose(double& u, double& probability) const;
  std::vector<Emitter> triangles_;
  std::vector<double> cumulative_;  // luminous flux, running sum
  Rgb flux_lm_{0.0};
};

// Light that reaches a point from a distant disc of directions, sampled uniformly over its solid
// angle.
[[nodiscard]] Vec3 sample_cone(const Vec3& axis, double half_angle_rad, double u, double v);
[[nodiscard]] double cone_solid_angle_sr(double half_angle_rad);

}  // namespace earthshine::scenes
