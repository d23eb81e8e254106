// SPDX-License-Identifier: Apache-2.0
// A second, independent estimate of light that few camera samples find: projects images of sources,
// direct and in reflecting facets, and thin strips of light into the picture.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "raytrace/shade/pixel_sums.h"
#include "raytrace/witness/lit_spots.h"
#include "raytrace/witness/spot_map.h"

namespace earthshine::raytrace {

struct WitnessOptions {
  double error = 0.0;         // wanted error of the picture, relative to `luminance`; 0: none
  double luminance = 0.0;     // mean of the picture, cd/m^2; much dimmer spots are omitted
  double most_samples = 0.0;  // most additional samples; 0: only the limits of spots
  bool images_alone = false;  // only images of sources; no strips, no edges
  std::function<bool()> stop = {};
};

class Witness {
 public:
  // Covers the whole picture, so that the pixels of a crop get as many samples.
  Witness(const ShadingScene& shared, const CameraModel& camera, const WitnessOptions& options);

  // Samples per pixel of the sums, to find the light that the witness predicts and to resolve edges
  // of visible sources (source_edges.h). The whole picture gets at most 2^20 more, or four per
  // pixel; a larger demand is scaled down.
  [[nodiscard]] std::vector<std::uint32_t> wanted(const PixelSums& sums) const;
  // Luminance of the spots in each pixel of the sums; 0 if they do not matter
  // (PixelSums::spot_luminance).
  [[nodiscard]] std::vector<float> spot_luminance(const PixelSums& sums) const;
  // Mean luminance that the samples of a pixel and its neighbours have missed, cd/m^2: of spots, and
  // of light that small lit spots reflect there; 0 if they agree with the witness. Empty if all
  // agree.
  // reflected: mean luminance of each pixel, with the light of gather points as it is now.
  [[nodiscard]] std::vector<float> unexplained(const PixelSums& sums,
                                               std::span<const float> reflected) const;
  [[nodiscard]] std::uint64_t rays() const { return rays_; }

 private:
  // Prediction for a pixel whose spots matter; zeros for others.
  struct Expected {
    double samples = 0.0, light = 0.0;  // light: mean luminance, cd/m^2
    double luminance = 0.0;             // of the spots themselves
  };
  [[nodiscard]] Expected expected(int x, int y) const;
  [[nodiscard]] double samples_of_source(const SpotMap::Pixel& pixel) const;
  [[nodiscard]] double samples_of_lit(const SpotMap::Pixel& pixel) const;
  // Expected weighted squared error of a pixel's spots with a few samples, (cd/m^2)^2.
  [[nodiscard]] double risk(const SpotMap::Pixel& pixel) const;
  // RMS error that spots may leave in the picture, cd/m^2.
  [[nodiscard]] double allowed() const;
  // Adds the light of lit spots to `missing`, if all of it exceeds the wanted error.
  void add_unreflected(const Window& window, std::span<const float> reflected,
                       std::vector<float>& missing) const;
  void choose();

  const CameraModel& camera_;
  WitnessOptions options_;
  // Whole images of sources, strips of sources, and spots on surfaces. The first two may contain
  // the same source.
  SpotMap images_, slivers_, lit_;
  LitSpots reflected_;
  // Least risk of a spot on surfaces that matters (the allowed error covers the sum of smaller
  // risks), and the number of pixels with such spots.
  double least_risk_ = 0.0, chosen_ = 0.0;
  std::uint64_t rays_ = 0;
};

}  // namespace earthshine::raytrace
