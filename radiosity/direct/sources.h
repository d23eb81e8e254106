// SPDX-License-Identifier: Apache-2.0
// The sources that patches sample directly: Sun, a narrow Earth, lamps and small emitting surfaces.
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
  Rgb flux_lm{0.0};                                 // emitted; unknown for the sky
  Emit emit;                                        // empty for the sky
  scenes::LightKind kind = scenes::LightKind::Sun;  // for a cluster: of its first lamp
};

// Refers to the scene, which must outlive them. points: receiver points per patch for distant
// sources.
[[nodiscard]] std::vector<LightSource> find_sources(const scenes::World& world, int points);

// Combines many lamps of one light group to one source, whose cost per patch does not grow with
// their number: important lamps get shadow rays, the others are selected randomly
// (scenes/light/light_tree.h).

// Fewer lamps of a group are separate sources, sampled everywhere, with separate ledger entries.
inline constexpr std::size_t fewest_in_cluster = 33;

// lamps: indices in the scene, which must outlive the source.
[[nodiscard]] LightSource cluster_source(const scenes::Scene& scene,
                                         const std::vector<std::size_t>& lamps, std::uint64_t key,
                                         std::size_t group, int points);

// Decides which emitting surfaces get shadow rays and which use form factors: never both.

// Per material of the scene. An emitter is sampled explicitly if it is small and bright, so that
// few form-factor rays would carry much of its light:
// - its surfaces are less than a twentieth of all surface area, and
// - its exitance (luminance) exceeds twice E = sum A M / sum A (1 - rho), the mean illuminance if
//   all emitted light stayed in the scene until absorbed; rho is all that a material sends on:
//   diffuse, lobe, mirror, glass.
// Otherwise form factors carry it: in rows with the sum 1, an emitter as bright as its surroundings
// adds no noise. In a closed furnace, M = 1 - rho everywhere, E is 1 and no emitter is bright: B =
// 1 exactly. No other code decides this.
[[nodiscard]] std::vector<bool> emitter_is_explicit(const scenes::Scene& scene);

}  // namespace earthshine::radiosity
