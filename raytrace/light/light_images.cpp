// SPDX-License-Identifier: Apache-2.0
// LightSampler's images of lights in flat mirrors, and its data of lamps without size.
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

void LightSampler::find_delta_lights() {
  delta_lights_.resize(count());
  for (std::size_t k = 0; k < count(); ++k) {
    const Light& light = lights_[k];
    if (light.kind != Kind::Lamp || scenes::is_wide(scene_.lamps[light.index].kind) ||
        scene_.lamps[light.index].is_distant()) {
      continue;
    }
    const scenes::FlatMirror* mirror = light.mirror;
    const scenes::Lamp& lamp = scene_.lamps[light.index];
    DeltaLight& ray = delta_lights_[k];
    ray.is_delta = true;
    ray.position = mirror != nullptr ? mirror->image(lamp.position) : lamp.position;
    ray.axis = mirror != nullptr ? mirror->reflected(lamp.axis) : lamp.axis;
    if (lamp.kind == scenes::LampKind::Spot) ray.field_cosine = scenes::field_cosine(lamp);
    if (mirror != nullptr) ray.lamp_height_m = mirror->height_m(lamp.position);
  }
}

void LightSampler::find_mirror_lights() {
  mirror_lights_.resize(1 + mirrors_.size());
  for (std::size_t m = 0; m < mirror_lights_.size(); ++m) {
    if (m > 0) mirror_lights_[m].mirror = &mirrors_[m - 1];
    const std::size_t first = m * sources_;
    for (std::size_t k = 0; k < sources_; ++k) {
      if (m == 0 || reaches_mirror(first + k)) mirror_lights_[m].lights.push_back(first + k);
    }
    for (const std::size_t k : always_) {
      if (m == 0 || reaches_mirror(first + k)) mirror_lights_[m].always.push_back(first + k);
    }
  }
}

// False if it is certain without rays that no light reaches the mirror's front.
bool LightSampler::reaches_mirror(std::size_t index) const {
  const scenes::FlatMirror& mirror = *lights_[index].mirror;
  const DeltaLight& ray = delta_lights_[index];
  if (!ray.is_delta) return true;
  if (ray.lamp_height_m <= 0.0) return false;
  if (ray.field_cosine < -1.0) return true;
  const Vec3 offset = mirror.centre - ray.position;  // from the image, whose axis is mirrored, too
  const double distance = glm::length(offset);
  if (distance <= mirror.radius_m) return true;
  const double off = std::acos(std::clamp(glm::dot(offset, ray.axis) / distance, -1.0, 1.0));
  return off <= std::acos(ray.field_cosine) + std::asin(mirror.radius_m / distance) + 1e-6;
}

}  // namespace earthshine::raytrace
