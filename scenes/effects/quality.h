// SPDX-License-Identifier: Apache-2.0
// The accuracy settings with all defaults.
#pragma once

#include "scenes/scene.h"

namespace earthshine::scenes {

// Paths per pixel divided by gather rays per pixel, for equal noise.
inline constexpr int paths_per_gather_ray = 8;

// Relative error for scenes that set none.
inline constexpr double default_error = 0.02;

struct QualityKnobs {
  double patch_edge_m = 0.25;  // for uniform patches
  bool refine = false;         // adaptive patches, starting from cells of at most start_edge_m
  double start_edge_m = 0.25;
  int max_patches = 0;             // 0: the number of uniform patches of edge patch_edge_m
  double refine_error = 0.0;       // relative RMS error at which refinement ends
  int form_factor_rays = 1024;     // per patch, a power of two
  int gather_rays = 32;            // per pixel
  int camera_samples = 64;         // per pixel
  bool denoise = true;             // of gather points
  double solver_tolerance = 1e-8;  // relative residual
};

// A setting of the scene has priority. Otherwise the wanted relative error e determines it by
// measured laws:
//   gather noise   ~ gather_rays^-1/2        32 rays for 0.02
//   edges          ~ camera_samples^-3/4     64 samples for 0.02
//   radiosity      ~ form_factor_rays^-0.6   1024 rays for 0.02
//   patch size     ~ patch_edge              (scene diagonal) / 48 for 0.02
// Ray counts are rounded up to powers of two. Without a wanted error, e = 0.02.
//
// Patches are refined unless the scene sets patch_edge alone or refine = false. Refinement ends at
// an estimated radiosity error of 1.5 e (a picture averages over many patches), or at the number of
// patches of a uniform division. With max_patches but no error, it uses all of them. If patch_edge
// is set too, no patch is longer.
[[nodiscard]] QualityKnobs resolve_quality(const Scene& scene);
// By the law above.
[[nodiscard]] int camera_samples_for(double error);
// With other settings than the scene's.
[[nodiscard]] QualityKnobs resolve_quality(const Scene& scene, const Quality& given);

}  // namespace earthshine::scenes
