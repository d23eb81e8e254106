// SPDX-License-Identifier: Apache-2.0
// The accuracy knobs, every default visible.
#pragma once

#include "scenes/scene.h"

namespace earthshine::scenes {

struct QualityKnobs {
  double patch_edge_m = 0.25;
  int form_factor_rays = 1024;     // per patch, a power of two
  int gather_rays = 256;           // per pixel
  double solver_tolerance = 1e-8;  // relative residual
};

// A knob that the scene sets wins. Otherwise a wanted relative error e sets it by the measured laws
//   gather noise   ~ gather_rays^-1/2     256 rays for 0.02
//   radiosity      ~ form_factor_rays^-0.6  1024 rays for 0.02
//   patch size     ~ patch_edge           (scene diagonal)/48 for 0.02
// rounded up to powers of two for rays; without a wanted error, e = 0.02.
[[nodiscard]] QualityKnobs resolve_quality(const Scene& scene);

}  // namespace earthshine::scenes
