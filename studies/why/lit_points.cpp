// SPDX-License-Identifier: Apache-2.0
#include "studies/why/lit_points.h"

#include <algorithm>
#include <limits>
#include <map>

#include "base/numbers/sobol_set.h"
#include "base/units.h"
#include "raytrace/camera/camera.h"
#include "scenes/sky/sky.h"
#include "scenes/surface_texture.h"

namespace earthshine::studies {
namespace {

// Unoccluded light at a point from one direction.
struct Beam {
  Vec3 direction{0.0};
  double distance_m = std::numeric_limits<double>::infinity();
  double illuminance_lx = 0.0;  // normal illuminance of this sample; the `count` samples add up
};

Beam no_beam(const SeenPoint&, int) { return {}; }

// The first object on a shadow ray from the point to the light; EarthBlockers::none: none.
std::uint32_t blocker_of(const scenes::Scene& scene, const scenes::RayQuery& query,
                         const SeenPoint& point, const Beam& light) {
  const Vec3 origin = point.lifted();
  const scenes::ShadowSegment segment =
      scenes::shadow_segment({light.direction, light.distance_m}, point.position, origin);
  const scenes::Hit hit = query.closest(origin, segment.direction);
  // Excludes a lamp's own surface at the end of the ray.
  if (hit.missed() || !(hit.t < segment.reach_m * (1.0 - 1e-4))) return EarthBlockers::none;
  return scene.triangles[hit.triangle].object;
}

// beam(point, k) for k < count; blocker(i, k, light): between point i and that beam's light.
template <class BeamOf, class BlockerOf>
Reach reach_by(std::span<const SeenPoint> points, int count, BeamOf beam, BlockerOf blocker) {
  Reach reach;
  reach.lit.assign(points.size(), 0);
  reach.facing.assign(points.size(), 0);
  std::map<std::uint32_t, std::size_t> between;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const SeenPoint& point = points[i];
    for (int k = 0; k < count; ++k) {
      const Beam light = beam(point, k);
      const double cosine = glm::dot(light.direction, point.normal);
      if (!(cosine > 0.0) || !(light.illuminance_lx > 0.0)) continue;
      const double luminance = point.reflectance * light.illuminance_lx * cosine / base::pi;
      reach.facing[i] = 1;
      reach.unshadowed += luminance;
      const std::uint32_t object = blocker(i, k, light);
      if (object != EarthBlockers::none) {
        ++between[object];
        continue;
      }
      reach.lit[i] = 1;
      reach.luminance += luminance;
      reach.on_back += point.as_front * light.illuminance_lx * cosine / base::pi;
    }
  }
  if (!points.empty()) {
    reach.luminance /= static_cast<double>(points.size());
    reach.unshadowed /= static_cast<double>(points.size());
    reach.on_back /= static_cast<double>(points.size());
  }
  for (const auto& [object, rays] : between) reach.shadows.push_back({object, rays});
  std::stable_sort(reach.shadows.begin(), reach.shadows.end(),
                   [](const auto& a, const auto& b) { return a.rays > b.rays; });
  return reach;
}

template <class BeamOf>
Reach reach_of(const scenes::Scene& scene, const scenes::RayQuery& query,
               std::span<const SeenPoint> points, int count, BeamOf beam) {
  return reach_by(points, count, beam, [&](std::size_t i, int, const Beam& light) {
    return blocker_of(scene, query, points[i], light);
  });
}

// Directions of equal solid angle over the Earth's disc.
std::vector<Vec3> directions_over(const scenes::Earth& earth, int count) {
  std::vector<Vec3> directions;
  for (int k = 0; k < count; ++k) {
    const glm::dvec2 place = base::even_point(static_cast<std::size_t>(k));
    directions.push_back(scenes::sample_cone(earth.direction, base::radians(earth.half_angle_deg),
                                             place.x, place.y));
  }
  return directions;
}

Beam beam_of(const scenes::LightSample& sample, int samples) {
  return {sample.direction, sample.distance_m,
          base::luminance(sample.normal_illuminance_lx) / samples};
}

}  // namespace

std::vector<SeenPoint> seen_points(const scenes::Scene& scene, const scenes::RayQuery& query,
                                   const scenes::Camera& camera, int columns, int rows,
                                   std::span<const std::uint32_t> pixels, std::size_t most) {
  const raytrace::CameraModel model = raytrace::make_camera_model(camera, columns, rows);
  const std::size_t count = std::min(pixels.size(), most);
  std::vector<SeenPoint> points;
  points.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t pixel = pixels[i * pixels.size() / count];
    const std::uint32_t width = static_cast<std::uint32_t>(columns);
    const raytrace::Ray ray = model.ray(pixel % width + 0.5, pixel / width + 0.5, 0.0, 0.0);
    const scenes::Hit hit = query.closest(ray.origin, ray.direction);
    if (hit.missed()) continue;
    const scenes::Material& material = scene.materials[scene.triangles[hit.triangle].material];
    const Vec3 normal = scenes::triangle_normal(scene, hit.triangle);
    const Rgb diffuse = scenes::diffuse_at(scene, material, hit);
    const double reflectance = base::luminance(diffuse);
    const bool shines = hit.front || material.two_sided;
    points.push_back({scenes::hit_position(scene, hit, ray.origin, ray.direction),
                      hit.front ? normal : -normal, shines ? reflectance : 0.0,
                      !hit.front && material.has_black_back() ? reflectance : 0.0,
                      shines ? diffuse : Rgb(0.0),
                      shines ? scenes::emit_at(scene, material, hit) / base::pi : Rgb(0.0),
                      scene.triangles[hit.triangle].material, query.offset_m(hit.triangle)});
  }
  return points;
}

Reach reach_of_direction(const scenes::Scene& scene, const scenes::RayQuery& query,
                         std::span<const SeenPoint> points, const Vec3& direction,
                         double illuminance_lx) {
  const Beam light{direction, std::numeric_limits<double>::infinity(), illuminance_lx};
  return reach_of(scene, query, points, 1, [&](const SeenPoint&, int) { return light; });
}

Reach reach_of_lamp(const scenes::Scene& scene, const scenes::RayQuery& query,
                    std::span<const SeenPoint> points, const scenes::Lamp& lamp, int samples) {
  return reach_of(scene, query, points, samples, [&](const SeenPoint& point, int k) {
    const glm::dvec2 place = base::even_point(static_cast<std::size_t>(k));
    return beam_of(scenes::sample_lamp(lamp, point.position, place.x, place.y), samples);
  });
}

Reach reach_of_emitters(const scenes::Scene& scene, const scenes::RayQuery& query,
                        std::span<const SeenPoint> points, const scenes::EmitterSet& emitters,
                        int samples) {
  return reach_of(scene, query, points, samples, [&](const SeenPoint& point, int k) {
    const glm::dvec2 place = base::even_point(static_cast<std::size_t>(k));
    return beam_of(emitters.sample(point.position, place.x, place.y), samples);
  });
}

Reach reach_of_earth(const scenes::Scene& scene, const scenes::RayQuery& query,
                     std::span<const SeenPoint> points, const scenes::Earth& earth,
                     const std::optional<scenes::Sun>& sun, int directions,
                     const EarthBlockers* known) {
  scenes::Scene sky;  // the Earth's radiance depends on nothing else
  sky.sun = sun;
  sky.earth = earth;
  if (!scenes::earth_is_lit(sky)) return reach_of(scene, query, points, 0, no_beam);
  const double solid_angle =
      scenes::cone_solid_angle_sr(base::radians(earth.half_angle_deg)) / directions;
  std::vector<Beam> beams;
  for (const Vec3& direction : directions_over(earth, directions)) {
    const double radiance = base::luminance(scenes::earth_radiance(sky, direction));
    beams.push_back({direction, std::numeric_limits<double>::infinity(), radiance * solid_angle});
  }
  return reach_by(
      points, directions,
      [&](const SeenPoint&, int k) { return beams[static_cast<std::size_t>(k)]; },
      [&](std::size_t i, int k, const Beam& light) {
        if (known == nullptr) return blocker_of(scene, query, points[i], light);
        return known->object[i * beams.size() + static_cast<std::size_t>(k)];
      });
}

EarthBlockers blockers_of_earth(const scenes::Scene& scene, const scenes::RayQuery& query,
                                std::span<const SeenPoint> points, const scenes::Earth& earth,
                                int directions) {
  EarthBlockers known;
  known.object.reserve(points.size() * static_cast<std::size_t>(directions));
  const std::vector<Vec3> over = directions_over(earth, directions);
  for (const SeenPoint& point : points) {
    for (const Vec3& direction : over) {
      const bool faces = glm::dot(direction, point.normal) > 0.0;
      known.object.push_back(faces ? blocker_of(scene, query, point, Beam{direction})
                                   : EarthBlockers::none);
    }
  }
  return known;
}

Reach reach_of_earth(const scenes::Scene& scene, const scenes::RayQuery& query,
                     std::span<const SeenPoint> points, int directions) {
  if (!scene.earth) return reach_of(scene, query, points, 0, no_beam);
  return reach_of_earth(scene, query, points, *scene.earth, scene.sun, directions);
}

double share_of(const std::vector<std::uint8_t>& mask) {
  if (mask.empty()) return 0.0;
  return static_cast<double>(std::count(mask.begin(), mask.end(), 1)) /
         static_cast<double>(mask.size());
}

}  // namespace earthshine::studies
