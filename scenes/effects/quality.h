// SPDX-License-Identifier: Apache-2.0
// The accuracy knobs, every default visible.
#pragma once

#include "scenes/scene.h"

namespace earthshine::scenes {

// Paths per pixel over gather rays per pixel, for about the same noise.
inline constexpr int paths_per_gather_ray = 8;

// Relative; of a scene that names none.
inline constexpr double default_error = 0.02;

struct QualityKnobs {
  double patch_edge_m = 0.25;  // of patches that are all alike
  bool refine = false;         // adaptive patches instead, from cells of start_edge_m at most
  double start_edge_m = 0.25;
  int max_patches = 0;             // 0: as many as an even cut at patch_edge_m would have
  double refine_error = 0.0;       // root mean square, relative, at which refinement ends
  int form_factor_rays = 1024;     // per patch, a power of two
  int gather_rays = 32;            // per pixel
  int camera_samples = 64;         // per pixel
  bool denoise = true;             // gather points with their neighbours
  double solver_tolerance = 1e-8;  // relative residual
};

// A knob that the scene sets wins. Otherwise a wanted relative error e sets it by the measured laws
//   gather noise   ~ gather_rays^-1/2        32 rays for 0.02
//   edges          ~ camera_samples^-3/4     64 samples for 0.02
//   radiosity      ~ form_factor_rays^-0.6   1024 rays for 0.02
//   patch size     ~ patch_edge              (scene diagonal) / 48 for 0.02
// rounded up to powers of two for rays; without a wanted error, e = 0.02.
//
// Patches are refined unless the scene sets patch_edge alone or refine = false. What is then left
// unset follows from e as well: an estimated error of the radiosity of 1.5 e ends the refinement (a
// picture averages over many patches), and so does the number of patches that an even cut would
// have; max_patches without error is spent to the last patch. Where patch_edge is set too, no patch
// is longer.
[[nodiscard]] QualityKnobs resolve_quality(const Scene& scene);
// By the law above: for a wanted error.
[[nodiscard]] int camera_samples_for(double error);
// The same with other wishes than the scene's.
[[nodiscard]] QualityKnobs resolve_quality(const Scene& scene, const Quality& given);

}  // namespace earthshine::scenes
