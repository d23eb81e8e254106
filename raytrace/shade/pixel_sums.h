// SPDX-License-Identifier: Apache-2.0
// The sums that camera samples leave per pixel, and how many more a pixel deserves.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "base/ranks/ranks.h"
#include "raytrace/shade/shading.h"

namespace earthshine::raytrace {

// RMS error of the share of a pixel that an edge covers, times n^(3/4), by n samples, spread
// evenly: of edges in all directions and places (law SourceEdges).
inline constexpr double error_of_edge = 0.27;

struct PixelSums {
  Window window;
  std::size_t image_layers = 0, entries = 0;  // with parts behind the layers
  // pixel * entries, summed over samples, without what they read from gather points
  std::vector<glm::vec3> radiance;
  std::vector<std::vector<FieldTerm>> terms;  // that
  std::vector<std::uint32_t> samples;
  // Sums over samples, of the luminance and its square, gather points and sources that the camera
  // sees itself included.
  std::vector<double> luminance, luminance2;
  std::vector<double> half_difference;  // of the sums of even and odd samples' luminance
  std::vector<SourceSeen> source;
  std::vector<float> rays;  // cast for the samples, of all kinds

  std::vector<float> layers_differ;  // the same by layer, of pixels that are noted
  // Of a pixel: 1 + its row in layers_differ, 0 where it is not noted; for how many pixels it
  // stands.
  std::vector<std::uint32_t> noted_row;
  std::vector<float> stands_for;  // by row
  // Of spots smaller than the pixel, which the witness expects there; empty: none.
  std::vector<float> spot_luminance;
  // Light that the witness expects and the samples have not found, cd/m^2; empty: none.
  std::vector<float> unexplained;

  // noted: of a picture with so many columns, 1 where all pixels are noted.
  PixelSums(const Window& of, std::size_t image_layers, bool splits_parts,
            std::span<const std::uint8_t> noted = {}, int columns = 0);
  // Of a pixel that tells the noise of the layers (layer_noise_step).
  [[nodiscard]] std::span<float> layers_of(std::size_t pixel);
  [[nodiscard]] LayerNoise layer_noise(int columns) const;
  // Of the mean luminance, from the spread of the samples alone.
  [[nodiscard]] double sample_variance(std::size_t pixel) const;
  // The squared error of the mean, from the pixel's two halves alone: right on average over pixels.
  // Where the witness expects a spot, no less than its edge leaves on the average: a few pixels may
  // hold most of a picture's error, and their halves agree by chance.
  // A single sample has no halves: it takes those of the pixel at the upper left of its square of
  // four (AdaptiveRender::shade_initial), by as much as fewer samples are further off.
  [[nodiscard]] double squared_error(std::size_t pixel) const;
  // Whether the pixel shows a surface that reflects and no edge of a source itself.
  [[nodiscard]] bool counts(std::size_t pixel) const;
  // Mean luminance, without sources that the camera sees itself.
  [[nodiscard]] double reflected(std::size_t pixel) const {
    return samples[pixel] > 0 ? (luminance[pixel] - source[pixel].luminance) / samples[pixel] : 0.0;
  }
  // That of the pixels that count.
  [[nodiscard]] double mean_luminance() const;
  // All of a pixel.
  void pass(std::size_t pixel, base::Parcel& parcel);
  // Samples into the sums of a pixel.
  void add(std::size_t pixel, const PixelShader& shader, std::uint32_t first, std::uint32_t count);

 private:
  // The pixel at the upper left of its square of four.
  [[nodiscard]] std::size_t corner_of(std::size_t pixel) const;
};

// Brings every pixel up to wanted[pixel] samples. Sample k of a pixel is the same whatever came
// before. Returns early, between pixels, when stop says so.
void shade_samples(const ShadingScene& shared, const CameraModel& camera,
                   const std::vector<std::uint32_t>& wanted, PixelSums& sums, RayCounts& rays,
                   const std::function<bool()>& stop,
                   const std::function<void(std::uint64_t samples)>& progress);

// Up to four times as many as there are where samples of a neighbour scatter by more than a third
// of its luminance, or of `dimmest`, or where neighbours differ from each other by as much: the eye
// sees stairs and grain on dim surfaces too, which the picture's error has little of. All samples
// of a pixel may miss the little that an edge leaves in it, and so may those of the pixels beside
// it have nothing else. Neighbours, as above.
[[nodiscard]] std::vector<std::uint32_t> wanted_for_the_eye(const PixelSums& sums,
                                                            std::span<const float> scatter,
                                                            double dimmest);
// Of all light together.
[[nodiscard]] std::vector<float> scatter_of_samples(const PixelSums& sums, double dimmest);

}  // namespace earthshine::raytrace
