// SPDX-License-Identifier: Apache-2.0
// What a ray that left a diffuse or glossy surface brings back: the radiosity of the patch it
// meets, the sky it escapes to, what mirrors and glass on its way pass on.
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

// How a ray shares its work with rays aimed at bright patches (multiple importance sampling,
// balance heuristic).
struct MisContext {
  double cosine = 0.0;  // at the surface it left; 0: it shares with no other ray
  BrightPatches::Place from;
  std::uint32_t aimed_at = radiosity::no_patch;   // the patch that an aimed ray must meet to count
  std::uint32_t triangle = scenes::no_triangle;   // and of a cluster the triangle
  double cosine_samples = 1.0, aimed_rays = 1.0;  // cast from that surface point each way
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

  // Adds weight * radiance along the ray to out[0 .. layers); if out is one longer, what came
  // straight from the sky is added to its last entry as well.
  // Rays that go on from mirrors and glass are counted in `rays`. Returns the kept part of what
  // surfaces send.
  double add(const scenes::Hit& hit, const Vec3& direction, const MisContext& share,
             const Rgb& weight, std::span<Rgb> out, RayCounts& rays) const;

  // Whether no ray brings anything: there is no solution, and the sky is no part of it.
  [[nodiscard]] bool is_dark() const { return table_.empty() && !earth_; }

  [[nodiscard]] const BrightPatches& bright() const { return bright_; }

  // The weight of the ray's end, of all rays that may find it, from `share`; there may be glass
  // before it that does not bend the ray.
  [[nodiscard]] double residual_weight(const scenes::Hit& hit, const Vec3& direction,
                                       const MisContext& share) const;

  // The ray aimed at a bright patch from a surface point, and its weight for reflected radiance
  // k_d / pi E: (cosine / pi) / (cosine_samples cosine / pi + aimed_rays density). Weight 0: it
  // leads nowhere.
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
  std::optional<scenes::EarthRadiance> earth_;  // where gather rays carry its light
  bool by_part_, follows_specular_;
};

}  // namespace earthshine::raytrace
