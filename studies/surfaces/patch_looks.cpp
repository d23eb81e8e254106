// SPDX-License-Identifier: Apache-2.0
#include "studies/surfaces/patch_looks.h"

#include <cmath>

#include "scenes/reflect/brdf.h"
#include "scenes/reflect/specular.h"
#include "scenes/sky/sky.h"
#include "scenes/sky/sky_cells.h"

namespace earthshine::studies {
namespace {

using scenes::RayPacket;

constexpr std::size_t cosine_rays_each = 8;  // of those that are aimed at bright patches

}  // namespace

void PatchLooks::start(std::size_t points) {
  lamps_.assign(points * 2 * groups_, Rgb(0.0));
  gathered_.assign(points * 2 * groups_, Rgb(0.0));
  sky_.assign(points * 2 * sky_parts_, Rgb(0.0));
  escaped_ = lost_ = 0.0;
}

void PatchLooks::look_at(const radiosity::Source& source, const LookingPoint& from,
                         const base::SobolOwen4& sequence, std::size_t first, std::size_t rays,
                         std::size_t look, bool twice) {
  for (std::size_t m = first; m < first + rays; ++m) {
    const auto u = sequence.point2(static_cast<std::uint32_t>(m));
    radiosity::take_samples(source, scene_.query.ways().mirrors(), from.at, from.normal,
                            double(u[0]), double(u[1]), taken_);
    for (const scenes::LightSample& sample : taken_) {
      const double share = glm::dot(sample.direction, from.normal) / static_cast<double>(rays);
      add_shadow_ray(from, sample, share * sample.normal_illuminance_lx, look, source.group, twice);
    }
  }
}

void PatchLooks::add_shadow_ray(const LookingPoint& from, const scenes::LightSample& sample,
                                const Rgb& lx, std::size_t look, std::size_t group, bool twice) {
  if (base::max_component(lx) <= 0.0) return;
  shadows_.add(sample, from.at, from.at + from.lift, {lx, look * groups_ + group, twice},
               [this](const Arriving& light, const Rgb& share) { take(light, share); });
}

void PatchLooks::take(const Arriving& light, const Rgb& share) {
  const Rgb arrives = share * light.lx;
  lamps_[light.to] += arrives;
  if (light.twice) lamps_[light.to + groups_] += arrives;
}

void PatchLooks::finish_shadows() {
  shadows_.trace([this](const Arriving& light, const Rgb& share) { take(light, share); });
}

void PatchLooks::gather(const LookingPoint& from, const base::SobolOwen4& sequence,
                        const base::SobolOwen4& aims, std::size_t point, std::size_t rays,
                        std::size_t look) {
  const bool is_even = incoming_.bright().empty();
  const std::size_t aimed = is_even ? 0 : rays / cosine_rays_each;
  raytrace::RayShare share;
  share.found_rays = static_cast<double>(rays);
  share.aimed_rays = static_cast<double>(aimed);
  share.from = {from.at + from.lift, from.normal};
  const base::Frame3 frame = base::frame_around(from.normal);
  RayPacket packet;
  scenes::HitPacket hits;
  std::array<Vec3, RayPacket::width> directions;
  std::array<double, RayPacket::width> cosine{};
  for (std::size_t first = point * rays; first < (point + 1) * rays; first += RayPacket::width) {
    for (std::size_t k = 0; k < RayPacket::width; ++k) {
      const auto u = sequence.point2(static_cast<std::uint32_t>(first + k));
      const Vec3 local = scenes::cosine_sample(double(u[0]), double(u[1]));
      cosine[k] = local.z;
      directions[k] = frame.to_world(local);
      scene_.query.set(packet, k, from.at + from.lift, directions[k]);
    }
    scene_.query.closest(packet, RayPacket::width, hits);
    rays_ += RayPacket::width;
    for (std::size_t k = 0; k < RayPacket::width; ++k) {
      const scenes::Hit hit{hits.triangle[k], double(hits.u[k]), double(hits.v[k]),
                            double(hits.t[k]), hits.front[k] != 0};
      share.cosine = is_even ? 0.0 : cosine[k];
      follow(hit, directions[k], share, look);
    }
  }
  for (std::size_t k = point * aimed; k < (point + 1) * aimed; ++k) {
    aim(from, aims.point(static_cast<std::uint32_t>(k)), share, look);
  }
}

// Of what such a ray meets only what the patch itself sends counts, straight or through glass that
// does not bend it.
void PatchLooks::aim(const LookingPoint& from, const std::array<float, 4>& u,
                     const raytrace::RayShare& all, std::size_t look) {
  const raytrace::IncomingLight::Aimed aimed =
      incoming_.aim({from.at + from.lift, from.normal}, double(u[0]), double(u[1]), double(u[2]), all.found_rays,
                    all.aimed_rays);
  double weight = aimed.weight;
  if (weight <= 0.0) return;
  const auto visit = [&](const scenes::Hit& hit, const Vec3& direction, int step) {
    ++rays_;
    if (hit.missed()) return false;
    if (incoming_.kept_part(hit, direction, aimed.share) > 0.0) {
      table_.add(hit, Rgb(base::pi * weight), gathered(look));
      return false;
    }
    const std::uint32_t m = scene_.scene.triangles[hit.triangle].material;
    if (hit.front || scene_.scene.materials[m].two_sided) weight *= 1.0 - kept_[m];
    return weight > 0.0 && step < scenes::most_specular_steps;
  };
  const scenes::Hit first = scene_.query.closest(from.at + from.lift, aimed.direction);
  scenes::follow_specular(scene_.scene, scene_.query, first, aimed.direction, true, visit);
}

// Reads the surface, and those that mirrors and glass lead on to, as the form factors have it
// (radiosity/factors/row_caster.cpp).
void PatchLooks::follow(const scenes::Hit& first, const Vec3& along,
                        const raytrace::RayShare& share, std::size_t look) {
  double weight = 1.0 / share.found_rays;
  const auto visit = [&](const scenes::Hit& hit, const Vec3& way, int step) {
    if (step > 0) ++rays_;
    if (step > scenes::most_specular_steps) return false;
    if (hit.missed()) {
      escape(way, weight, look);
      return false;
    }
    const std::uint32_t m = scene_.scene.triangles[hit.triangle].material;
    const bool front = hit.front || scene_.scene.materials[m].two_sided;
    if (front) {
      const bool aimed_come = scenes::goes_straight_on(along, way);  // to what is met, too
      const double kept = aimed_come ? incoming_.kept_part(hit, way, share) : 1.0;
      table_.add(hit, Rgb(base::pi * weight * kept), gathered(look));
    }
    const bool glass = base::max_component(scene_.scene.materials[m].transmit) > 0.0;
    if (!front && !glass) {
      lost_ += weight;
      return false;
    }
    if (front) weight *= 1.0 - kept_[m];
    return weight > 0.0;
  };
  scenes::follow_specular(scene_.scene, scene_.query, first, along, false, visit);
}

void PatchLooks::escape(const Vec3& way, double weight, std::size_t look) {
  escaped_ += weight;
  if (!scene_.effects.earth_by_gather) return;
  const Rgb lx = base::pi * weight * scenes::earth_radiance(scene_.scene, way);
  const std::size_t part = scenes::earth_part(scene_.scene, way);
  gathered(look)[scene_.groups.earth + part] += lx;
  sky(look)[part] += lx;
}

}  // namespace earthshine::studies
