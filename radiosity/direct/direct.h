// SPDX-License-Identifier: Apache-2.0
// Direct illuminance E0 of every patch from every source that is not carried by form factors: Sun,
// Earth, lamps and small emitting surfaces, by shadowed sampling, one column per (light group,
// channel).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "radiosity/factors/form_factors.h"
#include "radiosity/patches/patches.h"
#include "scenes/effects/world.h"

namespace earthshine::radiosity {

// What a source of known flux emits against where it was found to go. The explicit first bounce is
// scaled by `scale` so that landed + on black backs + escaped = emitted.
struct SourceFlux {
  std::string name;
  std::size_t group = 0;
  Rgb emitted_lm{0.0};
  double escaped_share = 0.0;    // by rays shot from the source
  double back_share = 0.0;       // absorbed by black back faces
  double share_std_error = 0.0;  // of escaped + black, binomial
  double scale = 1.0;            // applied to the patches' sampled illuminance
  Rgb landed_lm{0.0};            // on patches, scaled; never more luminance than emitted

  // What the rays shot from the source found to land, lm, and the standard error by luminance.
  [[nodiscard]] Rgb expected_lm() const { return emitted_lm * (1.0 - escaped_share - back_share); }
  [[nodiscard]] double expected_error_lm() const {
    return base::luminance(emitted_lm) * share_std_error;
  }
  // Whether landed_lm is what those rays leave, but for their noise: six standard errors.
  [[nodiscard]] bool is_accounted_for() const;

  // What did not land, by where the rays shot from the source went. In luminance never negative; of
  // many lamps of different colours in one cluster, a channel may be, by the noise of their choice.
  // Flux that is not accounted for is in none of the two.
  [[nodiscard]] Rgb escaped_lm() const;
  [[nodiscard]] Rgb lost_lm() const;  // on black backs
};

// What finding the light of one kind of source took.
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
  int flux_rays = 1 << 16;    // shot from each lamp to find what escapes
  std::uint64_t seed = 0;
};

// Per patch the mean over factors.open, what no body covers. factors.sky_illuminance is taken for
// the Earth where it is wide (Effects::earth_by_gather). Of ranks that divide the factors each has
// the light of its own rows, and the first alone what is said of sources.
[[nodiscard]] DirectLight direct_light(const scenes::World& world, const Patches& patches,
                                       const FormFactors& factors, const DirectOptions& options);

}  // namespace earthshine::radiosity
