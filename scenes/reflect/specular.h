// SPDX-License-Identifier: Apache-2.0
// Continuation of light at mirrors and glass.
#pragma once

#include "scenes/ray_query.h"
#include "scenes/scene.h"
#include "scenes/specular_paths.h"

namespace earthshine::scenes {

// Whether any material is a mirror or glass.
[[nodiscard]] bool any_passes_light_on(const Scene& scene);

// Continuation of a ray along the unit vector `direction` at a surface with unit normal `normal`
// (the front's): reflected, or refracted by Snell's law, whichever share of the material is larger;
// total reflection if Snell's law has no solution. Sheets of glass are thin and do not refract.
// Deterministic: a random choice would make integer hit counts noisy, and materials of half mirror,
// half clear glass do not occur.
[[nodiscard]] Vec3 specular_direction(const Material& material, const Vec3& normal,
                                      const Vec3& direction);

// Refracted direction; on total reflection the reflected one (total is then true).
struct Refraction {
  Vec3 direction;
  bool total = false;
};
[[nodiscard]] Refraction refract(const Material& material, const Vec3& normal,
                                 const Vec3& direction);

// Continuation of a ray along specular_direction() from a hit on a mirror or glass. Its origin is
// offset_m off the surface on the side of its direction. It is moved a hundred-thousandth of the
// distance to the triangle's middle, off the edges, where rounding could put it behind a neighbour
// and let light leak from a closed room. aimed: a ray that continues straight starts at
// straight_through().
struct SpecularStep {
  Vec3 origin, direction;
};
[[nodiscard]] SpecularStep specular_step(const Scene& scene, const Hit& hit, const Vec3& direction,
                                         double offset_m, bool aimed = false);

// Limit of mirrors and panes along one ray.
inline constexpr int most_specular_steps = 64;

// Follows a ray from a hit along specular_step(). Calls visit(hit, direction, step) for this hit
// with step 0 and for the hit, or miss, after each step, until it returns false. straight_only:
// ends where the ray would change its direction.
template <class Visit>
void follow_specular(const Scene& scene, const RayQuery& query, Hit hit, Vec3 direction,
                     bool straight_only, const Visit& visit) {
  for (int step = 0; visit(hit, direction, step); ++step) {
    const SpecularStep on =
        specular_step(scene, hit, direction, query.offset_m(hit.triangle), straight_only);
    if (straight_only && !goes_straight_on(direction, on.direction)) return;
    direction = on.direction;
    hit = query.closest(on.origin, direction);
  }
}

}  // namespace earthshine::scenes
