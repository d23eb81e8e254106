// SPDX-License-Identifier: Apache-2.0
#include "radiosity/direct/sources.h"

#include <limits>
#include <memory>

#include "radiosity/direct/explicit_emitters.h"
#include "radiosity/direct/light_cluster.h"
#include "scenes/light/emitters.h"
#include "scenes/light/lamp_kind.h"
#include "scenes/sky/sky.h"
#include "scenes/sky/sky_parts.h"

namespace earthshine::radiosity {
namespace {

using scenes::LightSample;

LightSource sun_source(const scenes::Scene& scene, std::size_t group, int points) {
  const Rgb illuminance = scenes::sun_sample_illuminance(scene);
  Source source;
  source.key = 1;
  source.group = group;
  source.points = points;
  source.sample = [&scene, illuminance](const Vec3&, double u, double v) {
    return LightSample{scenes::sample_sun(scene, u, v), std::numeric_limits<double>::infinity(),
                       illuminance};
  };
  return {{}, std::move(source), Rgb(0.0), {}};
}

// The whole disc of a Sun that nothing in the sky hides.
LightSource free_sun_source(const scenes::Sun& sun, std::uint64_t key, std::size_t group,
                            int points) {
  const double radius = base::radians(sun.angular_radius_deg);
  const Rgb illuminance = scenes::sun_sample_illuminance(sun);
  Source source;
  source.key = key;
  source.group = group;
  source.points = points;
  source.sample = [&sun, radius, illuminance](const Vec3&, double u, double v) {
    return LightSample{scenes::sample_cone(sun.direction, radius, u, v),
                       std::numeric_limits<double>::infinity(), illuminance};
  };
  return {{}, std::move(source), Rgb(0.0), {}};
}

LightSource earth_source(const scenes::Scene& scene, std::size_t group, int points) {
  const double half_angle = base::radians(scene.earth->half_angle_deg);
  const double solid_angle = scenes::cone_solid_angle_sr(half_angle);
  Source source;
  source.key = 2;
  source.group = group;
  source.points = 4 * points;
  source.sample = [&scene, half_angle, solid_angle](const Vec3&, double u, double v) {
    const Vec3 direction = scenes::sample_cone(scene.earth->direction, half_angle, u, v);
    return LightSample{direction, std::numeric_limits<double>::infinity(),
                       scenes::earth_radiance(scene, direction) * solid_angle};
  };
  return {{}, std::move(source), Rgb(0.0), {}};
}

LightSource lamp_source(const scenes::Lamp& lamp, std::uint64_t key, std::size_t group,
                        int points) {
  Source source;
  source.key = key;
  source.group = group;
  source.points = points * (scenes::is_wide(lamp.kind) ? 4 : 1);
  source.sample = [&lamp](const Vec3& point, double u, double v) {
    return scenes::sample_lamp(lamp, point, u, v);
  };
  source.distance_m = [&lamp](const Vec3& point) { return glm::length(point - lamp.position); };
  return {lamp.name, std::move(source), scenes::lamp_flux_lm(lamp),
          [&lamp](double u, double v, double x, double y) {
            return scenes::emit_from_lamp(lamp, u, v, x, y);
          }};
}

LightSource emitter_source(const scenes::Scene& scene, std::size_t material, std::uint64_t key,
                           std::size_t group, int points) {
  const auto emitters = std::make_shared<const scenes::EmitterSet>(scene, material);
  Source source;
  source.key = key;
  source.group = group;
  source.points = 4 * points;
  source.sample = [emitters](const Vec3& point, double u, double v) {
    return emitters->sample(point, u, v);
  };
  return {
      scene.materials[material].name, std::move(source), emitters->flux_lm(),
      [emitters](double u, double v, double x, double y) { return emitters->emit(u, v, x, y); }};
}

}  // namespace

std::vector<LightSource> find_sources(const scenes::Scene& scene, const scenes::LightGroups& groups,
                                      const scenes::Effects& effects, int points) {
  std::vector<LightSource> sources;
  const auto add = [&sources](LightSource source, scenes::LightKind kind) {
    source.kind = kind;
    sources.push_back(std::move(source));
  };
  if (effects.sun) add(sun_source(scene, groups.sun, points), scenes::LightKind::Sun);
  for (std::size_t k = 0; effects.sun_parts && k < scene.sky_parts->suns.size(); ++k) {
    add(free_sun_source(scene.sky_parts->suns[k], (std::uint64_t{1} << 40) + k,
                        groups.sun_parts + k, points),
        scenes::LightKind::Sun);
  }
  if (effects.earth && !effects.earth_by_gather) {
    add(earth_source(scene, groups.earth, points), scenes::LightKind::Earth);
  }
  // Keys count what shines: one that is off does not change the others' samples.
  std::vector<std::vector<std::size_t>> lamps(groups.count());
  std::vector<std::uint64_t> key(scene.lamps.size(), 0);
  std::uint64_t next_key = 16;
  for (std::size_t k = 0; k < scene.lamps.size(); ++k) {
    if (groups.lamp[k] == scenes::no_group) continue;
    lamps[groups.lamp[k]].push_back(k);
    key[k] = next_key++;
  }
  for (std::size_t g = 0; g < lamps.size(); ++g) {
    if (lamps[g].size() < fewest_in_cluster) continue;
    const std::size_t first = lamps[g][0];
    add(cluster_source(scene, lamps[g], key[first], g, points),
        scenes::kind_of(scene.lamps[first].kind));
  }
  for (std::size_t k = 0; k < scene.lamps.size(); ++k) {
    if (groups.lamp[k] == scenes::no_group) continue;
    if (lamps[groups.lamp[k]].size() >= fewest_in_cluster) continue;
    add(lamp_source(scene.lamps[k], key[k], groups.lamp[k], points),
        scenes::kind_of(scene.lamps[k].kind));
  }
  const std::vector<bool> is_explicit = emitter_is_explicit(scene);
  std::uint64_t emitter_key = std::uint64_t{1} << 32;
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    if (!is_explicit[m] || groups.material[m] == scenes::no_group) continue;
    add(emitter_source(scene, m, emitter_key++, groups.material[m], points),
        scenes::LightKind::Emitter);
  }
  return sources;
}

}  // namespace earthshine::radiosity
