// SPDX-License-Identifier: Apache-2.0
#include "raytrace/light/light_sampler.h"

#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "base/numbers/sobol_set.h"
#include "radiosity/direct/sources.h"
#include "raytrace/tuning.h"
#include "scenes/effects/shining.h"
#include "scenes/sky/sky.h"
#include "scenes/sky/sky_cells.h"

namespace earthshine::raytrace {
namespace {

constexpr double rounding = 1e-9;

double fraction(double x) { return x - std::floor(x); }
// Increases with x.
double signed_square(double x) { return x * std::abs(x); }

}  // namespace

LightSampler::LightSampler(const scenes::World& world, Indirect indirect, int distributed_lights,
                           bool per_group, std::optional<scenes::Lamp> earth_area,
                           std::span<const scenes::FlatMirror> mirrors)
    : scene_(world.scene),
      distributed_(indirect == Indirect::Distributed),
      mirrors_(distributed_ ? std::span<const scenes::FlatMirror>() : mirrors),
      earth_area_(distributed_ ? std::move(earth_area) : std::nullopt) {
  const int copies = distributed_ ? distributed_lights : 1;
  // Without interreflection F carries no emitters, so that shadow rays sample all of them.
  const std::vector<bool> is_explicit = radiosity::emitter_is_explicit(scene_);
  using Shines = scenes::ShiningLight::Kind;
  for (const auto& [kind, group, k] : scenes::shining_lights(world)) {
    switch (kind) {
      case Shines::Sun:
        sun_illuminance_lx_ = distributed_
                                  ? scene_.sun->illuminance_lx * scenes::visible_sun_share(scene_)
                                  : scenes::sun_sample_illuminance(scene_);
        sun_.emplace(scene_);
        add({Kind::Sun, group}, 1);
        break;
      case Shines::SunPart: {
        const scenes::Sun& sun = scene_.sky_parts->suns[k];
        sun_parts_.push_back({scenes::sun_sample_illuminance(sun),
                              {sun.direction, base::radians(sun.angular_radius_deg)},
                              sun.direction,
                              base::radians(sun.angular_radius_deg) + rounding});
        add({Kind::SunPart, group, k}, 1);
        break;
      }
      case Shines::Earth:
        if (!distributed_ && world.effects.earth_by_gather) break;
        earth_.emplace(scene_);
        add({earth_area_ ? Kind::EarthArea : Kind::Earth, group}, copies);
        break;
      case Shines::Lamp:
        add({Kind::Lamp, group, k}, scenes::is_wide(scene_.lamps[k].kind) ? copies : 1);
        if (scenes::is_wide(scene_.lamps[k].kind)) surfaces_.lights.push_back(k);
        break;
      case Shines::Emitter:
        if (indirect == Indirect::Radiosity && !is_explicit[k]) break;
        add({Kind::Emitters, group, emitters_.size()}, copies);
        emitters_.emplace_back(scene_, k);
        break;
    }
  }
  for (const scenes::Lamp& lamp : scene_.lamps) cones_.push_back(scenes::spot_cone(lamp));
  surfaces_.tree = tree_of(surfaces_.lights);
  if (per_group && world.effects.sun_parts) {
    sun_strata_ = SunStrata(world.groups.sun_parts, world.scene.sky_parts->suns.size());
  }
  gather_clusters(per_group);
  add_images();
  find_delta_lights();
  find_mirror_lights();
}

void LightSampler::gather_clusters(bool per_group) {
  std::map<std::size_t, std::vector<std::size_t>> lamps;
  for (std::size_t k = 0; k < lights_.size(); ++k) {
    const bool lamp = lights_[k].kind == Kind::Lamp && !distributed_ &&
                      !scene_.lamps[lights_[k].index].is_distant();
    if (lamp) lamps[per_group ? lights_[k].group : 0].push_back(k);
    if (!lamp) always_.push_back(k);
  }
  for (auto& [group, lights] : lamps) {
    if (lights.size() <= tuning::few_lamps) {
      always_.insert(always_.end(), lights.begin(), lights.end());
      continue;
    }
    std::vector<std::size_t> of_scene;
    for (const std::size_t k : lights) of_scene.push_back(lights_[k].index);
    clusters_.push_back({tree_of(of_scene), std::move(lights)});
  }
}

scenes::LightTree LightSampler::tree_of(const std::vector<std::size_t>& lamps) const {
  std::vector<scenes::LightBounds> bounds;
  for (const std::size_t k : lamps) bounds.push_back(scenes::bounds_of(scene_.lamps[k]));
  return scenes::LightTree(bounds);
}

scenes::LightKind LightSampler::kind(std::size_t index) const {
  const Light& light = lights_[index];
  switch (light.kind) {
    case Kind::Sun:
    case Kind::SunPart:
      return scenes::LightKind::Sun;
    case Kind::Earth:
    case Kind::EarthArea:
      return scenes::LightKind::Earth;
    case Kind::Lamp:
      return scenes::kind_of(scene_.lamps[light.index].kind);
    case Kind::Emitters:
      break;
  }
  return scenes::LightKind::Emitter;
}

std::optional<LightSampler::SeenLamp> LightSampler::seen_lamp(const Vec3& origin,
                                                              const Vec3& direction,
                                                              double nearer_than_m) const {
  std::vector<std::size_t> met;
  surfaces_.tree.along(origin, direction, nearer_than_m, met);
  std::optional<SeenLamp> seen;
  for (const std::size_t k : met) {
    const std::size_t lamp = surfaces_.lights[k];
    const auto hit = scenes::hit_lamp(scene_.lamps[lamp], origin, direction);
    if (!hit || hit->distance_m >= nearer_than_m) continue;
    nearer_than_m = hit->distance_m;
    seen = SeenLamp{lamp, *hit};
  }
  return seen;
}

void LightSampler::choose(const scenes::Receiver& receiver, double u,
                          std::vector<scenes::LightChoice>& chosen) const {
  choose_thrown(mirror_lights_.front(), receiver, u, 0, chosen);
  for (std::size_t m = 0; m < mirrors_.size(); ++m) {
    const scenes::FlatMirror& mirror = mirrors_[m];
    if (mirror.height_m(receiver.point) <= 0.0) continue;
    scenes::Receiver image = receiver;
    image.point = mirror.image(receiver.point);
    image.normal = mirror.reflected(receiver.normal);
    image.mirrored = mirror.reflected(receiver.mirrored);
    choose_thrown(mirror_lights_[m + 1], image, u, (m + 1) * sources_, chosen);
  }
}

void LightSampler::choose_thrown(const MirrorLights& by, const scenes::Receiver& receiver, double u,
                                 std::size_t first,
                                 std::vector<scenes::LightChoice>& chosen) const {
  for (const std::size_t light : by.always) chosen.push_back({light, 1.0});
  for (const Cluster& crowd : clusters_) {
    const std::size_t from = chosen.size();
    crowd.tree.choose(receiver, u, tuning::smallest_share, chosen);
    for (std::size_t k = from; k < chosen.size(); ++k) {
      chosen[k].light = first + crowd.lights[chosen[k].light];
    }
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
    light.v = light.kind == Kind::Earth ? fraction(k * 0.6180339887498949)  // Fibonacci lattice on
                                                                            // the cap
                                        : fraction(0.5 + k * base::r2_v);
    if (light.kind != Kind::Earth) light.u = fraction(0.5 + k * base::r2_u);
    lights_.push_back(light);
  }
}

namespace {

bool sun_may_reach(const Vec3& direction, double angle_rad, const scenes::FlatMirror* mirror,
                   const Vec3& point, const Vec3& normal) {
  if (mirror == nullptr) return glm::dot(direction, normal) >= -angle_rad;
  return glm::dot(direction, mirror->reflected(normal)) >= -angle_rad &&
         scenes::disc_may_be_thrown(direction, angle_rad, *mirror, point);
}

}  // namespace

bool LightSampler::may_reach(std::size_t index, const Vec3& point, const Vec3& normal) const {
  const Light& light = lights_[index];
  const scenes::FlatMirror* mirror = light.mirror;
  if (light.kind == Kind::SunPart) {
    const SunPart& sun = sun_parts_[light.index];
    return sun_may_reach(sun.direction, sun.angle_rad, mirror, point, normal);
  }
  if (light.kind == Kind::Sun) {
    const double angle_rad = base::radians(scene_.sun->angular_radius_deg) + rounding;
    return sun_may_reach(scene_.sun->direction, angle_rad, mirror, point, normal);
  }
  const DeltaLight& ray = delta_lights_[index];
  const Vec3 offset = ray.position - point;
  if (ray.is_delta) {
    // Squares avoid roots: a picture calls this tens of millions of times, mostly for images.
    const double distance2 = glm::dot(offset, offset);
    if (signed_square(glm::dot(offset, normal)) < signed_square(-rounding) * distance2)
      return false;
    const double least = signed_square(ray.field_cosine - rounding);
    if (signed_square(-glm::dot(offset, ray.axis)) < least * distance2) return false;
  }
  const double height = mirror != nullptr ? mirror->height_m(point) : 0.0;
  if (mirror != nullptr && height <= 0.0) return false;
  if (!ray.is_delta || mirror == nullptr) return true;
  if (ray.lamp_height_m <= 0.0) return false;
  const Vec3 off = point + height / (height + ray.lamp_height_m) * offset - mirror->centre;
  return glm::dot(off, off) <= mirror->radius_m * mirror->radius_m * (1.0 + 2e-6);
}

scenes::LightSample LightSampler::sample(std::size_t index, const Vec3& point, double u,
                                         double v) const {
  const scenes::FlatMirror* mirror = lights_[index].mirror;
  if (mirror == nullptr) return sample_straight(lights_[index], point, u, v);
  if (mirror->height_m(point) <= 0.0) return {};
  return scenes::thrown(sample_straight(lights_[index], mirror->image(point), u, v), *mirror,
                        static_cast<std::uint32_t>(mirror - mirrors_.data()), point);
}

scenes::LightSample LightSampler::sample_sun(std::size_t index, const Vec3& point,
                                             const Vec3& place) const {
  const SunPart& sun = sun_parts_[lights_[index].index];
  const scenes::LightSample straight{sun.disc.at(place), std::numeric_limits<double>::infinity(),
                                     sun.illuminance_lx};
  const scenes::FlatMirror* mirror = lights_[index].mirror;
  if (mirror == nullptr) return straight;
  if (mirror->height_m(point) <= 0.0) return {};
  return scenes::thrown(straight, *mirror, static_cast<std::uint32_t>(mirror - mirrors_.data()),
                        point);
}

scenes::LightSample LightSampler::sample_straight(const Light& light, const Vec3& point, double u,
                                                  double v) const {
  if (light.fixed) {
    u = light.u;
    v = light.v;
  }
  const scenes::Spread spread = light.fixed ? scenes::Spread::OverArea : scenes::Spread::Best;
  scenes::LightSample sample;
  switch (light.kind) {
    case Kind::Sun:
      // The report's lights have no extent: its Sun casts hard shadows.
      sample = {distributed_ ? scene_.sun->direction : (*sun_)(u, v),
                std::numeric_limits<double>::infinity(), sun_illuminance_lx_};
      break;
    case Kind::SunPart: {
      const SunPart& sun = sun_parts_[light.index];
      sample = {sun.disc.sample(u, v), std::numeric_limits<double>::infinity(), sun.illuminance_lx};
      break;
    }
    case Kind::Earth:
      sample = earth_->sample(u, v);
      break;
    case Kind::EarthArea:
      sample = scenes::sample_lamp(*earth_area_, point, u, v);
      break;
    case Kind::Lamp:
      sample = scene_.lamps[light.index].kind == scenes::LampKind::Spot
                   ? scenes::sample_spot(scene_.lamps[light.index], cones_[light.index], point)
                   : scenes::sample_lamp(scene_.lamps[light.index], point, u, v, spread);
      break;
    case Kind::Emitters:
      sample = emitters_[light.index].sample(point, u, v, spread);
      break;
  }
  sample.normal_illuminance_lx *= light.share;
  return sample;
}

}  // namespace earthshine::raytrace
