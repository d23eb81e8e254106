// SPDX-License-Identifier: Apache-2.0
#include "studies/why/last_bounce.h"

#include <algorithm>
#include <map>

#include "base/numbers/sobol_set.h"
#include "base/units.h"
#include "radiosity/direct/sources.h"
#include "scenes/light/lamp_light.h"
#include "scenes/reflect/brdf.h"
#include "scenes/sky/sky.h"
#include "scenes/surface_texture.h"

namespace earthshine::studies {
namespace {

Rgb weight_of(std::span<const Rgb> weights, std::size_t group) {
  return weights.empty() ? Rgb(1.0) : weights[group];
}

}  // namespace

LastBounces::LastBounces(const scenes::Scene& scene, const scenes::LightGroups& groups,
                         const scenes::RayQuery& query, const radiosity::Solution& solution)
    : scene_(scene),
      groups_(groups),
      query_(query),
      table_(solution, solution.radiosity, true, nothing_parted_),
      is_explicit_(radiosity::emitter_is_explicit(scene)) {}

LastBounce LastBounces::of(std::span<const SeenPoint> points, int rays) const {
  LastBounce light;
  if (table_.empty() || points.empty()) return light;
  light.straight.assign(groups_.count(), Rgb(0.0));
  std::map<std::uint32_t, std::vector<Rgb>> found;
  const double all = static_cast<double>(points.size()) * rays;
  for (std::size_t p = 0; p < points.size(); ++p) {
    const SeenPoint& point = points[p];
    const base::Frame3 frame = base::frame_around(point.normal);
    const Vec3 origin = point.lifted();
    for (std::size_t k = 0; k < static_cast<std::size_t>(rays); ++k) {
      const glm::dvec2 place = base::even_point(p * static_cast<std::size_t>(rays) + k);
      const scenes::Hit hit =
          query_.closest(origin, scenes::cosine_direction(frame, place.x, place.y));
      if (hit.missed()) continue;
      const scenes::Triangle& triangle = scene_.triangles[hit.triangle];
      std::vector<Rgb>& by_group = found[triangle.object];
      by_group.resize(groups_.count(), Rgb(0.0));
      table_.add(hit, point.diffuse / all, by_group);
      const scenes::Material& material = scene_.materials[triangle.material];
      const std::size_t group = groups_.material[triangle.material];
      const bool shines = hit.front || material.two_sided;
      if (group == scenes::no_group || is_explicit_[triangle.material] || !shines) continue;
      const Rgb own = point.diffuse / all * scenes::emit_at(scene_, material, hit) / base::pi;
      by_group[group] -= own;
      light.straight[group] += own;
    }
  }
  for (auto& [object, by_group] : found) light.reflectors.push_back({object, std::move(by_group)});
  return light;
}

void LightShares::add(std::string_view from, bool reflected, double luminance) {
  const auto found = std::find_if(list_.begin(), list_.end(), [&](const LightShare& s) {
    return s.from == from && s.reflected == reflected;
  });
  (found == list_.end() ? list_.emplace_back(LightShare{std::string(from), reflected, 0.0})
                        : *found)
      .share += luminance;
}

void LightShares::add(const LastBounce& light, std::span<const Rgb> weight) {
  for (std::size_t g = 0; g < light.straight.size(); ++g) {
    add(groups_.names[g], false, base::luminance(weight_of(weight, g) * light.straight[g]));
  }
  for (const LastBounce::Reflector& reflector : light.reflectors) {
    double luminance = 0.0;
    for (std::size_t g = 0; g < reflector.by_group.size(); ++g) {
      luminance += base::luminance(weight_of(weight, g) * reflector.by_group[g]);
    }
    add(scene_.objects[reflector.object].name, true, luminance);
  }
}

void LightShares::add_own(std::span<const SeenPoint> points, std::span<const Rgb> weight) {
  double luminance = 0.0;
  for (const SeenPoint& point : points) {
    const std::size_t group = groups_.material[point.material];
    if (group == scenes::no_group) continue;
    luminance += base::luminance(weight_of(weight, group) * point.emitted);
  }
  add(own_light, false, luminance / static_cast<double>(std::max<std::size_t>(1, points.size())));
}

std::vector<LightShare> LightShares::of(double luminance) const {
  std::vector<LightShare> shares = list_;
  for (LightShare& share : shares) share.share /= luminance;
  std::erase_if(shares, [](const LightShare& s) { return s.share == 0.0; });
  std::stable_sort(shares.begin(), shares.end(),
                   [](const LightShare& a, const LightShare& b) { return a.share > b.share; });
  return shares;
}

std::vector<LightShare> light_shares(const scenes::World& world,
                                     const radiosity::Solution& solution,
                                     std::span<const SeenPoint> points, double luminance,
                                     int rays) {
  const auto& [scene, groups, effects, query] = world;
  LightShares shares(scene, groups);
  constexpr int samples = 64;  // of each lamp
  for (std::size_t k = 0; k < scene.lamps.size(); ++k) {
    if (groups.lamp[k] == scenes::no_group) continue;
    shares.add(groups.names[groups.lamp[k]], false,
               reach_of_lamp(scene, query, points, scene.lamps[k], samples).luminance);
  }
  const std::vector<bool> is_explicit = radiosity::emitter_is_explicit(scene);
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    if (groups.material[m] == scenes::no_group || !is_explicit[m]) continue;
    const scenes::EmitterSet emitters(scene, m);
    shares.add(groups.names[groups.material[m]], false,
               reach_of_emitters(scene, query, points, emitters, samples).luminance);
  }
  if (scene.sun && groups.sun != scenes::no_group) {
    shares.add("sun", false,
               scenes::visible_sun_share(scene) *
                   reach_of_direction(scene, query, points, scene.sun->direction,
                                      base::luminance(scene.sun->illuminance_lx))
                       .luminance);
  }
  if (groups.earth != scenes::no_group) {
    shares.add("earth", false, reach_of_earth(scene, query, points, 1024).luminance);
  }
  shares.add_own(points);
  shares.add(LastBounces(scene, groups, query, solution).of(points, rays));
  return shares.of(luminance);
}

}  // namespace earthshine::studies
