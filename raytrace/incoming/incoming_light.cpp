// SPDX-License-Identifier: Apache-2.0
#include "raytrace/incoming/incoming_light.h"

#include <algorithm>
#include <cmath>

#include "scenes/reflect/specular.h"
#include "scenes/sky/sky.h"
#include "scenes/sky/sky_cells.h"
#include "scenes/specular_paths.h"

namespace earthshine::raytrace {
namespace {

using base::pi;

}  // namespace

void IncomingLight::see_sky(const Vec3& direction, const Rgb& weight, std::span<Rgb> out,
                            bool straight) const {
  if (!earth_) return;
  const Rgb light = weight * (*earth_)(direction);
  out[earth_layer_ + (by_part_ ? scenes::earth_part(scene_, direction) : 0)] += light;
  if (straight && out.size() > layers_) out.back() += light;
}

// Aimed rays find bright patches through glass that does not bend them, too. All other light by
// mirrors and glass belongs to the cosine-distributed rays.
void IncomingLight::follow_specular(const scenes::Hit& first, const Vec3& along,
                                    const MisContext& share, Rgb weight, std::span<Rgb> out,
                                    RayCounts& rays) const {
  const bool aimed = share.aimed_at != radiosity::no_patch;
  bool glass = false;  // whether the last surface was glass
  const auto visit = [&](const scenes::Hit& hit, const Vec3& direction, int step) {
    if (step > 0) {
      ++(glass ? rays.refraction : rays.mirror);
      if (hit.missed()) {
        if (!aimed) see_sky(direction, weight, out, false);
        return false;
      }
      const bool straight = scenes::goes_straight_on(along, direction);
      const double kept = straight ? residual_weight(hit, direction, share) : 1.0;
      if (!table_.empty() && kept > 0.0) table_.add(hit, weight * kept, out);
      if ((aimed && kept > 0.0) || step == scenes::most_specular_steps) return false;
    }
    const scenes::Material& material = scene_.materials[scene_.triangles[hit.triangle].material];
    glass = base::max_component(material.transmit) > 0.0;
    weight *= material.mirror + material.transmit;
    return material.passes_light_on() && (hit.front || material.two_sided || glass);
  };
  scenes::follow_specular(scene_, query_, first, along, aimed, visit);
}

double IncomingLight::residual_weight(const scenes::Hit& hit, const Vec3& direction,
                                      const MisContext& share) const {
  if (share.cosine <= 0.0) return 1.0;
  const radiosity::Patches& patches = bright_.patches();
  const std::uint32_t patch = patches.find(hit.triangle, hit.u, hit.v, hit.front);
  if (share.aimed_at != radiosity::no_patch) {
    // A curved patch may occlude itself.
    const bool there = share.triangle == scenes::no_triangle || share.triangle == hit.triangle;
    return patch == share.aimed_at && there ? 1.0 : 0.0;
  }
  if (patch == radiosity::no_patch || !bright_.holds(patch)) return 1.0;
  // Behind glass, hit.t is only the last segment.
  const double distance_m = glm::distance(scenes::hit_position(scene_, hit), share.from.position);
  const double density =
      bright_.density_per_sr(share.from, patch, distance_m,
                             glm::dot(direction, patches.normal_at(hit.triangle, hit.front)));
  const double found = share.cosine_samples * share.cosine / pi;
  return found / (found + share.aimed_rays * density);
}

double IncomingLight::add(const scenes::Hit& hit, const Vec3& direction, const MisContext& share,
                          const Rgb& weight, std::span<Rgb> out, RayCounts& rays) const {
  const bool aimed = share.aimed_at != radiosity::no_patch;
  if (hit.missed()) {
    if (!aimed) see_sky(direction, weight, out, true);
    return 0.0;
  }
  const double kept = residual_weight(hit, direction, share);
  if (!table_.empty() && kept > 0.0) table_.add(hit, weight * kept, out);
  if (follows_specular_ && !(aimed && kept > 0.0) && !is_dark()) {
    follow_specular(hit, direction, share, weight, out, rays);
  }
  return kept;
}

IncomingLight::Aimed IncomingLight::aim(const BrightPatches::Place& from, double choice, double x,
                                        double y, double cosine_samples, double aimed_rays) const {
  Aimed aimed;
  const std::optional<BrightPatches::Aim> target = bright_.aim(from, choice, x, y);
  if (!target) return aimed;
  const Vec3 offset = target->point - from.position;
  const double distance = glm::length(offset);
  if (distance <= 0.0) return aimed;
  aimed.direction = offset / distance;
  const double cosine = glm::dot(aimed.direction, from.normal);
  const double at_patch = -glm::dot(aimed.direction, target->normal);
  if (cosine <= 0.0 || at_patch <= 0.0) return aimed;
  const double density = bright_.density_per_sr(from, target->patch, distance, at_patch);
  aimed.weight = (cosine / pi) / (cosine_samples * cosine / pi + aimed_rays * density);
  aimed.share = {cosine, from, target->patch, target->triangle, cosine_samples, aimed_rays};
  return aimed;
}

}  // namespace earthshine::raytrace
