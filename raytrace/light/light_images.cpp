// SPDX-License-Identifier: Apache-2.0
// LightSampler's images of lights in flat mirrors, and what is known of lamps without size.
#include <algorithm>
#include <cmath>

#include "raytrace/light/light_sampler.h"

namespace earthshine::raytrace {

void LightSampler::add_images() {
  sources_ = lights_.size();
  for (const scenes::FlatMirror& mirror : mirrors_) {
    for (std::size_t k = 0; k < sources_; ++k) {
      lights_.push_back(lights_[k]);
      lights_.back().mirror = &mirror;
    }
  }
}

void LightSampler::find_one_rays() {
  one_rays_.resize(count());
  for (std::size_t k = 0; k < count(); ++k) {
    const Light& light = lights_[k];
    if (light.kind != Kind::Lamp || scenes::is_wide(scene_.lamps[light.index].kind) ||
        scene_.lamps[light.index].is_distant()) {
      continue;
    }
    const scenes::FlatMirror* mirror = light.mirror;
    const scenes::Lamp& lamp = scene_.lamps[light.index];
    OneRay& ray = one_rays_[k];
    ray.is_delta = true;
    ray.position = mirror != nullptr ? mirror->image(lamp.position) : lamp.position;
    ray.axis = mirror != nullptr ? mirror->turned(lamp.axis) : lamp.axis;
    if (lamp.kind == scenes::LampKind::Spot) ray.field_cosine = scenes::field_cosine(lamp);
    if (mirror != nullptr) ray.lamp_height_m = mirror->height_m(lamp.position);
  }
}

void LightSampler::find_throws() {
  throws_.resize(1 + mirrors_.size());
  for (std::size_t m = 0; m < throws_.size(); ++m) {
    if (m > 0) throws_[m].mirror = &mirrors_[m - 1];
    const std::size_t first = m * sources_;
    for (std::size_t k = 0; k < sources_; ++k) {
      if (m == 0 || reaches_mirror(first + k)) throws_[m].lights.push_back(first + k);
    }
    for (const std::size_t k : always_) {
      if (m == 0 || reaches_mirror(first + k)) throws_[m].always.push_back(first + k);
    }
  }
}

// False where nothing of a light falls on its mirror's front, as far as it is known without rays.
bool LightSampler::reaches_mirror(std::size_t index) const {
  const scenes::FlatMirror& mirror = *lights_[index].mirror;
  const OneRay& ray = one_rays_[index];
  if (!ray.is_delta) return true;
  if (ray.lamp_height_m <= 0.0) return false;
  if (ray.field_cosine < -1.0) return true;
  const Vec3 way = mirror.centre - ray.position;  // from the image, whose axis is turned as well
  const double distance = glm::length(way);
  if (distance <= mirror.radius_m) return true;
  const double off = std::acos(std::clamp(glm::dot(way, ray.axis) / distance, -1.0, 1.0));
  return off <= std::acos(ray.field_cosine) + std::asin(mirror.radius_m / distance) + 1e-6;
}

}  // namespace earthshine::raytrace
