// SPDX-License-Identifier: Apache-2.0
#include "raytrace/frame/options.h"

namespace earthshine::raytrace {

RenderOptions render_options(const scenes::QualityKnobs& knobs) {
  RenderOptions options;
  options.gather_rays = knobs.gather_rays;
  options.shared.on = knobs.share_gather;
  options.shared.smooth_share = knobs.smooth_share;
  options.shared.noise = knobs.picture_noise;
  return options;
}

}  // namespace earthshine::raytrace
