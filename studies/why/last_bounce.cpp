// SPDX-License-Identifier: Apache-2.0
#include "studies/why/last_bounce.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/units.h"
#include "radiosity/direct/explicit_emitters.h"
#include "raytrace/incoming/radiance_table.h"
#include "scenes/sky/sky.h"

namespace earthshine::studies {
namespace {

constexpr double least_share = 0.01;

double fraction(double x) { return x - std::floor(x); }

// Even over the hemisphere about z by the cosine: the plastic number's additive sequence.
Vec3 cosine_direction(std::size_t k) {
  const double u = fraction(0.5 + 0.7548776662466927 * static_cast<double>(k + 1)),
               v = fraction(0.5 + 0.5698402909980532 * static_cast<double>(k + 1));
  const double r = std::sqrt(u), phi = 2.0 * base::pi * v;
  return {r * std::cos(phi), r * std::sin(phi), std::sqrt(std::max(0.0, 1.0 - u))};
}

}  // namespace

std::vector<ByWayOf> light_by_way_of(const scenes::Scene& scene, const scenes::RayQuery& query,
                                     const radiosity::Solution& solution, std::size_t groups,
                                     std::span<const SeenPoint> points, int rays) {
  if (solution.patches.count() == 0 || points.empty()) return {};
  const raytrace::LeakMask nothing_parted;
  const raytrace::RadianceTable table(solution, solution.radiosity, true, nothing_parted);
  std::map<std::uint32_t, std::vector<Rgb>> found;
  const double all = static_cast<double>(points.size()) * rays;
  for (std::size_t p = 0; p < points.size(); ++p) {
    const SeenPoint& point = points[p];
    const base::Frame3 frame = base::frame_around(point.normal);
    const Vec3 origin = point.position + query.surface_offset_m() * point.normal;
    for (int k = 0; k < rays; ++k) {
      const Vec3 local =
          cosine_direction(p * static_cast<std::size_t>(rays) + static_cast<std::size_t>(k));
      const scenes::Hit hit = query.closest(origin, frame.to_world(local));
      if (hit.missed()) continue;
      std::vector<Rgb>& by_group = found[scene.triangles[hit.triangle].object];
      by_group.resize(groups, Rgb(0.0));
      table.add(hit, point.diffuse / all, by_group);
    }
  }
  std::vector<ByWayOf> list;
  for (auto& [object, by_group] : found) list.push_back({object, std::move(by_group)});
  return list;
}

std::vector<LightShare> light_shares(const scenes::Scene& scene, const scenes::LightGroups& groups,
                                     const scenes::RayQuery& query,
                                     const radiosity::Solution& solution,
                                     std::span<const SeenPoint> points, double luminance,
                                     int rays) {
  std::vector<LightShare> shares;
  const auto add = [&](const std::string& from, bool reflected, double light) {
    const auto found = std::find_if(shares.begin(), shares.end(), [&](const LightShare& s) {
      return s.from == from && s.reflected == reflected;
    });
    LightShare& share =
        found == shares.end() ? shares.emplace_back(LightShare{from, reflected, 0.0}) : *found;
    share.share += light / luminance;
  };
  constexpr int samples = 64;  // of each lamp
  for (std::size_t k = 0; k < scene.lamps.size(); ++k) {
    if (groups.lamp[k] == scenes::no_group) continue;
    add(groups.names[groups.lamp[k]], false,
        reach_of_lamp(scene, query, points, scene.lamps[k], samples).luminance);
  }
  const std::vector<bool> straight = radiosity::emitter_is_explicit(scene);
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    if (groups.material[m] == scenes::no_group || !straight[m]) continue;
    const scenes::EmitterSet emitters(scene, m);
    add(groups.names[groups.material[m]], false,
        reach_of_emitters(scene, query, points, emitters, samples).luminance);
  }
  if (scene.sun && groups.sun != scenes::no_group) {
    add("sun", false,
        scenes::visible_sun_share(scene) *
            reach_of_direction(scene, query, points, scene.sun->direction,
                               base::luminance(scene.sun->illuminance_lx))
                .luminance);
  }
  if (groups.earth != scenes::no_group) {
    add("earth", false, reach_of_earth(scene, query, points, 1024).luminance);
  }
  double own = 0.0;
  for (const SeenPoint& point : points) {
    own += point.emitted / static_cast<double>(points.size());
  }
  if (own > 0.0) add(own_light, false, own);
  for (const ByWayOf& way : light_by_way_of(scene, query, solution, groups.count(), points, rays)) {
    double light = 0.0;
    for (const Rgb& of_group : way.by_group) light += base::luminance(of_group);
    add(scene.objects[way.object].name, true, light);
  }
  return sorted_shares(std::move(shares));
}

std::vector<LightShare> sorted_shares(std::vector<LightShare> shares) {
  std::erase_if(shares, [](const LightShare& s) { return !(s.share >= least_share); });
  std::stable_sort(shares.begin(), shares.end(),
                   [](const LightShare& a, const LightShare& b) { return a.share > b.share; });
  return shares;
}

}  // namespace earthshine::studies
