// SPDX-License-Identifier: Apache-2.0
#include "raytrace/surfaces/patch_sampler.h"

#include <cmath>

#include "scenes/reflect/brdf.h"
#include "scenes/reflect/specular.h"
#include "scenes/sky/sky.h"
#include "scenes/sky/sky_cells.h"

namespace earthshine::raytrace {
namespace {

using scenes::RayPacket;

constexpr std::size_t cosine_rays_each = 8;  // cosine rays per aimed ray

}  // namespace

void PatchSampler::start(std::size_t points) {
  lamps_.assign(points * 2 * groups_, Rgb(0.0));
  gathered_.assign(points * 2 * groups_, Rgb(0.0));
  sky_.assign(points * 2 * sky_parts_, Rgb(0.0));
  escaped_ = lost_ = 0.0;
}

void PatchSampler::sample_source(const radiosity::Source& source, const SurfaceSpot& from,
                                 const base::SobolOwen4& sequence, std::size_t first,
                                 std::size_t rays, std::size_t entry, bool twice) {
  for (std::size_t m = first; m < first + rays; ++m) {
    const auto u = sequence.point2(static_cast<std::uint32_t>(m));
    radiosity::take_samples(source, scene_.query.specular_paths().mirrors(), from.at, from.normal,
                            double(u[0]), double(u[1]), taken_);
    for (const scenes::LightSample& sample : taken_) {
      const double share = glm::dot(sample.direction, from.normal) / static_cast<double>(rays);
      add_shadow_ray(from, sample, share * sample.normal_illuminance_lx, entry, source.group,
                     twice);
    }
  }
}

void PatchSampler::add_shadow_ray(const SurfaceSpot& from, const scenes::LightSample& sample,
                                  const Rgb& lx, std::size_t entry, std::size_t group, bool twice) {
  if (base::max_component(lx) <= 0.0) return;
  shadows_.add(sample, from.at, from.at + from.lift, {lx, entry * groups_ + group, twice},
               [this](const Arriving& light, const Rgb& share) { take(light, share); });
}

void PatchSampler::take(const Arriving& light, const Rgb& share) {
  const Rgb arrives = share * light.lx;
  lamps_[light.to] += arrives;
  if (light.twice) lamps_[light.to + groups_] += arrives;
}

void PatchSampler::finish_shadows() {
  shadows_.trace([this](const Arriving& light, const Rgb& share) { take(light, share); });
}

void PatchSampler::gather(const SurfaceSpot& from, const base::SobolOwen4& sequence,
                          const base::SobolOwen4& aims, std::size_t point, std::size_t rays,
                          std::size_t entry) {
  const bool is_uniform = incoming_.bright().empty();
  const std::size_t aimed = is_uniform ? 0 : rays / cosine_rays_each;
  MisContext share;
  share.cosine_samples = static_cast<double>(rays);
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
      share.cosine = is_uniform ? 0.0 : cosine[k];
      follow(hit, directions[k], share, entry);
    }
  }
  for (std::size_t k = point * aimed; k < (point + 1) * aimed; ++k) {
    aim(from, aims.point(static_cast<std::uint32_t>(k)), share, entry);
  }
}

// An aimed ray adds only the light of its target patch, seen directly or through glass that does
// not bend the ray.
void PatchSampler::aim(const SurfaceSpot& from, const std::array<float, 4>& u,
                       const MisContext& all, std::size_t entry) {
  const IncomingLight::Aimed aimed =
      incoming_.aim({from.at + from.lift, from.normal}, double(u[0]), double(u[1]), double(u[2]),
                    all.cosine_samples, all.aimed_rays);
  double weight = aimed.weight;
  if (weight <= 0.0) return;
  const auto visit = [&](const scenes::Hit& hit, const Vec3& direction, int step) {
    ++rays_;
    if (hit.missed()) return false;
    if (incoming_.residual_weight(hit, direction, aimed.share) > 0.0) {
      table_.add(hit, Rgb(base::pi * weight), gathered(entry));
      return false;
    }
    const std::uint32_t m = scene_.scene.triangles[hit.triangle].material;
    if (hit.front || scene_.scene.materials[m].two_sided) weight *= 1.0 - kept_[m];
    return weight > 0.0 && step < scenes::most_specular_steps;
  };
  const scenes::Hit first = scene_.query.closest(from.at + from.lift, aimed.direction);
  scenes::follow_specular(scene_.scene, scene_.query, first, aimed.direction, true, visit);
}

// Reads the surface, and those behind mirrors and glass, as the form factors do
// (radiosity/factors/row_caster.cpp).
void PatchSampler::follow(const scenes::Hit& first, const Vec3& along, const MisContext& share,
                          std::size_t entry) {
  double weight = 1.0 / share.cosine_samples;
  const auto visit = [&](const scenes::Hit& hit, const Vec3& direction, int step) {
    if (step > 0) ++rays_;
    if (step > scenes::most_specular_steps) return false;
    if (hit.missed()) {
      escape(direction, weight, entry);
      return false;
    }
    const std::uint32_t m = scene_.scene.triangles[hit.triangle].material;
    const bool front = hit.front || scene_.scene.materials[m].two_sided;
    if (front) {
      const bool aimed_come =
          scenes::goes_straight_on(along, direction);  // aimed rays find this hit,
                                                       // too
      const double kept = aimed_come ? incoming_.residual_weight(hit, direction, share) : 1.0;
      table_.add(hit, Rgb(base::pi * weight * kept), gathered(entry));
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

void PatchSampler::escape(const Vec3& direction, double weight, std::size_t entry) {
  escaped_ += weight;
  if (!scene_.effects.earth_by_gather) return;
  const Rgb lx = base::pi * weight * scenes::earth_radiance(scene_.scene, direction);
  const std::size_t part = scenes::earth_part(scene_.scene, direction);
  gathered(entry)[scene_.groups.earth + part] += lx;
  sky(entry)[part] += lx;
}

}  // namespace earthshine::raytrace
