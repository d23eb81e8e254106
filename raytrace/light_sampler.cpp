// SPDX-License-Identifier: Apache-2.0
#include "raytrace/light_sampler.h"

#include <cmath>
#include <limits>
#include <utility>

#include "scenes/sky.h"

namespace earthshine::raytrace {
namespace {

// R2 lattice (Roberts 2018): point k of any number, spread evenly over the unit square.
constexpr double r2_u = 0.7548776662466927;
constexpr double r2_v = 0.5698402909980532;

double fraction(double x) { return x - std::floor(x); }

}  // namespace

LightSampler::LightSampler(const scenes::Scene& scene, const scenes::LightGroups& groups,
                           const scenes::Effects& effects, Indirect indirect,
                           int distributed_lights, std::optional<scenes::Lamp> earth_area)
    : scene_(scene),
      distributed_(indirect == Indirect::Distributed),
      earth_area_(distributed_ ? std::move(earth_area) : std::nullopt) {
  const int copies = distributed_ ? distributed_lights : 1;
  if (effects.sun) {
    sun_illuminance_lx_ = distributed_
                              ? scene.sun->illuminance_lx * scenes::visible_sun_share(scene)
                              : scenes::sun_sample_illuminance(scene);
    // The report's lights have no extent: its Sun casts hard shadows.
    sun_radius_rad_ = distributed_ ? 0.0 : base::radians(scene.sun->angular_radius_deg);
    add({Kind::Sun, groups.sun}, 1);
  }
  if (effects.earth && (distributed_ || !effects.earth_by_gather)) {
    earth_half_angle_rad_ = base::radians(scene.earth->half_angle_deg);
    earth_solid_angle_sr_ = scenes::cone_solid_angle_sr(earth_half_angle_rad_);
    add({earth_area_ ? Kind::EarthArea : Kind::Earth, groups.earth}, copies);
  }
  for (std::size_t k = 0; k < scene.lamps.size(); ++k) {
    if (groups.lamp[k] == scenes::no_group) continue;
    const bool wide = scene.lamps[k].kind == scenes::LampKind::Rectangle ||
                      scene.lamps[k].kind == scenes::LampKind::Disk;
    add({Kind::Lamp, groups.lamp[k], k}, wide ? copies : 1);
  }
  // Without interreflection nothing carries emitters through F, so that all of them are sampled.
  const std::vector<bool> is_explicit = radiosity::emitter_is_explicit(scene);
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    if (groups.material[m] == scenes::no_group) continue;
    if (indirect == Indirect::Radiosity && !is_explicit[m]) continue;
    scenes::EmitterSet set;
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
      if (scene.triangles[t].material == m) set.add(scene, static_cast<std::uint32_t>(t));
    }
    add({Kind::Emitters, groups.material[m], emitters_.size()}, copies);
    emitters_.push_back(std::move(set));
  }
}

void LightSampler::add(Light light, int copies) {
  light.fixed = distributed_;
  if (!distributed_) {
    lights_.push_back(light);
    return;
  }
  light.share = 1.0 / copies;
  for (int k = 0; k < copies; ++k) {
    light.u = (k + 0.5) / copies;
    light.v = light.kind == Kind::Earth ? fraction(k * 0.6180339887498949)  // Fibonacci cap
                                        : fraction(0.5 + k * r2_v);
    if (light.kind != Kind::Earth) light.u = fraction(0.5 + k * r2_u);
    lights_.push_back(light);
  }
}

scenes::LightSample LightSampler::sample(std::size_t index, const Vec3& point, double u,
                                         double v) const {
  const Light& light = lights_[index];
  if (light.fixed) {
    u = light.u;
    v = light.v;
  }
  scenes::LightSample sample;
  switch (light.kind) {
    case Kind::Sun:
      sample = {scenes::sample_cone(scene_.sun->direction, sun_radius_rad_, u, v),
                std::numeric_limits<double>::infinity(), sun_illuminance_lx_};
      break;
    case Kind::Earth: {
      const Vec3 direction =
          scenes::sample_cone(scene_.earth->direction, earth_half_angle_rad_, u, v);
      sample = {direction, std::numeric_limits<double>::infinity(),
                scenes::earth_radiance(scene_, direction) * earth_solid_angle_sr_};
      break;
    }
    case Kind::EarthArea:
      sample = scenes::sample_lamp(*earth_area_, point, u, v);
      break;
    case Kind::Lamp:
      sample = scenes::sample_lamp(scene_.lamps[light.index], point, u, v);
      break;
    case Kind::Emitters:
      sample = emitters_[light.index].sample(point, u, v);
      break;
  }
  sample.normal_illuminance_lx *= light.share;
  return sample;
}

}  // namespace earthshine::raytrace
