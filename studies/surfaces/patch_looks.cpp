// SPDX-License-Identifier: Apache-2.0
#include "studies/surfaces/patch_looks.h"

#include "scenes/reflect/specular.h"
#include "scenes/sky/sky.h"
#include "scenes/sky/sky_cells.h"

namespace earthshine::studies {
namespace {

using scenes::RayPacket;

constexpr int most_specular_steps = 64;

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
      add_shadow_ray(from.at + from.lift, sample, share * sample.normal_illuminance_lx, look,
                     source.group, twice);
    }
  }
}

void PatchLooks::add_shadow_ray(const Vec3& origin, const scenes::LightSample& sample,
                                const Rgb& lx, std::size_t look, std::size_t group, bool twice) {
  const double reach = sample.distance_m * (1.0 - 1e-5) - 2.0 * scene_.query.surface_offset_m();
  if (base::max_component(lx) <= 0.0 || reach <= 0.0) return;
  scene_.query.set(packet_, count_, origin, sample.direction, reach);
  mirror_[count_] = sample.mirror;
  lx_[count_] = lx;
  to_[count_] = look * groups_ + group;
  twice_[count_] = twice;
  if (++count_ == RayPacket::width) finish_shadows();
}

void PatchLooks::finish_shadows() {
  if (count_ == 0) return;
  std::array<Rgb, RayPacket::width> shares;
  scene_.query.light_shares(packet_, mirror_.data(), count_, shares.data());
  for (std::size_t k = 0; k < count_; ++k) {
    const Rgb arrives = shares[k] * lx_[k];
    lamps_[to_[k]] += arrives;
    if (twice_[k]) lamps_[to_[k] + groups_] += arrives;
  }
  rays_ += count_;
  count_ = 0;
}

void PatchLooks::gather(const Vec3& origin, const std::array<Vec3, RayPacket::width>& directions,
                        double weight, std::size_t look) {
  RayPacket packet;
  scenes::HitPacket hits;
  for (std::size_t k = 0; k < RayPacket::width; ++k) {
    scene_.query.set(packet, k, origin, directions[k]);
  }
  scene_.query.closest(packet, RayPacket::width, hits);
  rays_ += RayPacket::width;
  for (std::size_t k = 0; k < RayPacket::width; ++k) {
    follow({hits.triangle[k], double(hits.u[k]), double(hits.v[k]), double(hits.t[k]),
            hits.front[k] != 0},
           directions[k], weight, look);
  }
}

// Reads the surface, and those that mirrors and glass lead on to, as the form factors have it
// (radiosity/factors/row_caster.cpp).
void PatchLooks::follow(scenes::Hit hit, Vec3 way, double weight, std::size_t look) {
  for (int step = 0; step <= most_specular_steps; ++step) {
    if (hit.missed()) return escape(way, weight, look);
    const std::uint32_t m = scene_.scene.triangles[hit.triangle].material;
    const bool front = hit.front || scene_.scene.materials[m].two_sided;
    if (front) table_.add(hit, Rgb(base::pi * weight), gathered(look));
    const bool glass = base::max_component(scene_.scene.materials[m].transmit) > 0.0;
    if (!front && !glass) {
      lost_ += weight;
      return;
    }
    if (front) weight *= 1.0 - kept_[m];
    if (weight <= 0.0) return;
    const scenes::SpecularStep on =
        scenes::specular_step(scene_.scene, hit, way, scene_.query.surface_offset_m());
    way = on.direction;
    hit = scene_.query.closest(on.origin, way);
    ++rays_;
  }
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
