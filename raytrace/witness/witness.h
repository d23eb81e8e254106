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
  double error = 0.0;         // wanted of the picture, relative to `luminance`; 0: none is stated
  double luminance = 0.0;     // mean of the picture, cd/m^2; spots far below it are left out
  double most_samples = 0.0;  // that may be added; 0: no bound but that of spots
  bool images_alone = false;  // of sources; no strips, no edges
  std::function<bool()> stop = {};
};

class Witness {
 public:
  // Of the whole picture, so that a crop's pixels get as many samples.
  Witness(const ShadingScene& shared, const CameraModel& camera, const WitnessOptions& options);

  // Samples that each pixel of the sums should have to find the light that the witness expects
  // there, at most 2^20 more in the whole picture, or four a pixel: of more all get less. And at
  // edges of sources that the camera sees (source_edges.h).
  [[nodiscard]] std::vector<std::uint32_t> wanted(const PixelSums& sums) const;
  // Of the spots in each pixel of the sums; 0 where none count (PixelSums::spot_luminance).
  [[nodiscard]] std::vector<float> spot_luminance(const PixelSums& sums) const;
  // Mean luminance that the samples of a pixel and its neighbours have not found, cd/m^2; 0 where
  // they agree with the witness. Empty where all agree.
  [[nodiscard]] std::vector<float> unexplained(const PixelSums& sums) const;
  [[nodiscard]] std::uint64_t rays() const { return rays_; }

 private:
  // Of a pixel whose spots count; zeros elsewhere.
  struct Expected {
    double samples = 0.0, light = 0.0;  // light: mean luminance, cd/m^2
    double luminance = 0.0;             // of the spots themselves
  };
  [[nodiscard]] Expected expected(int x, int y) const;
  [[nodiscard]] double samples_of_source(const SpotMap::Pixel& pixel) const;
  [[nodiscard]] double samples_of_lit(const SpotMap::Pixel& pixel) const;
  // Expected squared error, weighted, that a few samples leave of a pixel's spots, (cd/m^2)^2.
  [[nodiscard]] double risk(const SpotMap::Pixel& pixel) const;
  // RMS error that spots may leave in the picture, cd/m^2.
  [[nodiscard]] double allowed() const;
  void choose();

  const CameraModel& camera_;
  WitnessOptions options_;
  // Whole images of sources, strips of them, and spots on surfaces. The same source may be in the
  // first two.
  SpotMap images_, slivers_, lit_;
  // Spots on surfaces count where they risk so much: what the others risk together may be left. And
  // how many of those pixels there are.
  double least_risk_ = 0.0, chosen_ = 0.0;
  std::uint64_t rays_ = 0;
};

}  // namespace earthshine::raytrace
