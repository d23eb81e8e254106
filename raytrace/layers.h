// SPDX-License-Identifier: Apache-2.0
// The layers a picture may have beside its light: their names, and what the unfiltered ones hold.
#pragma once

#include <string>
#include <vector>

#include "base/image.h"
#include "raytrace/camera.h"
#include "scenes/ray_query.h"

namespace earthshine::raytrace {

// Where a layer's values come from.
//   FirstHit  the one ray through the pixel's centre and the lens's: never filtered
//   Coverage  all camera samples of the pixel (cryptomatte.h)
//   Samples   statistics of the pixel's samples, kept by the renderer
enum class LayerKind { FirstHit, Coverage, Samples };

struct Layer {
  std::string aov;  // its word in --aov
  LayerKind kind;
  std::vector<std::string> channels;
};

// All there are, in the order of the documentation:
//   albedo      albedo.R/G/B     diffuse reflectance; 0 where the ray meets nothing
//   normal      N.X/Y/Z          unit, facing the camera; 0
//   position    P.X/Y/Z          m; 0
//   depth       Z                m along the camera's axis; infinite
//   range       range            m along the ray; infinite
//   object      object           number in the scene's order; -1
//   material    material         number in the scene's order; -1
//   crypto_...  Crypto...        coverage by object or material
//   variance    variance         of the pixel's mean luminance, (cd/m^2)^2
[[nodiscard]] const std::vector<Layer>& layers();

// Their words in --aov.
[[nodiscard]] const std::vector<std::string>& aov_names();

// Channels of the named layers, each once. Throws base::Error (Input) for an unknown name.
[[nodiscard]] std::vector<std::string> layer_channels(const std::vector<std::string>& aovs);

// Fills those channels of `image` that belong to layers of kind FirstHit, with one ray per pixel.
void fill_first_hit(const scenes::Scene& scene, const scenes::RayQuery& query,
                    const CameraModel& camera, base::Image& image);

}  // namespace earthshine::raytrace
