// SPDX-License-Identifier: Apache-2.0
// Radiance along a ray that left a diffuse or glossy surface: from the patch it meets, the sky it
// escapes to, and mirrors and glass on its way.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "radiosity/solution.h"
#include "raytrace/frame/frame.h"
#include "raytrace/incoming/bright_patches.h"
#include "raytrace/incoming/radiance_table.h"
#include "scenes/effects/world.h"
#include "scenes/sky/sky.h"

namespace earthshine::raytrace {

// Data for the balance heuristic of a ray, which combines cosine-distributed rays with rays aimed
// at bright patches.
struct MisContext {
  double cosine = 0.0;  // at the surface that it left; 0: no other sampling finds its hit
  BrightPatches::Place from;
  std::uint32_t aimed_at = radiosity::no_patch;   // an aimed ray counts only if it meets this patch
  std::uint32_t triangle = scenes::no_triangle;   // and this triangle of a cluster
  double cosine_samples = 1.0, aimed_rays = 1.0;  // numbers of rays of each kind from that surface
                                                  // point
};

class IncomingLight {
 public:
  IncomingLight(const scenes::World& world, const RadianceTable& table, const BrightPatches& bright,
                std::size_t layers, std::size_t earth_layer, bool follows_specular)
      : scene_(world.scene),
        query_(world.query),
        table_(table),
        bright_(bright),
        layers_(layers),
        earth_layer_(earth_layer),
        by_part_(layers > 1 && world.scene.sky_parts != nullptr),
        follows_specular_(follows_specular) {
    if (world.effects.earth_by_gather) earth_.emplace(world.scene);
  }

  // Adds weight * radiance along the ray to out[0 .. layers). If out is one longer, its last entry
  // gets the light straight from the sky as well. Counts in `rays` the rays that continue at
  // mirrors and glass. Returns the MIS weight of the light from surfaces.
  double add(const scenes::Hit& hit, const Vec3& direction, const MisContext& share,
             const Rgb& weight, std::span<Rgb> out, RayCounts& rays) const;

  // Whether all rays are dark: there is no solution, and gather rays do not carry the sky.
  [[nodiscard]] bool is_dark() const { return table_.empty() && !earth_; }

  [[nodiscard]] const BrightPatches& bright() const { return bright_; }

  // MIS weight of the ray's hit, from `share`. Glass on the way must not bend the ray.
  [[nodiscard]] double residual_weight(const scenes::Hit& hit, const Vec3& direction,
                                       const MisContext& share) const;

  // A ray aimed at a bright patch from a surface point, with its weight for the reflected radiance
  // k_d / pi E: (cosine / pi) / (cosine_samples cosine / pi + aimed_rays density). Weight 0: no
  // light.
  struct Aimed {
    Vec3 direction{0.0};
    double weight = 0.0;
    MisContext share;
  };
  [[nodiscard]] Aimed aim(const BrightPatches::Place& from, double choice, double x, double y,
                          double cosine_samples, double aimed_rays) const;

 private:
  void see_sky(const Vec3& direction, const Rgb& weight, std::span<Rgb> out, bool straight) const;
  void follow_specular(const scenes::Hit& first, const Vec3& along, const MisContext& share,
                       Rgb weight, std::span<Rgb> out, RayCounts& rays) const;
  const scenes::Scene& scene_;
  const scenes::RayQuery& query_;
  const RadianceTable& table_;
  const BrightPatches& bright_;
  std::size_t layers_, earth_layer_;
  std::optional<scenes::EarthRadiance> earth_;  // empty unless gather rays carry its light
  bool by_part_, follows_specular_;
};

}  // namespace earthshine::raytrace
