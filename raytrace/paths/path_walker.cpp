// SPDX-License-Identifier: Apache-2.0
#include "raytrace/paths/path_walker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "raytrace/tuning.h"
#include "scenes/reflect/specular.h"
#include "scenes/sky/sky.h"
#include "scenes/sky/sky_cells.h"
#include "scenes/surface_texture.h"

namespace earthshine::raytrace {
namespace {

using base::pi;
using scenes::no_group;

}  // namespace

void PathWalker::begin(const Ray& start, base::Rng& rng) {
  std::fill(radiance_.begin(), radiance_.end(), Rgb(0.0));
  rng_ = &rng;
  ray_ = start;
  weight_ = Rgb(1.0);
  share_ = {};
  kept_ = 1.0;
  at_first_ = met_surface_ = false;
  source_luminance_ = 0.0;
}

std::span<const Rgb> PathWalker::finished() {
  world_.lights.sun_strata().weigh(sun_stratum_, radiance_);
  return radiance_;
}

std::span<const Rgb> PathWalker::walk(const Ray& start, base::Rng& rng) {
  begin(start, rng);
  sees_sampled_ = from_camera_ = at_first_ = true;
  restart_segment();
  ++rays_.camera;
  for (int bounce = 0; step() && survives(bounce); ++bounce) {
  }
  return finished();
}

PathWalker::Surface PathWalker::surface_at(const scenes::Hit& hit, const Vec3& position) const {
  const scenes::Scene& scene = world_.scene;
  const scenes::Material& material = scene.materials[scene.triangles[hit.triangle].material];
  const Vec3 outward = scenes::triangle_normal(scene, hit.triangle);
  const Vec3 normal = hit.front ? outward : -outward;
  const Vec3 mirrored = glm::reflect(ray_.direction, outward);
  return {{material, scenes::diffuse_at(scene, material, hit), normal, mirrored,
           glm::dot(mirrored, normal)},
          position,
          outward,
          hit.front || material.two_sided,
          hit.triangle,
          world_.query.offset_m(hit.triangle)};
}

bool PathWalker::is_black(const Surface& surface) {
  return !surface.shines && !base::is_lit(surface.material().transmit);
}

// Adds the emission and direct light of the ray's hit and draws the next ray; false at the end of
// the path.
bool PathWalker::step() {
  const scenes::Hit hit = world_.query.closest(ray_.origin, ray_.direction);
  if (sees_sampled_ && see_lamp(hit)) return false;
  if (hit.missed()) {
    see_sky();
    return false;
  }
  const Surface surface =
      surface_at(hit, scenes::hit_position(world_.scene, hit, ray_.origin, ray_.direction));
  if (is_black(surface)) return false;
  if (at_first_) met_surface_ = surface.reflects() || surface.material().passes_light_on();
  shine(surface, hit);
  at_first_ = false;
  return go_on(surface, nullptr);
}

// Adds the surface's emission and its reflection of direct light.
void PathWalker::shine(const Surface& surface, const scenes::Hit& hit) {
  if (!surface.shines) return;
  const scenes::Material& material = surface.material();
  const std::uint32_t number = world_.scene.triangles[hit.triangle].material;
  if (sees_sampled_ || !world_.sampled_emitter[number]) {
    see(world_.groups.material[number], scenes::emit_at(world_.scene, material, hit) / pi);
  }
  if (from_camera_)
    add(world_.groups.ambient, surface.brdf.diffuse * world_.scene.ambient_radiance);
  if (surface.reflects()) light_directly(surface);
}

void PathWalker::add(std::size_t group, const Rgb& radiance) {
  if (group != no_group) radiance_[world_.layer[group]] += weight_ * radiance;
}

// Adds light straight from a source.
void PathWalker::see(std::size_t group, const Rgb& radiance) {
  add(group, radiance);
  if (at_first_ && group != no_group) source_luminance_ += base::luminance(weight_ * radiance);
}

void PathWalker::see_sky() {
  const scenes::Scene& scene = world_.scene;
  if (earth_ && earth_->covers(ray_.direction)) {
    const bool met = sees_sampled_ || world_.effects.earth_by_gather;
    if (met && world_.groups.earth != no_group) {
      see(world_.groups.earth + scenes::earth_part(scene, ray_.direction),
          (*earth_)(ray_.direction));
    }
  } else if (sees_sampled_) {
    see(world_.groups.sun, scenes::sky_radiance(scene, ray_.direction));
  }
  if (!sees_sampled_ || !world_.effects.sun_parts) return;
  const std::size_t part = scenes::sun_part(scene, ray_.direction);
  if (part == scene.sky_parts->suns.size()) return;
  see(world_.groups.sun_parts + part, scenes::sun_radiance(scene.sky_parts->suns[part]));
}

bool PathWalker::see_lamp(const scenes::Hit& hit) {
  const double nearest_m = hit.missed() ? std::numeric_limits<double>::infinity() : hit.t;
  const auto seen = world_.lights.seen_lamp(ray_.origin, ray_.direction, nearest_m);
  if (seen) see(world_.groups.lamp[seen->lamp], seen->hit.radiance);
  return seen.has_value();
}

// One shadow ray to every source with shadow rays: L = (E cos / pi) (k_d + k_s cos^n alpha).
void PathWalker::light_directly(const Surface& surface) {
  const auto take = [&](const Arriving& light, const Rgb& share) {
    rays_.add_shadow(light.kind);
    add(light.group, share * light.radiance);
  };
  // Each light has its own random numbers, so that switching a lamp off leaves the others
  // unchanged.
  const base::Key key(static_cast<std::uint64_t>(rng_->next() * 0x1p53), base::Stream::LightSample,
                      0);
  const auto uniform = [&](std::size_t k) -> glm::dvec2 {
    return {base::uniform(key.with(k), 0), base::uniform(key.with(k), 1)};
  };
  std::optional<Vec3> on_sun;
  const Vec3 origin = surface.lifted();
  world_.lights.each_that_may_reach(
      surface.position, surface.brdf.normal, sun_stratum_, [&](std::size_t k) {
        const scenes::LightSample light =
            world_.lights.sample(k, surface.position, uniform, on_sun);
        const double cosine = glm::dot(light.direction, surface.brdf.normal);
        if (cosine <= 0.0 || !base::is_lit(light.normal_illuminance_lx)) return;
        const Rgb reflectance = surface.brdf.eval(light.direction, cosine);
        shadows_.add(light, surface.position, origin,
                     {reflectance * light.normal_illuminance_lx * (cosine / pi),
                      world_.lights.group(k), world_.lights.kind(k)},
                     take);
      });
  shadows_.trace(take);
}

// Draws a mechanism in proportion to its reflectance, and the next ray. Aims some rays at bright
// patches of `solution`.
bool PathWalker::go_on(const Surface& surface, const IncomingLight* solution) {
  using Term = scenes::Brdf::Term;
  const scenes::Material& material = surface.material();
  enum : std::size_t { Diffuse, Lobe, Mirror, Glass };
  const bool straight = scenes::is_straight_glass(material);
  const std::array<double, 4> share = {
      surface.shines ? kept_ * base::max_component(surface.brdf.albedo(Term::Diffuse)) : 0.0,
      surface.shines ? kept_ * base::max_component(surface.brdf.albedo(Term::Specular)) : 0.0,
      kept_ * base::max_component(material.mirror),
      (straight ? 1.0 : kept_) * base::max_component(material.transmit)};
  const double all = share[Diffuse] + share[Lobe] + share[Mirror] + share[Glass];
  if (all <= 0.0) return false;
  double choice = rng_->next() * all;
  std::size_t component = Diffuse;
  while (component < Glass && (choice -= share[component]) >= 0.0) ++component;
  while (share[component] <= 0.0)
    --component;  // rounding moved the choice past the last nonzero share
  weight_ *= all / share[component];
  goes_straight_on_ = component == Glass && straight;
  if (!goes_straight_on_) {
    weight_ *= kept_;
    share_ = {};
  }

  if (component == Diffuse && solution != nullptr) {
    weight_ *= surface.brdf.diffuse;
    const double u = rng_->next(), v = rng_->next();
    if (!scatter_diffusely(*solution, surface.lifted(), surface.brdf.normal, u, v)) return false;
  } else if (component == Mirror || component == Glass) {
    pass_on(surface, component == Glass);
  } else {
    scatter(surface, component == Lobe ? Term::Specular : Term::Diffuse);
  }
  return base::is_lit(weight_);
}

// Whether shadow rays of the surface where the path last left by restart_segment() carry light along this
// segment: through straight glass and by at most one flat mirror.
bool PathWalker::shadow_rays_follow(const Surface& surface, bool through) {
  if (through) return scenes::is_straight_glass(surface.material());
  const scenes::SpecularPaths::Face* face = world_.query.specular_paths().face(surface.triangle);
  const bool front = glm::dot(surface.brdf.normal, surface.outward) > 0.0;
  return face != nullptr && face->mirror[front ? 0 : 1] != scenes::no_mirror && ++mirrors_ == 1;
}

void PathWalker::pass_on(const Surface& surface, bool through) {
  weight_ *= through ? surface.material().transmit : surface.material().mirror;
  Vec3 lift = surface.brdf.normal * surface.offset_m;
  Vec3 direction = surface.brdf.mirrored;
  if (through) {
    const scenes::Refraction refraction =
        scenes::refract(surface.material(), surface.outward, ray_.direction);
    direction = refraction.direction;
    if (!refraction.total) lift = -lift;
  }
  ray_ = {surface.position + lift, direction};
  if (goes_straight_on_ && share_.aimed_at != radiosity::no_patch) {
    ray_.origin = scenes::straight_through(world_.scene, surface.triangle, surface.position,
                                           direction, surface.offset_m)
                      .value_or(ray_.origin);
  }
  straight_ = straight_ && shadow_rays_follow(surface, through);
  if (world_.paths == PathSet::All && !straight_) sees_sampled_ = true;
  ++(through ? rays_.refraction : rays_.mirror);
}

void PathWalker::scatter(const Surface& surface, scenes::Brdf::Term term) {
  const bool by_lobe = term == scenes::Brdf::Term::Specular;
  const double u = rng_->next(), v = rng_->next();
  const scenes::Brdf::Sample sample = surface.brdf.sample(term, u, v);
  weight_ *= (by_lobe ? surface.material().specular : surface.brdf.diffuse) * sample.weight;
  ray_ = {surface.lifted(), sample.direction};
  sees_sampled_ = from_camera_ = false;
  restart_segment();
  ++(by_lobe ? rays_.lobe : rays_.gather);
}

bool PathWalker::survives(int bounce) {
  double survival = std::min(1.0, base::max_component(weight_) / tuning::sure_weight);
  if (bounce >= tuning::long_path) survival = std::min(survival, tuning::long_path_survival);
  if (survival < 1.0 && rng_->next() >= survival) return false;
  weight_ /= survival;
  return true;
}

}  // namespace earthshine::raytrace
