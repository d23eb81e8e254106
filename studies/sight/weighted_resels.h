// SPDX-License-Identifier: Apache-2.0
// Means over sets of resels in a CCTV camera's signal, and the noise of such means. A mean of the
// line signal is a weighted sum of the noise where it entered the camera:
//   sum_x w(x) v(x) = ... + sum_z g(z) n(z),  g = F^T (slope w),  F the filters after the noise,
// so its variance is sum_z Var n(z) g(z)^2. This is exact for linear filters, with borders and
// fields, and of first order in the point maps (slope: Bussgang's gain of a map,
// degrade/point_moments.h). Their higher orders count as white noise.
#pragma once

#include <cstdint>
#include <vector>

#include "studies/sight/cctv_signal.h"

namespace earthshine::studies {

struct WeightedResels {
  std::vector<std::uint32_t> resel;  // ascending
  std::vector<double> weight;        // sum 1
  double area = 0.0;                 // resels; 0 for screen_sources

  [[nodiscard]] bool empty() const { return resel.empty(); }
};

// The resels of a grid that the pixels of a picture cover, weighted by the covered area.
[[nodiscard]] WeightedResels weigh(const std::vector<std::uint32_t>& pixels, int picture_columns,
                                   int picture_rows, int grid_columns, int grid_rows);

// Moments of the signal at some resels; the planes are combined to luminance. Arrays have an entry
// per resel of the grid, valid only for the requested ones.
struct ShownMoments {
  std::vector<float> mean;                // of the line signal
  std::vector<float> variance;            // of the line signal, in one frame
  std::vector<float> variance_in_time;    // of its mean over the frames
  std::vector<float> luminance;           // of the screen before its spread, mean, cd/m^2
  std::vector<std::vector<float>> slope;  // per plane: dv/dS
  std::vector<float> beyond;              // part of `variance` beyond the first order
};
// frames: number of frames of the mean in time, at least 1. resels, screen: the requested resels of
// the line signal and of the screen, ascending.
[[nodiscard]] ShownMoments moments_at(const CctvSignal& line,
                                      const std::vector<std::uint32_t>& resels,
                                      const std::vector<std::uint32_t>& screen, int frames);

// Resels whose light the phosphor spreads to these, and their weights: the luminance of the screen
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

// For noise with correlation `lag` from field to field and variance 1 in a frame, over `frames`
// frames: variance of one field's mean, and covariance with the other field's mean. Without fields
// a frame lasts two, and `other` is 0.
struct TimeFactors {
  double same = 1.0, other = 0.0;
};
[[nodiscard]] TimeFactors time_factors(double lag, bool has_fields, int frames);

}  // namespace earthshine::studies
