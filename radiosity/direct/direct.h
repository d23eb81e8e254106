// SPDX-License-Identifier: Apache-2.0
// Direct illuminance E0 of every patch from the sources without form factors: Sun, Earth, lamps and
// small emitting surfaces. Shadowed samples, one column per (light group, channel).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "radiosity/direct/shadowed_samples.h"
#include "radiosity/factors/form_factors.h"
#include "radiosity/patches/patches.h"
#include "scenes/effects/world.h"

namespace earthshine::radiosity {

// Flux balance of a source of known flux. The direct illuminance is multiplied by `scale`, so that
// landed + on black backs + escaped = emitted.
struct SourceFlux {
  std::string name;
  std::size_t group = 0;
  Rgb emitted_lm{0.0};
  double escaped_share = 0.0;    // by rays shot from the source
  double back_share = 0.0;       // absorbed by black back faces
  double share_std_error = 0.0;  // of escaped + black, binomial
  double scale = 1.0;            // applied to the patches' sampled illuminance
  Rgb landed_lm{0.0};            // on patches, scaled; its luminance is at most the emitted one

  // Landed flux by the rays from the source, lm, and its standard error in luminance.
  [[nodiscard]] Rgb expected_lm() const { return emitted_lm * (1.0 - escaped_share - back_share); }
  [[nodiscard]] double expected_error_lm() const {
    return base::luminance(emitted_lm) * share_std_error;
  }
  // Whether landed_lm agrees with those rays to within six standard errors.
  [[nodiscard]] bool is_accounted_for() const;

  // Flux that did not land, divided by the results of the rays from the source. The luminance is
  // never negative; in a cluster of lamps of different colours one channel may be, by the noise of
  // their selection. Flux that is not accounted for is in neither of the two.
  [[nodiscard]] Rgb escaped_lm() const;
  [[nodiscard]] Rgb lost_lm() const;  // on black backs
};

// Cost of the light of one kind of source.
struct SourceCost {
  std::uint64_t rays = 0;
  double seconds = 0.0;  // wall
};

struct DirectLight {
  std::size_t columns = 0;             // 3 * groups
  std::vector<double> illuminance_lx;  // of own rows: row * columns + 3 * group + channel
  std::vector<SourceFlux> sources;
  std::uint64_t shadow_rays = 0;
  std::array<SourceCost, scenes::light_kinds> cost{};  // by LightKind
};

struct DirectOptions {
  int points_per_patch = 16;  // receiver points for distant sources; 16 times more near a source
  int flux_rays = 1 << 16;    // from each lamp, to estimate the escaped flux
  std::uint64_t seed = 0;
  KeptSamples* kept = nullptr;  // of an earlier pose, replaced by this one's; not with ranks
};

// Per patch the mean over its open part (factors.open). The Earth uses factors.sky_illuminance if
// it is wide (Effects::earth_by_gather). Ranks that divide the factors each return the light of
// their own rows; only the first returns the data of the sources.
[[nodiscard]] DirectLight direct_light(const scenes::World& world, const Patches& patches,
                                       const FormFactors& factors, const DirectOptions& options);

}  // namespace earthshine::radiosity
