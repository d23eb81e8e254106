// SPDX-License-Identifier: Apache-2.0
// The sources whose light patches get by shadowed samples: Sun, a narrow Earth, lamps and small
// emitting surfaces.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "radiosity/direct/shadowed_samples.h"
#include "scenes/effects/world.h"
#include "scenes/light/lamp_light.h"
#include "scenes/scene.h"

namespace earthshine::radiosity {

using Emit = std::function<scenes::EmittedRay(double u, double v, double x, double y)>;

struct LightSource {
  std::string name;
  Source source;
  Rgb flux_lm{0.0};                                 // what it emits; not known of the sky's
  Emit emit;                                        // empty for the sky
  scenes::LightKind kind = scenes::LightKind::Sun;  // of a cluster: its first lamp's
};

// Refers to the scene, which must outlive them. points: receiver points per patch for distant
// sources.
[[nodiscard]] std::vector<LightSource> find_sources(const scenes::World& world, int points);

// Many lamps of one light group as one source, whose cost at a patch does not grow with their
// number: those that matter there get shadow rays, and some of the others by chance
// (scenes/light/light_tree.h).

// Fewer lamps of a group are sources of their own, sampled everywhere and each in the ledger.
inline constexpr std::size_t fewest_in_cluster = 33;

// lamps: indices in the scene, which must outlive the source.
[[nodiscard]] LightSource cluster_source(const scenes::Scene& scene,
                                         const std::vector<std::size_t>& lamps, std::uint64_t key,
                                         std::size_t group, int points);

// Which emitting surfaces get shadow rays and which are carried by form factors: never both.

// Per material of the scene. An emitter is sampled explicitly if it is small and bright, so that
// the few form-factor rays that find it bring much of the light:
// - its surfaces are less than a twentieth of all surface area, and
// - its exitance (luminance) is more than twice E = sum A M / sum A (1 - rho), the mean illuminance
//   if all that is emitted stayed among all surfaces until absorbed; rho is all that a material
//   sends on: diffuse, lobe, mirror, glass.
// Else F carries it: in rows that add up to 1, what does not stand out from its surroundings adds
// no noise. In a closed furnace, M = 1 - rho everywhere, E is 1 and nothing stands out: B = 1
// exactly. The only place where this is decided.
[[nodiscard]] std::vector<bool> emitter_is_explicit(const scenes::Scene& scene);

}  // namespace earthshine::radiosity
