// SPDX-License-Identifier: Apache-2.0
// PathWalker's residual paths.
#include <algorithm>
#include <bit>

#include "raytrace/paths/path_walker.h"
#include "raytrace/tuning.h"

namespace earthshine::raytrace {

std::span<const Rgb> PathWalker::residual(const IncomingLight& solution, const Ray& ray,
                                          const scenes::Hit& first, const MisContext& share,
                                          base::Rng& rng) {
  begin(ray, rng);
  sees_sampled_ = from_camera_ = false;
  restart_segment();
  share_ = share;
  kept_ = solution.residual_weight(first, ray.direction, share);
  follow(solution, first);
  return finished();
}

std::span<const Rgb> PathWalker::residual_at(const IncomingLight& solution, const Vec3& origin,
                                             const Vec3& normal, double u, double v,
                                             base::Rng& rng) {
  begin({}, rng);
  sees_sampled_ = from_camera_ = false;
  restart_segment();
  if (!scatter_diffusely(solution, origin, normal, u, v)) return finished();
  const scenes::Hit hit = world_.query.closest(ray_.origin, ray_.direction);
  if (hit.missed()) return finished();
  kept_ = solution.residual_weight(hit, ray_.direction, share_);
  follow(solution, hit);
  return finished();
}

// Adds S + T L~ - L~ of each surface from a hit on; one ray estimates T, and its hit is the next
// surface. Glass that does not bend light passes on the light of the surfaces behind it, each with
// its own MIS weight.
void PathWalker::follow(const IncomingLight& solution, scenes::Hit hit) {
  for (std::uint32_t bounces = 1; !hit.missed(); ++bounces) {
    const Surface surface = surface_at(hit, scenes::hit_position(world_.scene, hit));
    if (kept_ <= 0.0 && !scenes::is_straight_glass(surface.material())) return;
    solution.add(hit, ray_.direction, share_, -weight_, radiance_, rays_);
    if (is_black(surface)) return;
    const Rgb arriving = weight_;
    weight_ *= kept_;
    if (kept_ > 0.0) shine(surface, hit);
    weight_ = arriving;
    if (!go_on(surface, &solution)) return;
    hit = world_.query.closest(ray_.origin, ray_.direction);
    kept_ = solution.add(hit, ray_.direction, share_, weight_, radiance_, rays_);
    if (goes_straight_on_) continue;
    const double carried = base::max_component(weight_) * (kept_ > 0.0 ? kept_ : 1.0);
    double survival = std::clamp(carried, tuning::least_survival, 1.0);
    if (bounces >= tuning::long_walk && std::has_single_bit(bounces))
      survival *= tuning::long_walk_survival;
    if (rng_->next() >= survival) return;
    weight_ /= survival;
  }
}

// Draws a ray off a diffuse surface, cosine-distributed or aimed at a bright patch; false if its
// weight is 0.
bool PathWalker::scatter_diffusely(const IncomingLight& solution, const Vec3& origin,
                                   const Vec3& normal, double u, double v) {
  sees_sampled_ = from_camera_ = false;
  restart_segment();
  ++rays_.gather;
  const bool aims = !solution.bright().empty();
  if (aims && rng_->next() < tuning::aimed_share) {
    const IncomingLight::Aimed aimed = solution.aim({origin, normal}, rng_->next(), u, v,
                                                    1.0 - tuning::aimed_share, tuning::aimed_share);
    weight_ *= aimed.weight;
    ray_ = {origin, aimed.direction};
    share_ = aimed.share;
    return aimed.weight > 0.0;
  }
  const Vec3 local = scenes::cosine_sample(u, v);
  ray_ = {origin, base::frame_around(normal).to_world(local)};
  share_ = {};
  if (!aims) return true;
  weight_ /= 1.0 - tuning::aimed_share;
  share_.cosine = local.z;
  share_.from = {origin, normal};
  share_.cosine_samples = 1.0 - tuning::aimed_share;
  share_.aimed_rays = tuning::aimed_share;
  return true;
}

}  // namespace earthshine::raytrace
