// SPDX-License-Identifier: Apache-2.0
#include "radiosity/direct/sources.h"

#include <algorithm>
#include <bit>
#include <iterator>
#include <limits>
#include <memory>
#include <numeric>

#include "base/numbers/random.h"
#include "scenes/effects/shining.h"
#include "scenes/light/emitters.h"
#include "scenes/light/light_tree.h"
#include "scenes/reflect/energy.h"
#include "scenes/sky/sky.h"
#include "scenes/sky/sky_cells.h"

namespace earthshine::radiosity {
namespace {

using scenes::LightSample;

constexpr double rounding = 1e-9;  // of cosines

LightSource sun_source(const scenes::Scene& scene, std::size_t group, int points) {
  const Rgb illuminance = scenes::sun_sample_illuminance(scene);
  Source source;
  source.key = 1;
  source.group = group;
  source.points = points;
  source.sample = [sun = scenes::SunDirections(scene), illuminance](const Vec3&, double u,
                                                                    double v) {
    return LightSample{sun(u, v), std::numeric_limits<double>::infinity(), illuminance};
  };
  return {{}, std::move(source), Rgb(0.0), {}};
}

// The whole disc of an unobstructed Sun.
LightSource free_sun_source(const scenes::Sun& sun, std::uint64_t key, std::size_t group,
                            int points) {
  const double radius = base::radians(sun.angular_radius_deg);
  const Rgb illuminance = scenes::sun_sample_illuminance(sun);
  Source source;
  source.has_size = radius > 0.0;
  source.disc = Disc{sun.direction, radius + rounding, -std::sin(radius) - rounding};
  source.key = key;
  source.group = group;
  source.points = points;
  source.sample = [cone = scenes::Cone(sun.direction, radius), illuminance](const Vec3&, double u,
                                                                            double v) {
    return LightSample{cone.sample(u, v), std::numeric_limits<double>::infinity(), illuminance};
  };
  return {{}, std::move(source), Rgb(0.0), {}};
}

LightSource earth_source(const scenes::Scene& scene, std::size_t group, int points) {
  Source source;
  source.key = 2;
  source.group = group;
  source.points = 4 * points;
  source.sample = [earth = scenes::EarthLight(scene)](const Vec3&, double u, double v) {
    return earth.sample(u, v);
  };
  return {{}, std::move(source), Rgb(0.0), {}};
}

LightSource lamp_source(const scenes::Lamp& lamp, std::uint64_t key, std::size_t group,
                        int points) {
  Source source;
  source.key = key;
  source.group = group;
  source.has_size = scenes::is_wide(lamp.kind);
  source.lamp = &lamp;
  source.points = points * (source.has_size ? 4 : 1);
  if (lamp.kind == scenes::LampKind::Spot) {
    source.sample = [&lamp, cone = scenes::spot_cone(lamp)](const Vec3& point, double, double) {
      return scenes::sample_spot(lamp, cone, point);
    };
  } else {
    source.sample = [&lamp](const Vec3& point, double u, double v) {
      return scenes::sample_lamp(lamp, point, u, v);
    };
  }
  source.distance_m = [&lamp](const Vec3& point) { return glm::length(point - lamp.position); };
  return {lamp.name, std::move(source), scenes::lamp_flux_lm(lamp),
          [&lamp](double u, double v, double x, double y) {
            return scenes::emit_from_lamp(lamp, u, v, x, y);
          }};
}

// A single direction; its flux is unknown.
LightSource distant_source(const scenes::Lamp& lamp, std::uint64_t key, std::size_t group,
                           int points) {
  Source source;
  source.key = key;
  source.group = group;
  source.points = points;
  source.has_size = false;
  source.sample = [&lamp](const Vec3& point, double u, double v) {
    return scenes::sample_lamp(lamp, point, u, v);
  };
  return {{}, std::move(source), Rgb(0.0), {}};
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

constexpr double smallest_share = 1.0 / 16.0;

struct Cluster {
  const scenes::Scene& scene;
  std::vector<std::size_t> lamps;
  scenes::LightTree tree;
  std::vector<double> flux_to;  // cumulative luminous flux

  [[nodiscard]] const scenes::Lamp& lamp(std::size_t k) const { return scene.lamps[lamps[k]]; }

  void sample(const Vec3& point, const Vec3& normal, double u, double v,
              std::vector<LightSample>& samples) const {
    std::vector<scenes::LightChoice> chosen;
    scenes::Receiver receiver;
    receiver.point = point;
    receiver.normal = normal;
    tree.choose(receiver, u, smallest_share, chosen);
    // u has selected the lamps; positions on them need independent numbers.
    const base::Key key(std::bit_cast<std::uint64_t>(u), base::Stream::DirectLight,
                        std::bit_cast<std::uint64_t>(v));
    for (const auto& [k, weight] : chosen) {
      const base::Key on_lamp = key.with(k);
      LightSample sample =
          scenes::sample_lamp(lamp(k), point, uniform(on_lamp, 0), uniform(on_lamp, 1));
      sample.normal_illuminance_lx *= weight;
      samples.push_back(sample);
    }
  }

  [[nodiscard]] scenes::EmittedRay emit(double u, double v, double x, double y) const {
    const double wanted = u * flux_to.back();
    const auto found = std::upper_bound(flux_to.begin(), flux_to.end() - 1, wanted);
    const auto k = static_cast<std::size_t>(found - flux_to.begin());
    const double below = k == 0 ? 0.0 : flux_to[k - 1];
    const double rest = std::clamp((wanted - below) / (flux_to[k] - below), 0.0, 1.0);
    return scenes::emit_from_lamp(lamp(k), rest, v, x, y);
  }

  [[nodiscard]] double distance_m(const Vec3& point) const {
    double nearest2 = std::numeric_limits<double>::infinity();
    for (const std::size_t k : lamps) {
      const Vec3 offset = scene.lamps[k].position - point;
      nearest2 = std::min(nearest2, glm::dot(offset, offset));
    }
    return std::sqrt(nearest2);
  }
};

constexpr double wide_share = 0.05;  // of all surface area
constexpr double stands_out = 2.0;   // times the mean illuminance

// Includes both sides of sheets.
std::vector<double> areas_by_material(const scenes::Scene& scene) {
  std::vector<double> area(scene.materials.size(), 0.0);
  for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
    const std::uint32_t m = scene.triangles[t].material;
    const double sides = scene.materials[m].two_sided ? 2.0 : 1.0;
    area[m] += sides * scenes::triangle_area(scene, static_cast<std::uint32_t>(t));
  }
  return area;
}

// 0 if nothing absorbs.
double mean_illuminance(const scenes::Scene& scene, const std::vector<double>& area) {
  const std::vector<Rgb> spread = scenes::bihemispherical_albedos(scene);
  double emitted = 0.0, absorbing = 0.0;
  for (std::size_t m = 0; m < area.size(); ++m) {
    const scenes::Material& material = scene.materials[m];
    const double sent_on = base::luminance(spread[m] + material.mirror + material.transmit);
    emitted += area[m] * base::luminance(material.emit);
    absorbing += area[m] * std::max(0.0, 1.0 - sent_on);
  }
  return absorbing > 0.0 ? emitted / absorbing : 0.0;
}

}  // namespace

std::vector<LightSource> find_sources(const scenes::World& world, int points) {
  using Kind = scenes::ShiningLight::Kind;
  const scenes::Scene& scene = world.scene;
  const std::vector<scenes::ShiningLight> lights = scenes::shining_lights(world);
  // Keys number all lights, so that switching one off does not change the samples of the others.
  std::vector<std::vector<std::size_t>> lamps(world.groups.count());
  std::vector<std::uint64_t> key(scene.lamps.size(), 0);
  std::uint64_t next_key = 16;
  for (const scenes::ShiningLight& light : lights) {
    if (light.kind != Kind::Lamp) continue;
    if (!scene.lamps[light.index].is_distant()) lamps[light.group].push_back(light.index);
    key[light.index] = next_key++;
  }
  std::vector<LightSource> sky, clusters, alone;
  const auto add = [](std::vector<LightSource>& list, LightSource source, scenes::LightKind kind) {
    source.kind = kind;
    list.push_back(std::move(source));
  };
  const std::vector<bool> is_explicit = emitter_is_explicit(scene);
  std::uint64_t emitter_key = std::uint64_t{1} << 32;
  for (const auto& [kind, group, k] : lights) {
    switch (kind) {
      case Kind::Sun:
        add(sky, sun_source(scene, group, points), scenes::LightKind::Sun);
        break;
      case Kind::SunPart:
        add(sky,
            free_sun_source(scene.sky_parts->suns[k], (std::uint64_t{1} << 40) + k, group, points),
            scenes::LightKind::Sun);
        break;
      case Kind::Earth:
        if (world.effects.earth_by_gather) break;
        add(sky, earth_source(scene, group, points), scenes::LightKind::Earth);
        break;
      case Kind::Lamp:
        if (scene.lamps[k].is_distant()) {
          add(sky, distant_source(scene.lamps[k], key[k], group, points),
              scenes::LightKind::DistantLamp);
        } else if (lamps[group].size() < fewest_in_cluster) {
          add(alone, lamp_source(scene.lamps[k], key[k], group, points),
              scenes::kind_of(scene.lamps[k].kind));
        } else if (k == lamps[group].front()) {
          add(clusters, cluster_source(scene, lamps[group], key[k], group, points),
              scenes::kind_of(scene.lamps[k].kind));
        }
        break;
      case Kind::Emitter:
        if (!is_explicit[k]) break;
        add(alone, emitter_source(scene, k, emitter_key++, group, points),
            scenes::LightKind::Emitter);
        break;
    }
  }
  std::stable_sort(
      clusters.begin(), clusters.end(),
      [](const LightSource& a, const LightSource& b) { return a.source.group < b.source.group; });
  for (std::vector<LightSource>* const more : {&clusters, &alone}) {
    std::move(more->begin(), more->end(), std::back_inserter(sky));
  }
  return sky;
}

LightSource cluster_source(const scenes::Scene& scene, const std::vector<std::size_t>& lamps,
                           std::uint64_t key, std::size_t group, int points) {
  std::vector<scenes::LightBounds> bounds;
  std::vector<double> flux_to;
  Rgb flux(0.0);
  for (const std::size_t k : lamps) {
    bounds.push_back(scenes::bounds_of(scene.lamps[k]));
    flux += scenes::lamp_flux_lm(scene.lamps[k]);
    flux_to.push_back(base::luminance(flux));
  }
  const auto cluster = std::make_shared<const Cluster>(
      Cluster{scene, lamps, scenes::LightTree(bounds), std::move(flux_to)});
  LightSource made;
  made.name = std::to_string(lamps.size()) + " lamps of group " + scene.lamps[lamps[0]].group;
  made.flux_lm = flux;
  made.emit = [cluster](double u, double v, double x, double y) {
    return cluster->emit(u, v, x, y);
  };
  made.source.key = key;
  made.source.group = group;
  made.source.points = 4 * points;
  made.source.near_factor = 4;
  made.source.distance_m = [cluster](const Vec3& point) { return cluster->distance_m(point); };
  made.source.cluster = [cluster](const Vec3& point, const Vec3& normal, double u, double v,
                                  std::vector<LightSample>& samples) {
    cluster->sample(point, normal, u, v, samples);
  };
  return made;
}

std::vector<bool> emitter_is_explicit(const scenes::Scene& scene) {
  const std::vector<double> area = areas_by_material(scene);
  const double all = std::accumulate(area.begin(), area.end(), 0.0);
  const double bright = stands_out * mean_illuminance(scene, area);
  std::vector<bool> is_explicit(area.size(), false);
  for (std::size_t m = 0; m < area.size(); ++m) {
    const scenes::Material& material = scene.materials[m];
    is_explicit[m] =
        material.emits() && area[m] < wide_share * all && base::luminance(material.emit) > bright;
  }
  return is_explicit;
}

}  // namespace earthshine::radiosity
