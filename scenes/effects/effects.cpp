// SPDX-License-Identifier: Apache-2.0
#include "scenes/effects/effects.h"

#include <algorithm>

#include "scenes/sky/sky_cells.h"

namespace earthshine::scenes {
namespace {

// Below this half angle the Earth's disc fills less than a tenth of a plate's cosine-weighted view,
// and rays aimed at it are more efficient than rays over the hemisphere.
constexpr double wide_earth_deg = 18.5;

template <class Value>
bool worn_by_something(const Scene& scene, Value value) {
  return std::any_of(scene.triangles.begin(), scene.triangles.end(), [&](const Triangle& t) {
    return base::max_component(value(scene.materials[t.material])) > 0.0;
  });
}

}  // namespace

Effects find_effects(const Scene& scene, const LightGroups& groups, const Asked& asked) {
  Effects effects;
  effects.sun = groups.sun != no_group;
  effects.sun_parts = groups.sun_parts != no_group;
  // The lights of LightPaths::Distributed have no extent.
  effects.penumbra =
      effects.sun && scene.sun->angular_radius_deg > 0.0 && asked.paths != LightPaths::Distributed;
  effects.earth = groups.earth != no_group;
  // Shadow rays give all light of a source to one group, so an Earth in cells is always gathered.
  effects.earth_by_gather =
      effects.earth && asked.paths != LightPaths::Distributed &&
      (earth_parts(scene) > 1 || scene.earth->half_angle_deg >= wide_earth_deg);
  for (std::size_t k = 0; k < scene.lamps.size(); ++k) {
    if (groups.lamp[k] == no_group) continue;
    effects.lamps = effects.lamp_kind[static_cast<std::size_t>(scene.lamps[k].kind)] = true;
  }
  effects.emitters = std::any_of(groups.material.begin(), groups.material.end(),
                                 [](std::size_t group) { return group != no_group; });
  effects.ambient = groups.ambient != no_group;
  const bool lit =
      effects.sun || effects.sun_parts || effects.earth || effects.lamps || effects.emitters;
  const bool goes_on = asked.paths == LightPaths::All || asked.paths == LightPaths::Traced;
  effects.interreflection =
      lit && goes_on && worn_by_something(scene, [](const Material& m) { return m.diffuse; });
  effects.phong = lit && worn_by_something(scene, [](const Material& m) { return m.specular; });
  const bool lobe_meets_light = effects.interreflection || (effects.emitters && goes_on);
  effects.glossy = effects.phong && (effects.earth_by_gather || lobe_meets_light);
  effects.solution = asked.paths == LightPaths::All &&
                     (effects.interreflection || (effects.phong && effects.emitters));
  effects.mirror = worn_by_something(scene, [](const Material& m) { return m.mirror; });
  effects.refraction = worn_by_something(scene, [](const Material& m) { return m.transmit; });
  const auto look_at = [&effects](const Camera& camera) {
    effects.depth_of_field |= camera.aperture_m > 0.0 && camera.focus_m > 0.0;
    effects.cctv |= !camera.cctv.empty();
    effects.range_sensor |= !camera.range_sensor.empty();
  };
  for (const Camera* camera : asked.cameras) look_at(*camera);
  for (const Camera& camera : scene.cameras) {
    if (asked.cameras.empty()) look_at(camera);
  }
  return effects;
}

}  // namespace earthshine::scenes
