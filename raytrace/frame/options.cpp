// SPDX-License-Identifier: Apache-2.0
#include "raytrace/frame/options.h"

namespace earthshine::raytrace {

Window window_of(const RenderOptions& options) {
  const Window& crop = options.crop;
  if (crop.columns == 0) return {0, 0, options.columns, options.rows};
  const bool inside = crop.x >= 0 && crop.y >= 0 && crop.columns > 0 && crop.rows > 0 &&
                      crop.columns <= options.columns - crop.x &&
                      crop.rows <= options.rows - crop.y;
  if (inside) return crop;
  throw base::Error(base::Blame::Input, "--crop",
                    "the window of " + std::to_string(crop.columns) + " x " +
                        std::to_string(crop.rows) + " pixels at " + std::to_string(crop.x) + ", " +
                        std::to_string(crop.y) + " leaves the picture",
                    "a window within " + std::to_string(options.columns) + " x " +
                        std::to_string(options.rows) + " pixels");
}

RenderOptions render_options(const scenes::QualityKnobs& knobs) {
  RenderOptions options;
  options.gather_rays = knobs.gather_rays;
  options.camera_samples = knobs.camera_samples;
  options.denoise = knobs.denoise;
  return options;
}

}  // namespace earthshine::raytrace
