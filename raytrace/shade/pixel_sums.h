// SPDX-License-Identifier: Apache-2.0
// Sums of the camera samples of each pixel, and the numbers of further samples.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "base/ranks/ranks.h"
#include "raytrace/shade/shading.h"

namespace earthshine::raytrace {

// RMS error of the share of a pixel that an edge covers, times n^(3/4), for n stratified samples;
// mean over all directions and positions of edges (law SourceEdges).
inline constexpr double error_of_edge = 0.27;

struct PixelSums {
  Window window;
  std::size_t image_layers = 0, entries = 0;  // entries: layers, then parts
  // pixel * entries, summed over samples, without light from gather points
  std::vector<glm::vec3> radiance;
  std::vector<std::vector<FieldTerm>> terms;  // light from gather points
  std::vector<std::uint32_t> samples;
  // Sums over samples of the luminance and its square, with gather points and sources that the
  // camera sees itself.
  std::vector<double> luminance, luminance2;
  std::vector<double> half_difference;  // between the sums of even and odd samples' luminance
  std::vector<SourceSeen> source;
  std::vector<float> rays;  // all rays cast for the samples

  std::vector<float> layers_differ;  // half_difference by layer, for noted pixels
  // Per pixel: 1 + its row in layers_differ, or 0 if it is not noted.
  std::vector<std::uint32_t> noted_row;
  std::vector<float> stands_for;  // per row: the number of pixels that it represents
  // Luminance of spots smaller than a pixel, predicted by the witness; empty: none.
  std::vector<float> spot_luminance;
  // Light that the witness predicts and the samples have not found, cd/m^2; empty: none.
  std::vector<float> unexplained;

  // noted: for a picture with this many columns, 1 where all pixels are noted.
  PixelSums(const Window& of, std::size_t image_layers, bool splits_parts,
            std::span<const std::uint8_t> noted = {}, int columns = 0);
  // Layer differences of a pixel that samples the noise of the layers (layer_noise_step).
  [[nodiscard]] std::span<float> layers_of(std::size_t pixel);
  // one_in: LayerNoise::selects().
  [[nodiscard]] LayerNoise layer_noise(int columns, std::size_t one_in = 1) const;
  // Variance of the mean luminance, from the spread of the samples alone.
  [[nodiscard]] double sample_variance(std::size_t pixel) const;
  // Squared error of the mean, from the pixel's two halves; right on average over pixels. Where the
  // witness predicts a spot, it is at least the mean squared error of the spot's edge, because a
  // few pixels may hold most of the picture's error and their halves may agree by chance. A single
  // sample has no halves: it takes the error of the pixel at the upper left of its square of four
  // (AdaptiveRender::shade_initial), scaled to one sample.
  [[nodiscard]] double squared_error(std::size_t pixel) const;
  // Whether the pixel shows a reflecting surface and no edge of a source.
  [[nodiscard]] bool counts(std::size_t pixel) const;
  // Mean luminance without sources that the camera sees itself.
  [[nodiscard]] double reflected(std::size_t pixel) const {
    return samples[pixel] > 0 ? (luminance[pixel] - source[pixel].luminance) / samples[pixel] : 0.0;
  }
  // Mean of reflected() over the pixels that count.
  [[nodiscard]] double mean_luminance() const;
  // All sums of a pixel.
  void pass(std::size_t pixel, base::Parcel& parcel);
  // Adds samples to the sums of a pixel.
  void add(std::size_t pixel, const PixelShader& shader, std::uint32_t first, std::uint32_t count);

 private:
  // The pixel at the upper left of its square of four.
  [[nodiscard]] std::size_t corner_of(std::size_t pixel) const;
};

// Increases the samples of each pixel to wanted[pixel]. Sample k of a pixel does not depend on
// earlier calls. Returns early, between pixels, if stop() returns true.
void shade_samples(const ShadingScene& shared, const CameraModel& camera,
                   const std::vector<std::uint32_t>& wanted, PixelSums& sums, RayCounts& rays,
                   const std::function<bool()>& stop,
                   const std::function<void(std::uint64_t samples)>& progress);

// Up to four times the current samples where samples of a neighbour scatter by more than a third of
// its luminance, or of `dimmest`, or where neighbours differ by as much. Stairs and grain are
// visible on dim surfaces, too, although they hardly matter in the picture's error. The neighbours
// decide because all samples of the pixel itself may miss a narrow part beyond an edge.
[[nodiscard]] std::vector<std::uint32_t> wanted_for_the_eye(const PixelSums& sums,
                                                            std::span<const float> scatter,
                                                            double dimmest);
// Scatter of each pixel's samples, over the sum of the layers.
[[nodiscard]] std::vector<float> scatter_of_samples(const PixelSums& sums, double dimmest);

}  // namespace earthshine::raytrace
