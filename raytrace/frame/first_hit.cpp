// SPDX-License-Identifier: Apache-2.0
#include "raytrace/frame/first_hit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "scenes/surface_texture.h"

namespace earthshine::raytrace {
namespace {

// The hit of the ray through a pixel's centre.
struct FirstHit {
  const scenes::Triangle* triangle = nullptr;  // nullptr: no hit
  Rgb albedo{0.0};
  Vec3 position{0.0}, normal{0.0};
  double range_m = 0.0, depth_m = 0.0;
};

FirstHit first_hit(const scenes::Scene& scene, const scenes::RayQuery& query,
                   const CameraModel& camera, double x, double y) {
  FirstHit found;
  const Ray ray = camera.ray(x, y, 0.0, 0.0);
  const scenes::Hit hit = query.closest(ray.origin, ray.direction);
  if (hit.missed()) return found;
  found.triangle = &scene.triangles[hit.triangle];
  found.albedo = scenes::diffuse_at(scene, scene.materials[found.triangle->material], hit);
  const Vec3 normal = scenes::triangle_normal(scene, hit.triangle);
  // Intersection with the triangle's plane in double precision: the traced distance is in single
  // precision, whose rounding is visible when positions are projected back.
  const double towards = glm::dot(ray.direction, normal);
  const double exact =
      glm::dot(scene.vertices[found.triangle->vertex[0]] - ray.origin, normal) / towards;
  found.range_m = std::abs(exact - hit.t) < 1e-3 * hit.t ? exact : hit.t;
  found.position = ray.origin + found.range_m * ray.direction;
  found.depth_m = found.range_m * glm::dot(ray.direction, camera.forward);
  found.normal = hit.front ? normal : -normal;
  return found;
}

float axis(const Vec3& v, char name) {
  return static_cast<float>(name == 'X' || name == 'R'   ? v.x
                            : name == 'Y' || name == 'G' ? v.y
                                                         : v.z);
}

using Value = float (*)(const FirstHit&, char last);

struct Measured {
  const char* aov;
  std::vector<std::string> channels;
  float missed;  // value without a hit
  Value value;
};

const std::vector<Measured>& measured() {
  constexpr float infinite = std::numeric_limits<float>::infinity();
  static const std::vector<Measured> table = {
      {"albedo",
       {"albedo.R", "albedo.G", "albedo.B"},
       0.0F,
       [](const FirstHit& h, char c) { return axis(h.albedo, c); }},
      {"normal",
       {"N.X", "N.Y", "N.Z"},
       0.0F,
       [](const FirstHit& h, char c) { return axis(h.normal, c); }},
      {"position",
       {"P.X", "P.Y", "P.Z"},
       0.0F,
       [](const FirstHit& h, char c) { return axis(h.position, c); }},
      {"depth",
       {"Z"},
       infinite,
       [](const FirstHit& h, char) { return static_cast<float>(h.depth_m); }},
      {"range",
       {"range"},
       infinite,
       [](const FirstHit& h, char) { return static_cast<float>(h.range_m); }},
      {"object",
       {"object"},
       -1.0F,
       [](const FirstHit& h, char) { return static_cast<float>(h.triangle->object); }},
      {"material", {"material"}, -1.0F, [](const FirstHit& h, char) {
         return static_cast<float>(h.triangle->material);
       }}};
  return table;
}

// A channel of the image, and its source.
struct Filled {
  std::vector<float>* values;
  const Measured* layer;
  char last;
};

std::vector<Filled> channels_to_fill(base::Image& image) {
  std::vector<Filled> filled;
  for (base::Channel& channel : image.channels) {
    for (const Measured& layer : measured()) {
      if (std::find(layer.channels.begin(), layer.channels.end(), channel.name) ==
          layer.channels.end()) {
        continue;
      }
      filled.push_back({&channel.values, &layer, channel.name.back()});
    }
  }
  return filled;
}

}  // namespace

const std::vector<FirstHitLayer>& first_hit_layers() {
  static const std::vector<FirstHitLayer> table = [] {
    std::vector<FirstHitLayer> all;
    for (const Measured& layer : measured()) all.push_back({layer.aov, layer.channels});
    return all;
  }();
  return table;
}

std::uint64_t fill_first_hit(const scenes::Scene& scene, const scenes::RayQuery& query,
                             const CameraModel& camera, const Window& window, base::Image& image) {
  const std::vector<Filled> filled = channels_to_fill(image);
  if (filled.empty()) return 0;
  base::parallel_chunks(
      static_cast<std::size_t>(window.rows), 8, [&](std::size_t begin, std::size_t end) {
        for (int y = window.y + static_cast<int>(begin); y < window.y + static_cast<int>(end);
             ++y) {
          for (int x = window.x; x < window.x + window.columns; ++x) {
            const FirstHit hit = first_hit(scene, query, camera, x + 0.5, y + 0.5);
            for (const Filled& channel : filled) {
              (*channel.values)[window.index(x, y)] = hit.triangle == nullptr
                                                          ? channel.layer->missed
                                                          : channel.layer->value(hit, channel.last);
            }
          }
        }
      });
  return window.pixel_count();
}

}  // namespace earthshine::raytrace
