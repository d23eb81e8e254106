// SPDX-License-Identifier: Apache-2.0
// Means over sets of resels of what a CCTV camera shows, and the noise of such means. A mean of the
// line signal is a weighted sum of the noise where it entered the camera:
//   sum_x w(x) v(x) = ... + sum_z g(z) n(z),  g = F^T (slope w),  F the filters behind the noise,
// so its variance is sum_z Var n(z) g(z)^2: exact for linear filters, borders and fields included,
// and to first order in what the maps point by point do (slope: Bussgang's gain of a map, degrade/
// point_moments.h). What they add beyond that counts as white.
#pragma once

#include <cstdint>
#include <vector>

#include "studies/sight/cctv_signal.h"

namespace earthshine::studies {

struct WeightedResels {
  std::vector<std::uint32_t> resel;  // ascending
  std::vector<double> weight;        // sum 1
  double area = 0.0;                 // resels; of screen_sources 0

  [[nodiscard]] bool empty() const { return resel.empty(); }
};

// The resels of a grid that the pixels of a picture cover, by the area of each that they cover.
[[nodiscard]] WeightedResels weigh(const std::vector<std::uint32_t>& pixels, int picture_columns,
                                   int picture_rows, int grid_columns, int grid_rows);

// What the camera shows on average at some resels, and how it scatters; planes put together as
// luminance. Arrays have an entry per resel of the grid, right only where it was asked for.
struct ShownMoments {
  std::vector<float> mean;                // of the line signal
  std::vector<float> variance;            // of it, in one frame
  std::vector<float> variance_in_time;    // of its mean over the frames
  std::vector<float> luminance;           // of the screen before it spreads, mean, cd/m^2
  std::vector<std::vector<float>> slope;  // of each plane: v by S
  std::vector<float> beyond;              // part of `variance` that the slope does not tell
};
// frames: over which the mean in time goes, at least 1. resels: where the line signal is asked for,
// ascending; screen: the same for the screen.
[[nodiscard]] ShownMoments moments_at(const CctvSignal& line,
                                      const std::vector<std::uint32_t>& resels,
                                      const std::vector<std::uint32_t>& screen, int frames);

// Resels whose light the phosphor spreads to these, and how much of it: the luminance of the screen
// over `of` is their weighted sum. spread: screen_spread of the grid.
[[nodiscard]] WeightedResels screen_sources(const degrade::PlaneMap& spread,
                                            const WeightedResels& of);
// Mean luminance of the screen over a set, with spread and room light. screen: its screen_sources.
[[nodiscard]] double screen_mean(const CctvSignal& line, const ShownMoments& moments,
                                 const WeightedResels& screen);

// Variances of the means of the line signal over two sets, and their covariance, over frames.
struct MeanNoise {
  double variance_a = 0.0, variance_b = 0.0, covariance = 0.0;
};
[[nodiscard]] MeanNoise mean_noise(const CctvSignal& line, const ShownMoments& moments,
                                   const WeightedResels& a, const WeightedResels& b, int frames);

// The mean over `frames` frames of noise that keeps the share `lag` from field to field: variance
// of one field's mean and covariance with the other field's, of 1 in a frame. Without fields a
// frame lasts two and `other` is 0.
struct TimeFactors {
  double same = 1.0, other = 0.0;
};
[[nodiscard]] TimeFactors time_factors(double lag, bool has_fields, int frames);

}  // namespace earthshine::studies
