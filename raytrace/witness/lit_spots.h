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

// Estimates the luminance that one diffuse reflection of the spots' light gives the surfaces in the
// middle of blocks of pixels. Further bounces and specular surfaces are left out.
class LitSpots {
 public:
  LitSpots() = default;
  // Casts at most tuning::most_lit_spots rays for each of tuning::most_blocks blocks.
  LitSpots(WitnessScene& scene, const std::vector<LitSpot>& spots);

  struct Block {
    int x = 0, y = 0;        // pixel in the middle
    float luminance = 0.0F;  // cd/m^2
  };
  [[nodiscard]] const std::vector<Block>& blocks() const { return blocks_; }
  [[nodiscard]] int block_px() const { return block_px_; }

 private:
  int block_px_ = 1;
  std::vector<Block> blocks_;
};

}  // namespace earthshine::raytrace
