// SPDX-License-Identifier: Apache-2.0
// PixelShader's ray queues: final gather, rays aimed at bright patches, shadow rays; eight at a
// time.
#include <algorithm>
#include <cmath>

#include "raytrace/shading.h"
#include "scenes/sky.h"
#include "scenes/specular.h"

namespace earthshine::raytrace {

using base::pi;

namespace {

constexpr int most_specular_steps = 16;

}  // namespace

void PixelShader::gather(const Surface& surface, const Rgb& weight, int depth) {
  const base::Frame3 frame = base::frame_around(surface.normal);
  const Vec3 origin = surface.position + surface.normal * shared_.query.surface_offset_m();
  const int count = depth == 0 ? shared_.gather_rays : 1;
  const bool shares = depth == 0 && !shared_.bright.empty();
  // Cosine-distributed rays: L = (k_d / pi) integral L_in cos = k_d mean(L_in).
  const Rgb each = weight / static_cast<double>(count);
  rays_.gather += static_cast<std::uint64_t>(count);
  for (int k = 0; k < count; ++k) {
    std::array<float, 2> u{};
    if (depth == 0) {
      u = gather_points_.point2(
          static_cast<std::uint32_t>(sample_ * static_cast<std::size_t>(count)) +
          static_cast<std::uint32_t>(k));
    } else {
      u = {static_cast<float>(rng_.next()), static_cast<float>(rng_.next())};
    }
    const float r = std::sqrt(u[0]), phi = 2.0F * static_cast<float>(pi) * u[1];
    const float cosine = std::sqrt(std::max(0.0F, 1.0F - u[0]));
    queue_gather(origin, frame.to_world({r * std::cos(phi), r * std::sin(phi), cosine}), each,
                 shares ? double(cosine) : 0.0);
  }
  if (shares) aim_at_bright(surface, origin, weight);
}

// One ray per camera sample. Both ways of finding a bright patch weigh in with their densities:
// L = (k_d / pi) sum of L_in cos / (n_cosine cos / pi + n_aimed density).
void PixelShader::aim_at_bright(const Surface& surface, const Vec3& origin, const Rgb& weight) {
  const double choice = rng_.next();
  const double x = rng_.next();
  const double y = rng_.next();
  const BrightPatches::Aim aim = shared_.bright.aim(choice, x, y);
  const Vec3 way = aim.point - origin;
  const double distance = glm::length(way);
  if (distance <= 0.0) return;
  const Vec3 direction = way / distance;
  const double cosine = glm::dot(direction, surface.normal);
  const double at_patch = -glm::dot(direction, shared_.bright.patches().normal(aim.patch));
  if (cosine <= 0.0 || at_patch <= 0.0) return;
  const double aimed = shared_.bright.density_per_sr(aim.patch, distance, at_patch);
  ++rays_.gather;
  queue_gather(origin, direction,
               weight * (cosine / pi) / (shared_.gather_rays * cosine / pi + aimed), cosine,
               aim.patch);
}

// The part of a gather ray's weight that it keeps.
double PixelShader::gather_share(const scenes::Hit& hit, std::size_t lane) const {
  if (gather_cosine_[lane] <= 0.0) return 1.0;
  const radiosity::Patches& patches = shared_.bright.patches();
  const std::uint32_t patch = patches.find(hit.triangle, hit.u, hit.v, hit.front);
  if (aimed_at_[lane] != radiosity::no_patch) return patch == aimed_at_[lane] ? 1.0 : 0.0;
  if (patch == radiosity::no_patch) return 1.0;
  const double aimed = shared_.bright.density_per_sr(
      patch, hit.t, glm::dot(gather_direction_[lane], patches.normal(patch)));
  const double found = shared_.gather_rays * gather_cosine_[lane] / pi;
  return found / (found + aimed);
}

void PixelShader::queue_shadow(const Vec3& origin, const Vec3& direction, double reach_m,
                               const Rgb& value, std::size_t layer) {
  shared_.query.set(shadow_rays_, shadow_count_, origin, direction, reach_m);
  shadow_value_[shadow_count_] = value;
  shadow_layer_[shadow_count_] = layer;
  shadow_sample_[shadow_count_] = sample_;
  if (++shadow_count_ == width) flush_shadow();
}

void PixelShader::flush_shadow() {
  if (shadow_count_ == 0) return;
  const std::uint32_t hidden = shared_.query.occluded(shadow_rays_, shadow_count_);
  for (std::size_t k = 0; k < shadow_count_; ++k) {
    if (((hidden >> k) & 1U) == 0) add(shadow_layer_[k], shadow_sample_[k], shadow_value_[k]);
  }
  rays_.shadow += shadow_count_;
  shadow_count_ = 0;
}

void PixelShader::queue_gather(const Vec3& origin, const Vec3& direction, const Rgb& weight,
                               double cosine, std::uint32_t aimed_at) {
  gather_cosine_[gather_count_] = cosine;
  aimed_at_[gather_count_] = aimed_at;
  shared_.query.set(gather_rays_, gather_count_, origin, direction);
  gather_direction_[gather_count_] = direction;
  gather_weight_[gather_count_] = weight;
  gather_sample_[gather_count_] = sample_;
  if (++gather_count_ == width) flush_gather();
}

void PixelShader::gather_sky(const Vec3& direction, const Rgb& weight) {
  if (!shared_.effects.earth_by_gather) return;
  scratch_[shared_.layer[shared_.groups.earth]] +=
      weight * scenes::earth_radiance(shared_.scene, direction);
}

void PixelShader::follow_specular(scenes::Hit hit, Vec3 direction, Rgb weight) {
  const scenes::Scene& scene = shared_.scene;
  for (int step = 0; step < most_specular_steps; ++step) {
    const scenes::Material& material = scene.materials[scene.triangles[hit.triangle].material];
    const bool glass = base::max_component(material.transmit) > 0.0;
    if (!material.passes_light_on() || !(hit.front || material.two_sided || glass)) return;
    weight *= material.mirror + material.transmit;
    const Vec3 normal = scenes::triangle_normal(scene, hit.triangle);
    const Vec3 at = hit_position(scene, hit);
    direction = scenes::specular_direction(material, normal, direction);
    const double side = glm::dot(direction, normal) > 0.0 ? 1.0 : -1.0;
    hit = shared_.query.closest(at + normal * (side * shared_.query.surface_offset_m()), direction);
    ++rays_.mirror;
    if (hit.missed()) return gather_sky(direction, weight);
    if (!shared_.all_radiance.empty()) shared_.all_radiance.add(hit, weight, scratch_);
  }
}

void PixelShader::flush_gather() {
  if (gather_count_ == 0) return;
  scenes::HitPacket hits;
  shared_.query.closest(gather_rays_, gather_count_, hits);
  for (std::size_t k = 0; k < gather_count_; ++k) {
    std::fill(scratch_.begin(), scratch_.end(), Rgb(0.0));
    const scenes::Hit hit{hits.triangle[k], hits.u[k], hits.v[k], hits.t[k], hits.front[k] != 0};
    if (hit.missed()) {
      if (aimed_at_[k] == radiosity::no_patch) gather_sky(gather_direction_[k], gather_weight_[k]);
    } else {
      const Rgb weight = gather_weight_[k] * gather_share(hit, k);
      if (!shared_.all_radiance.empty()) shared_.all_radiance.add(hit, weight, scratch_);
      // Rays aimed at a patch are for what the patch itself sends.
      if (shared_.follows_specular && aimed_at_[k] == radiosity::no_patch) {
        follow_specular(hit, gather_direction_[k], gather_weight_[k]);
      }
    }
    for (std::size_t layer = 0; layer < scratch_.size(); ++layer) {
      add(layer, gather_sample_[k], scratch_[layer]);
    }
  }
  gather_count_ = 0;
}

}  // namespace earthshine::raytrace
