// SPDX-License-Identifier: Apache-2.0
// How a wanted error is shared out between the stages so that the picture is there soonest. Pure
// arithmetic on what a first solve and a small picture have shown.
#pragma once

#include <functional>

namespace earthshine::studies {

// A solve that was done, with what it leaves in the picture, relative.
struct SolveState {
  double refine_error = 0.0;  // estimated by the refinement (RefineOptions::error)
  double patches = 0.0;
  int rays = 0;              // form-factor rays per patch
  double patch_error = 0.0;  // due to the patches' size
  double ray_error = 0.0;    // noise of the form factors
  double other_error = 0.0;  // what neither patches nor rays change
};

// What may be changed, and how the cost goes. A ray is a ray in all stages: counting them, and not
// seconds, keeps the choice the same on every machine and under every load.
struct ChoiceRules {
  double wanted = 0.0;            // relative error of the whole
  bool may_cut = true;            // choose patches
  bool may_cast = true;           // choose form-factor rays
  double rays_per_patch_cut = 0;  // that refinement takes per patch
  double picture_rays = 0.0;  // of all pictures, at a noise of `picture_noise`; 0: there is none
  double picture_noise = 0.0;
  // Whether so many patches with so many rays each fit into memory; empty: they do.
  std::function<bool(double patches, int rays)> fits;
};

struct SettingsChoice {
  bool reached = false;  // with these settings the wanted error is expected
  bool keeps = true;     // the solve as it is
  double refine_error = 0.0;
  double patches = 0.0;  // expected
  int rays = 0;
  double picture_noise = 0.0;  // that is left for the pictures
  double cost = 0.0;           // rays still to cast
};

// The cheapest of the settings that reach the wanted error, the solve as it is unless another saves
// a third; where none does, the one that comes nearest. Errors add in squares; the patches' goes
// with refine_error^2, their number with refine_error^-2; the rays' with (patches *
// rays)^-1/2; a picture's rays with noise^-2. One step asks for at most four times the patches and
// four times the rays: the laws hold near by.
[[nodiscard]] SettingsChoice choose_settings(const SolveState& state, const ChoiceRules& rules);

// The two ends of a picture's noise. Settings are the errors that the laws of scenes/quality.h are
// asked for.
struct NoiseSetting {
  double gather = 0.0;   // rays over the hemisphere
  double samples = 0.0;  // camera samples, with shadow and lobe rays
};
struct NoiseFound {
  double gather = 0.0, samples = 0.0;           // relative, measured
  double gather_rays = 0.0, sample_rays = 0.0;  // cast
};
// The settings that bring the noise to `wanted` with the fewest rays, when noise goes with the
// setting and rays with the inverse of its square: of the squared noise each end gets a share as
// the root of (rays * squared noise). Each changes by a factor of 8 at most.
[[nodiscard]] NoiseSetting next_setting(const NoiseSetting& setting, const NoiseFound& found,
                                        double wanted);

}  // namespace earthshine::studies
