// SPDX-License-Identifier: Apache-2.0
// PixelShader's diffuse light, its ray queues (eight rays at a time), and the samples' luminances.
#include <algorithm>
#include <cmath>

#include "raytrace/shade/shading.h"
#include "raytrace/tuning.h"

namespace earthshine::raytrace {

using base::pi;

void PixelShader::diffuse(const Surface& surface, const Rgb& weight, int depth) {
  if (!shared_.gathers) return;
  const Rgb reflected = weight * surface.brdf.diffuse;
  if (has_points(depth) && read_field(surface, reflected)) return;
  gather(surface, reflected, depth);
}

GatherField::Reading PixelShader::read_points(const Surface& surface, Gathered kind) const {
  const GatherField& field = *shared_.field;
  const Vec3 seen = mirror_ ? mirror_->image(surface.position) : surface.position;
  const Vec3 normal =
      mirror_ ? glm::reflect(surface.brdf.normal, mirror_->normal) : surface.brdf.normal;
  const Sighting place{glm::vec3(seen - shared_.sighting_origin), glm::vec3(normal),
                       mirror_.has_value()};
  std::size_t own = field.find(x_, y_, place);
  if (own == no_point && sample_ < tuning::samples_beside)
    own = field.find_beside(x_, y_, place, kind);
  return own == no_point ? GatherField::Reading() : field.reading(x_, y_, place, own, kind);
}

FieldTerm& PixelShader::term_of(std::size_t point) {
  for (FieldTerm& term : terms_) {
    if (term.point == point) return term;
  }
  return terms_.emplace_back(FieldTerm{static_cast<std::uint32_t>(point)});
}

// sum: of the layers of a gather point's radiance; weight: from this to the camera.
void PixelShader::count_read(const glm::vec3& sum, const Rgb& weight) {
  sample_luminance_[sample_ - first_sample_] += base::luminance(weight * Rgb(sum));
}

bool PixelShader::read_field(const Surface& surface, const Rgb& weight) {
  const GatherField::Reading read = read_points(surface, Gathered::Solution);
  if (read.count == 0 || shared_.field->points()[read.point[0]].reflectance <= 0.0F) return false;
  for (std::size_t k = 0; k < read.count; ++k) {
    const Rgb part = weight * double(read.weight[k]);
    term_of(read.point[k]).diffuse += glm::vec3(part);
    count_read(shared_.field->diffuse_sum(read.point[k]), part);
  }
  return true;
}

bool PixelShader::read_lobe(const Surface& surface, const Rgb& weight) {
  const GatherField::Reading read = read_points(surface, Gathered::Lobe);
  if (read.count == 0) return false;
  const std::uint32_t material = shared_.field->points()[read.point[0]].material;
  if (&shared_.scene.materials[material] != &surface.material()) return false;
  if (shared_.field->points()[read.point[0]].lobe <= 0.0F) return false;
  for (std::size_t k = 0; k < read.count; ++k) {
    const Rgb part = weight * surface.material().specular * double(read.weight[k]);
    term_of(read.point[k]).lobe += glm::vec3(part);
    count_read(shared_.field->lobe_sum(read.point[k]), part);
  }
  return true;
}

void PixelShader::gather(const Surface& surface, const Rgb& weight, int depth) {
  const base::Frame3 frame = base::frame_around(surface.brdf.normal);
  const Vec3 origin = surface.lifted();
  const int count = depth > 0 ? tuning::rays_behind_mirror : tuning::rays_without_point;
  const bool shares = depth == 0 && !shared_.incoming.bright().empty();
  GatherRay ray;
  ray.sample = sample_;
  ray.part = depth == 0 ? Part::Indirect : Part::Specular;
  ray.share.cosine_samples = count;
  ray.share.from = {origin, surface.brdf.normal};
  // Cosine-distributed rays: L = (k_d / pi) integral L_in cos = k_d mean(L_in).
  ray.weight = weight / static_cast<double>(count);
  rays_.gather += static_cast<std::uint64_t>(count);
  for (int k = 0; k < count; ++k) {
    std::array<float, 2> u{};
    if (depth == 0) {
      u = gather_points_[half()].point2(in_half() * static_cast<std::uint32_t>(count) +
                                        static_cast<std::uint32_t>(k));
    } else {
      u = {static_cast<float>(rng_.next()), static_cast<float>(rng_.next())};
    }
    const float r = std::sqrt(u[0]), phi = 2.0F * static_cast<float>(pi) * u[1];
    const float cosine = std::sqrt(std::max(0.0F, 1.0F - u[0]));
    ray.direction = frame.to_world({r * std::cos(phi), r * std::sin(phi), cosine});
    if (shares) ray.share.cosine = double(cosine);
    ray.number = ++gathered_;
    // One residual path for all rays: the residual is small and costly.
    ray.residual_weight = k == 0 ? count : 0.0;
    queue_gather(origin, ray);
  }
  if (!shares) return;
  const double choice = rng_.next(), x = rng_.next(), y = rng_.next();
  const IncomingLight::Aimed aimed =
      shared_.incoming.aim({origin, surface.brdf.normal}, choice, x, y, count, 1.0);
  if (aimed.weight <= 0.0) return;
  ++rays_.gather;
  ray.direction = aimed.direction;
  ray.weight = weight * aimed.weight;
  ray.share = aimed.share;
  ray.residual_weight = 1.0;
  ray.number = ++gathered_;
  queue_gather(origin, ray);
}

void PixelShader::take(const Arriving& light, const Rgb& share) {
  rays_.add_shadow(light.kind);
  if (base::max_component(share) <= 0.0) return;
  add(light.layer, light.sample, light.by_camera ? Part::Direct : Part::Specular,
      share * light.radiance);
  if (shared_.splits_parts && light.by_camera) {
    const Rgb specular = share * light.specular;
    sums_[shared_.layers + static_cast<std::size_t>(Part::Direct)] -= specular;
    sums_[shared_.layers + static_cast<std::size_t>(Part::Specular)] += specular;
  }
}

void PixelShader::queue_gather(const Vec3& origin, const GatherRay& ray) {
  shared_.query.set(gather_packet_, gather_count_, origin, ray.direction);
  gather_rays_[gather_count_] = ray;
  if (++gather_count_ == width) flush_gather();
}

// Adds the residual L - L~ at the ray's hit, by a path that continues there.
void PixelShader::add_residual(const GatherRay& ray, const scenes::Hit& hit) {
  base::Rng rng(
      base::Key(shared_.seed, base::Stream::Residual, pixel_).with(ray.sample).with(ray.number));
  walker_->select_sun_stratum(pixel_ + ray.number, ray.sample / 2, ray.sample % 2);
  const auto residual =
      walker_->residual(shared_.incoming, {Vec3(0.0), ray.direction}, hit, ray.share, rng);
  for (std::size_t layer = 0; layer < shared_.layers; ++layer) {
    add(layer, ray.sample, ray.part, ray.residual_weight * ray.weight * residual[layer]);
  }
}

void PixelShader::flush_gather() {
  if (gather_count_ == 0) return;
  scenes::HitPacket hits;
  shared_.query.closest(gather_packet_, gather_count_, hits);
  for (std::size_t k = 0; k < gather_count_; ++k) {
    const GatherRay& ray = gather_rays_[k];
    std::fill(scratch_.begin(), scratch_.end(), Rgb(0.0));
    const scenes::Hit hit{hits.triangle[k], hits.u[k], hits.v[k], hits.t[k], hits.front[k] != 0};
    shared_.incoming.add(hit, ray.direction, ray.share, ray.weight, scratch_, rays_);
    // light straight from the sky is direct
    const Part part = ray.part == Part::Indirect && hit.missed() ? Part::Direct : ray.part;
    for (std::size_t layer = 0; layer < shared_.layers; ++layer) {
      add(layer, ray.sample, part, scratch_[layer]);
    }
    if (walker_ && ray.residual_weight > 0.0 && !hit.missed()) add_residual(ray, hit);
  }
  gather_count_ = 0;
}

}  // namespace earthshine::raytrace
