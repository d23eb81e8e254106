// SPDX-License-Identifier: Apache-2.0
// A second, independent estimate of light that few camera samples find: images of sources, straight
// and in reflecting facets, and thin strips of light, projected into the picture.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "raytrace/shade/pixel_sums.h"
#include "raytrace/witness/spot_map.h"

namespace earthshine::raytrace {

struct WitnessOptions {
  double error = 0.0;      // wanted of the picture, relative to `luminance`; 0: none is stated
  double luminance = 0.0;  // mean of the picture, cd/m^2; spots far below it are left out
  std::function<bool()> stop = {};
};

class Witness {
 public:
  // Of the whole picture, so that a crop's pixels get as many samples.
  Witness(const ShadingScene& shared, const CameraModel& camera, const WitnessOptions& options);

  // Samples that each pixel of the sums should have to find the light that the witness expects
  // there. At most 2^20 more in the whole picture, or four a pixel: of more all get less.
  [[nodiscard]] std::vector<std::uint32_t> wanted(const PixelSums& sums) const;
  // Of the spots in each pixel of the sums; 0 where none count (PixelSums::spot_luminance).
  [[nodiscard]] std::vector<float> spot_luminance(const PixelSums& sums) const;
  // Mean luminance that the samples of a pixel and its neighbours have not found, cd/m^2; 0 where
  // they agree with the witness. Empty where all agree.
  [[nodiscard]] std::vector<float> unexplained(const PixelSums& sums) const;
  [[nodiscard]] std::uint64_t rays() const { return rays_; }

 private:
  [[nodiscard]] double samples_at(int x, int y) const;

  const CameraModel& camera_;
  WitnessOptions options_;
  SpotMap spots_;
  std::uint64_t rays_ = 0;
};

}  // namespace earthshine::raytrace
