// SPDX-License-Identifier: Apache-2.0
#include "raytrace/shade/shading.h"

#include <algorithm>
#include <cmath>

#include "raytrace/light/footprint.h"
#include "raytrace/tuning.h"
#include "scenes/reflect/specular.h"
#include "scenes/sky/sky.h"
#include "scenes/sky/sky_cells.h"
#include "scenes/surface_texture.h"

namespace earthshine::raytrace {
namespace {

using base::pi;
using scenes::no_group;

constexpr std::size_t most_shadow_rays = 256;  // traced together

}  // namespace

bool gathers_at(const scenes::Scene& scene, const scenes::Hit& hit, GatherRequest& request) {
  const std::uint32_t number = scene.triangles[hit.triangle].material;
  const scenes::Material& material = scene.materials[number];
  const bool glossy = base::is_lit(material.specular) && material.shininess < tuning::sharp_lobe;
  if (!(hit.front || material.two_sided) || !(base::is_lit(material.diffuse) || glossy))
    return false;
  const Vec3 outward = scenes::triangle_normal(scene, hit.triangle);
  request = {scenes::hit_position(scene, hit), hit.front ? outward : -outward,
             base::luminance(material.diffuse), glossy ? base::luminance(material.specular) : 0.0,
             number};
  return true;
}

PixelShader::PixelShader(const ShadingScene& shared)
    : shared_(shared),
      sums_(shared.layers + (shared.splits_parts ? part_count : 0)),
      scratch_(shared.layers),
      gather_points_{base::SobolOwen4(base::Key(0, base::Stream::FinalGather, 0)),
                     base::SobolOwen4(base::Key(0, base::Stream::FinalGather, 0))},
      rng_(base::Key(0, base::Stream::Roulette, 0)),
      shadows_(shared.query, most_shadow_rays) {
  if (shared.world != nullptr) walker_.emplace(*shared.world);
}

void PixelShader::begin_pixel(const CameraModel& camera, int x, int y, std::size_t first,
                              std::size_t count, bool by_layer) {
  pixel_x_ = x;
  pixel_y_ = y;
  pixel_ = static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(camera.columns) +
           static_cast<std::uint64_t>(x);
  first_sample_ = first;
  source_ = {};
  terms_.clear();
  std::fill(sums_.begin(), sums_.end(), Rgb(0.0));
  sample_luminance_.assign(count, 0.0);
  halves_differ_.assign(by_layer ? shared_.layers : 0, 0.0);
  const base::Key key(shared_.seed, base::Stream::FinalGather, pixel_);
  gather_points_ = {base::SobolOwen4(key.with(0)), base::SobolOwen4(key.with(1))};
}

void PixelShader::add_sample(std::size_t sample, const CameraModel& camera, const Ray& ray,
                             const scenes::Hit& hit) {
  camera_ = &camera;
  sample_ = sample;
  gathered_ = 0;
  source_of_sample_ = 0.0;
  rng_ = base::Rng(base::Key(shared_.lamp_seed, base::Stream::Roulette, pixel_).with(sample));
  ++rays_.camera;
  shade(ray, hit, Rgb(1.0), 0, Seen::ByCamera);
  source_.add(source_of_sample_);
}

void PixelShader::end_pixel() {
  shadows_.trace([this](const Arriving& arriving, const Rgb& share) { take(arriving, share); });
  flush_gather();
}

RayCounts PixelShader::rays() const {
  RayCounts all = rays_;
  if (walker_) all += walker_->rays();
  return all;
}

void PixelShader::add(std::size_t layer, std::size_t sample, Part part, const Rgb& radiance) {
  sums_[layer] += radiance;
  if (shared_.splits_parts) sums_[shared_.layers + static_cast<std::size_t>(part)] += radiance;
  count_luminance(layer, sample, radiance);
}

void PixelShader::trace(const Ray& ray, const Rgb& weight, int depth, Seen seen,
                        std::uint64_t& counter) {
  Rgb kept = weight;
  if (depth >= tuning::roulette_depth) {
    const double survival = std::min(tuning::most_survival, base::max_component(weight));
    if (rng_.next() >= survival) return;
    kept /= survival;
  }
  ++counter;
  shade(ray, shared_.query.closest(ray.origin, ray.direction), kept, depth, seen);
}

void PixelShader::see_source(std::size_t group, const Rgb& radiance, int depth) {
  add(shared_.layer[group], sample_, depth > 0 ? Part::Specular : Part::Direct, radiance);
  if (depth == 0) source_of_sample_ += base::luminance(radiance);
}

void PixelShader::see_sky(const Vec3& direction, const Rgb& weight, int depth, Seen seen) {
  const scenes::Scene& scene = shared_.scene;
  const bool on_earth = scene.earth && glm::dot(direction, scene.earth->direction) >=
                                           std::cos(base::radians(scene.earth->half_angle_deg));
  if (on_earth) {
    // A lobe ray reads the Earth only where shadow rays do not already carry its highlight.
    const bool carried = seen == Seen::ByLobe && !shared_.effects.earth_by_gather;
    if (shared_.groups.earth != no_group && !carried) {
      see_source(shared_.groups.earth + scenes::earth_part(scene, direction),
                 weight * scenes::earth_radiance(scene, direction), depth);
    }
  } else if (seen == Seen::ByCamera && shared_.groups.sun != no_group) {
    see_source(shared_.groups.sun, weight * scenes::sky_radiance(scene, direction), depth);
  }
  if (seen != Seen::ByCamera || !shared_.effects.sun_parts) return;
  const std::size_t part = scenes::sun_part(scene, direction);
  if (part == scene.sky_parts->suns.size()) return;
  see_source(shared_.groups.sun_parts + part,
             weight * scenes::sun_radiance(scene.sky_parts->suns[part]), depth);
}

bool PixelShader::see_lamp(const Ray& ray, double nearer_than_m, const Rgb& weight, int depth) {
  const auto seen = shared_.lights.seen_lamp(ray.origin, ray.direction, nearer_than_m);
  if (!seen) return false;
  see_source(shared_.groups.lamp[seen->lamp], weight * seen->hit.radiance, depth);
  return true;
}

void PixelShader::shade(const Ray& ray, const scenes::Hit& hit, const Rgb& weight, int depth,
                        Seen seen) {
  const double distance = hit.missed() ? std::numeric_limits<double>::infinity() : hit.t;
  if (seen == Seen::ByCamera && see_lamp(ray, distance, weight, depth)) return;
  if (hit.missed()) return see_sky(ray.direction, weight, depth, seen);

  const scenes::Scene& scene = shared_.scene;
  const scenes::Triangle& triangle = scene.triangles[hit.triangle];
  const scenes::Material& material = scene.materials[triangle.material];
  const bool glass = base::is_lit(material.transmit);
  if (!hit.front && !material.two_sided && !glass) return;  // the black back

  const Vec3 outward = scenes::triangle_normal(scene, hit.triangle);
  const Vec3 normal = hit.front ? outward : -outward, view = -ray.direction;
  const double cos_view = glm::dot(view, normal);
  const Surface surface{{material, scenes::diffuse_at(scene, material, hit), normal,
                         2.0 * cos_view * normal - view, cos_view},
                        scenes::hit_position(scene, hit, ray.origin, ray.direction),
                        outward,
                        shared_.query.offset_m(hit.triangle)};
  const bool shines = hit.front || material.two_sided;
  if (depth == 0 && ((shines && material.reflects()) || material.passes_light_on())) {
    source_.reflecting += 1.0;
  }
  const bool shows_emission = seen == Seen::ByCamera || !shared_.sampled_emitter[triangle.material];
  if (shines && shows_emission && shared_.groups.material[triangle.material] != no_group) {
    see_source(shared_.groups.material[triangle.material],
               weight * scenes::emit_at(scene, material, hit) / pi, depth);
  }
  if (shines) {
    if (material.reflects()) direct(ray, surface, weight, depth);
    if (base::is_lit(material.diffuse)) {
      if (seen == Seen::ByCamera && shared_.groups.ambient != no_group) {
        add(shared_.layer[shared_.groups.ambient], sample_,
            depth == 0 ? Part::Indirect : Part::Specular,
            weight * surface.brdf.diffuse * scene.ambient_radiance);
      }
      diffuse(surface, weight, depth);
    }
    if (base::is_lit(material.specular) && shared_.gathers) lobe(surface, weight, depth);
  }
  if (glass || base::is_lit(material.mirror)) mirror_and_glass(ray, surface, weight, depth, seen);
}

void PixelShader::direct(const Ray& ray, const Surface& surface, const Rgb& weight, int depth) {
  const base::Key light_key =
      base::Key(shared_.lamp_seed, base::Stream::LightSample, pixel_).with(half());
  const auto light_point = [&](std::size_t k) {
    return base::SobolOwen4(light_key.with(k)).point2(in_half());
  };
  const auto choice = light_point(shared_.lights.count());
  chosen_.clear();
  // An even lobe may reflect steep light more strongly than its value along the view: this is a
  // bound.
  const double most =
      surface.material().even_lobe ? 1.0 / std::max(surface.brdf.cos_view, 1e-3) : 1.0;
  shared_.lights.choose(
      {surface.position, surface.brdf.normal, surface.brdf.mirrored,
       base::max_component(surface.brdf.diffuse),
       most * base::max_component(surface.material().specular), surface.material().shininess},
      double(choice[0]) + 0x1p-24 * double(choice[1]), chosen_);
  std::optional<Vec3> on_sun;
  const auto take_light = [this](const Arriving& arriving, const Rgb& share) {
    take(arriving, share);
  };
  const auto reflect = [&](std::size_t k, const Vec3& point, double share) {
    if (share <= 0.0 || !shared_.lights.may_reach(k, point, surface.brdf.normal)) return;
    const scenes::LightSample light = shared_.lights.sample(k, point, light_point, on_sun);
    const double cosine = glm::dot(light.direction, surface.brdf.normal);
    if (cosine <= 0.0 || !base::is_lit(light.normal_illuminance_lx)) return;
    // L = (E cos / pi) (k_d + k_s cos^n alpha): the measured Phong form.
    const Rgb highlight = surface.brdf.eval_specular(light.direction, cosine);
    const Rgb incident = weight * light.normal_illuminance_lx * (share * cosine / pi);
    const Rgb value = incident * (surface.brdf.diffuse + highlight);
    const Vec3 start = point + surface.brdf.normal * surface.offset_m;
    if (!base::is_lit(value)) return;
    shadows_.add(light, point, start,
                 {value, incident * highlight, shared_.layer[shared_.lights.group(k)], sample_,
                  depth == 0, shared_.lights.kind(k)},
                 take_light, k);
  };
  std::optional<Footprint> footprint;  // for lamps without size
  for (const auto& [k, chance_weight] : chosen_) {
    Footprint::Places places;
    if (const Vec3* lamp = depth == 0 ? shared_.lights.lamp_point(k) : nullptr) {
      if (!footprint) {
        footprint.emplace(PixelView{*camera_, shared_.filter, pixel_x_, pixel_y_}, ray,
                          surface.position, surface.brdf.normal, surface.offset_m);
      }
      if (footprint->is_near(*lamp)) {
        places = footprint->toward(*lamp, shared_.query, light_point(k), rng_);
      }
    }
    reflect(k, surface.position, chance_weight * places.own_weight);
    reflect(k, places.point, chance_weight * places.weight);
  }
}

void PixelShader::lobe(const Surface& surface, const Rgb& weight, int depth) {
  const double n = surface.material().shininess;
  if (n < tuning::sharp_lobe && has_points(depth) && read_lobe(surface, weight)) return;
  const Vec3 origin = surface.lifted();
  const int count = depth == 0 ? tuning::lobe_rays : 1;
  for (int k = 0; k < count; ++k) {
    // L = integral of L_in f cos, estimated as k_s times the weighted mean of L_in.
    const double u = rng_.next(), v = rng_.next();
    const auto [direction, share] = surface.brdf.sample(scenes::Brdf::Term::Specular, u, v);
    if (share <= 0.0) continue;
    const Rgb value = weight * surface.material().specular * (share / count);
    if (n >= tuning::sharp_lobe) {
      trace({origin, direction}, value, depth + 1, Seen::ByLobe, rays_.lobe);
    } else {
      ++rays_.lobe;
      queue_gather(origin, {direction, value, {}, Part::Specular, sample_, ++gathered_});
    }
  }
}

void PixelShader::mirror_and_glass(const Ray& ray, const Surface& surface, const Rgb& weight,
                                   int depth, Seen seen) {
  const Vec3 lift = surface.brdf.normal * surface.offset_m;
  Rgb reflected = weight * surface.material().mirror, through(0.0);
  Vec3 bent(0.0);
  if (base::is_lit(surface.material().transmit)) {
    through = weight * surface.material().transmit;
    const scenes::Refraction refraction =
        scenes::refract(surface.material(), surface.outward, ray.direction);
    bent = refraction.direction;
    if (refraction.total) {
      reflected += through;
      through = Rgb(0.0);
    }
  }
  if (depth >= tuning::roulette_depth && base::is_lit(reflected) && base::is_lit(through)) {
    // Deep paths follow one of the two branches, or their number would grow exponentially.
    const double share = base::max_component(reflected) /
                         (base::max_component(reflected) + base::max_component(through));
    const bool goes_back = rng_.next() < share;
    reflected *= goes_back ? 1.0 / share : 0.0;
    through *= goes_back ? 0.0 : 1.0 / (1.0 - share);
  }
  if (base::is_lit(through))
    trace({surface.position - lift, bent}, through, depth + 1, seen, rays_.refraction);
  if (base::is_lit(reflected)) {
    if (depth == 0) mirror_ = MirrorPlane{surface.position, surface.brdf.normal};
    trace({surface.position + lift, glm::reflect(ray.direction, surface.brdf.normal)}, reflected,
          depth + 1, seen, rays_.mirror);
    if (depth == 0) mirror_.reset();
  }
}

}  // namespace earthshine::raytrace
