// SPDX-License-Identifier: Apache-2.0
// What patches reflect and emit on average over their area, where materials have textures.
#pragma once

#include <vector>

#include "radiosity/patches/patches.h"

namespace earthshine::radiosity {

// The mean of k_d over what is there of the patch; without a texture the material's.
[[nodiscard]] Rgb patch_diffuse(const scenes::Scene& scene, const Patches& patches,
                                std::uint32_t patch);
// Of the exitance.
[[nodiscard]] Rgb patch_emit(const scenes::Scene& scene, const Patches& patches,
                             std::uint32_t patch);

// rho of patches: k_d and the mean of the lobe (scenes::bihemispherical_albedos). The scene must
// outlive it.
class PatchAlbedos {
 public:
  explicit PatchAlbedos(const scenes::Scene& scene);
  [[nodiscard]] Rgb of(const Patches& patches, std::uint32_t patch) const;

 private:
  const scenes::Scene& scene_;
  std::vector<Rgb> by_material_;
};

}  // namespace earthshine::radiosity
