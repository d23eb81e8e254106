// SPDX-License-Identifier: Apache-2.0
// A floor and possible light sources, for the tests of culling.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "scenes/effects/culling.h"
#include "tests/support/scene_builder.h"

namespace earthshine::scenes {

struct Found {
  std::vector<Culling> culled;
  LightGroups groups;
  Effects effects;

  [[nodiscard]] const Culling* row(const std::string& effect) const {
    const auto found = std::find_if(culled.begin(), culled.end(),
                                    [&](const Culling& off) { return off.effect == effect; });
    return found == culled.end() ? nullptr : &*found;
  }
  [[nodiscard]] bool has(const std::string& effect) const { return row(effect) != nullptr; }
};

inline Found look(const Scene& scene, double wanted_error = 0.02, const Asked& asked = {},
                  const HiddenLights& hidden = {}) {
  Found found;
  found.groups = find_light_groups(scene);
  found.effects = find_effects(scene, found.groups, asked);
  found.culled = cull_effects(scene, asked, wanted_error, hidden, found.groups, found.effects);
  return found;
}

inline Sun sun_at(double height_deg, double radius_deg) {
  const double h = base::radians(height_deg);
  return {{std::cos(h), 0.0, std::sin(h)}, Rgb(1000.0), radius_deg};
}

inline Earth earth_at(double height_deg, double half_angle_deg) {
  const double h = base::radians(height_deg);
  Earth earth;
  earth.direction = {0.0, std::cos(h), std::sin(h)};
  earth.half_angle_deg = half_angle_deg;
  earth.model = EarthModel::Uniform;
  earth.radiance = Rgb(100.0);
  return earth;
}

// A plate in z = 0, 2 m wide, with its front up.
inline tests::SceneBuilder floor_of(const Material& material) {
  tests::SceneBuilder builder;
  builder.plate(builder.material(material), 2.0, 0.0, true);
  return builder;
}

inline Lamp lamp_of(LampKind kind, const Vec3& position, const Vec3& axis) {
  Lamp lamp;
  lamp.name = lamp.group = "lamp";
  lamp.kind = kind;
  lamp.position = position;
  lamp.axis = axis;
  if (kind == LampKind::Rectangle || kind == LampKind::Disk) {
    lamp.exitance = Rgb(10.0);
  } else {
    lamp.intensity_cd = Rgb(10.0);
  }
  return lamp;
}

}  // namespace earthshine::scenes
