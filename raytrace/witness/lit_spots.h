// SPDX-License-Identifier: Apache-2.0
// Light that small lit spots reflect to other surfaces. Paths may miss such spots and then state no
// error.
#pragma once

#include <vector>

#include "raytrace/witness/images.h"

namespace earthshine::raytrace {

// Light on a diffuse surface through a narrow opening.
struct LitSpot {
  Vec3 position{0.0}, normal{0.0};
  double intensity_cd = 0.0;  // along the normal: luminance times area
};

// Luminance that one diffuse reflection of the spots' light gives the surfaces in the picture, for
// blocks of pixels: a lower limit, since further bounces and specular surfaces are left out. Edges
// of a square opening report it twice.
class LitSpots {
 public:
  LitSpots() = default;
  // Casts at most tuning::most_lit_spots rays for each of tuning::most_blocks blocks.
  LitSpots(WitnessScene& scene, const std::vector<LitSpot>& spots);
  [[nodiscard]] bool empty() const { return luminance_.empty(); }
  [[nodiscard]] double luminance(int x, int y) const;  // cd/m^2

 private:
  int block_px_ = 1, columns_ = 0;  // columns_: of blocks
  std::vector<float> luminance_;
};

}  // namespace earthshine::raytrace
