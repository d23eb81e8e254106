// SPDX-License-Identifier: Apache-2.0
#include "scenes/effects.h"

#include <algorithm>

#include "scenes/sky.h"

namespace earthshine::scenes {
namespace {

// Below this half angle the Earth's disc fills less than a tenth of a plate's cosine-weighted view,
// and rays aimed at it find it more often than rays over the hemisphere do.
constexpr double wide_earth_deg = 18.5;

template <class Value>
bool worn_by_something(const Scene& scene, Value value) {
  return std::any_of(scene.triangles.begin(), scene.triangles.end(), [&](const Triangle& t) {
    return base::max_component(value(scene.materials[t.material])) > 0.0;
  });
}

bool any_lamp(const LightGroups& groups) {
  return std::any_of(groups.lamp.begin(), groups.lamp.end(),
                     [](std::size_t group) { return group != no_group; });
}

bool any_emitter(const LightGroups& groups) {
  return std::any_of(groups.material.begin(), groups.material.end(),
                     [](std::size_t group) { return group != no_group; });
}

std::string sun_reason(const Scene& scene, bool runs) {
  if (!scene.sun) return "the scene has no [sun] and no [orbit]";
  if (runs) return "the Sun is up";
  if (visible_sun_share(scene) <= 0.0) return "the Sun is behind the Earth";
  return "sun.illuminance is 0";
}

std::string earth_reason(const Scene& scene, bool runs) {
  if (!scene.earth) return "the scene has no [earth] and no [orbit]";
  if (runs) return "part of the Earth's disc shines";
  return "the part of the Earth in view is dark";
}

}  // namespace

Effects find_effects(const Scene& scene, const LightGroups& groups) {
  Effects effects;
  effects.sun = groups.sun != no_group;
  effects.penumbra = effects.sun && scene.sun->angular_radius_deg > 0.0;
  effects.earth = groups.earth != no_group;
  effects.earth_by_gather = effects.earth && scene.earth->half_angle_deg >= wide_earth_deg;
  effects.lamps = any_lamp(groups);
  effects.emitters = any_emitter(groups);
  effects.ambient = groups.ambient != no_group;
  const bool lit = effects.sun || effects.earth || effects.lamps || effects.emitters;
  effects.interreflection =
      lit && worn_by_something(scene, [](const Material& m) { return m.diffuse; });
  effects.phong = lit && worn_by_something(scene, [](const Material& m) { return m.specular; });
  effects.mirror = worn_by_something(scene, [](const Material& m) { return m.mirror; });
  effects.refraction = worn_by_something(scene, [](const Material& m) { return m.transmit; });
  for (const Camera& camera : scene.cameras) {
    effects.depth_of_field |= camera.aperture_m > 0.0 && camera.focus_m > 0.0;
    effects.cctv |= !camera.cctv.empty();
    effects.range_sensor |= !camera.range_sensor.empty();
  }
  return effects;
}

std::vector<EffectRow> describe_effects(const Scene& scene, const LightGroups& groups) {
  const Effects e = find_effects(scene, groups);
  const bool lit = groups.count() > 0;
  const auto pick = [](bool runs, const char* yes, const char* no) {
    return std::string(runs ? yes : no);
  };
  std::vector<EffectRow> rows;
  rows.push_back({"interreflection", e.interreflection,
                  lit ? pick(e.interreflection, "light falls on diffuse surfaces",
                             "no material in use has diffuse > 0")
                      : "no source gives light"});
  rows.push_back({"sun", e.sun, sun_reason(scene, e.sun)});
  rows.push_back(
      {"penumbra", e.penumbra,
       e.sun ? pick(e.penumbra, "sun.angular_radius_deg is above 0", "sun.angular_radius_deg is 0")
             : "no sunlight"});
  rows.push_back({"earth", e.earth, earth_reason(scene, e.earth)});
  rows.push_back({"lamps", e.lamps,
                  scene.lamps.empty() ? "the scene has no [[light]]"
                                      : pick(e.lamps, "a lamp is lit", "every lamp is off")});
  rows.push_back(
      {"emitting surfaces", e.emitters,
       pick(e.emitters, "a material in use has emit > 0", "no material in use has emit > 0")});
  rows.push_back({"ambient", e.ambient,
                  pick(e.ambient, "ambient.radiance is above 0", "no [ambient] radiance")});
  rows.push_back({"phong lobe", e.phong,
                  pick(e.phong, "a material in use has specular > 0",
                       "no lit material in use has specular > 0")});
  rows.push_back(
      {"mirror", e.mirror,
       pick(e.mirror, "a material in use has mirror > 0", "no material in use has mirror > 0")});
  rows.push_back({"refraction", e.refraction,
                  pick(e.refraction, "a material in use has transmit > 0",
                       "no material in use has transmit > 0")});
  rows.push_back({"depth of field", e.depth_of_field,
                  pick(e.depth_of_field, "a camera has an aperture", "no camera has an aperture")});
  rows.push_back({"light groups", groups.count() > 1,
                  std::to_string(groups.count()) + " group(s) give light"});
  rows.push_back({"cctv", e.cctv,
                  pick(e.cctv, "a camera names a cctv model", "no camera names a cctv model")});
  rows.push_back({"range sensor", e.range_sensor,
                  pick(e.range_sensor, "a camera names a range_sensor; render --range shows it",
                       "no camera names a range_sensor")});
  return rows;
}

}  // namespace earthshine::scenes
