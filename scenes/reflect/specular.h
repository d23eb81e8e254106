// SPDX-License-Identifier: Apache-2.0
// Where light goes on from a mirror or glass.
#pragma once

#include "scenes/ray_query.h"
#include "scenes/scene.h"
#include "scenes/specular_paths.h"

namespace earthshine::scenes {

// Whether any material is a mirror or glass.
[[nodiscard]] bool any_passes_light_on(const Scene& scene);

// The way of a ray that arrives along the unit vector `direction` at a surface of unit normal
// `normal` (the front's): reflected, or refracted by Snell's law, whichever share of the material
// is larger; total reflection where Snell's law has no solution. Sheets of glass are thin and do
// not bend light. One way only: following both by chance would make integer hit counts noisy, and
// materials that are half mirror, half clear glass do not occur.
[[nodiscard]] Vec3 specular_direction(const Material& material, const Vec3& normal,
                                      const Vec3& direction);

// Refracted direction, or the reflected one on total reflection (total is then true).
struct Refraction {
  Vec3 direction;
  bool total = false;
};
[[nodiscard]] Refraction refract(const Material& material, const Vec3& normal,
                                 const Vec3& direction);

// The ray that goes on along specular_direction() from a hit on a mirror or glass: its origin lies
// offset_m off the surface on the side it goes to, and is drawn a hundred-thousandth of the way to
// the triangle's middle, off its edges, where rounding could put it behind a neighbour and let
// light leak from a closed room. aimed: where it goes straight on, it is straight_through().
struct SpecularStep {
  Vec3 origin, direction;
};
[[nodiscard]] SpecularStep specular_step(const Scene& scene, const Hit& hit, const Vec3& direction,
                                         double offset_m, bool aimed = false);

// Mirrors and panes that a ray is followed through at most.
inline constexpr int most_specular_steps = 64;

// Follows a ray from a hit along specular_step(): visit(hit, direction, step) for that hit, with
// step 0, and for what is met after each step (a miss, too), until it returns false. straight_only:
// ends where the ray would turn.
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
