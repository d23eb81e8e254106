// SPDX-License-Identifier: Apache-2.0
// Linear maps along one axis of a picture, for resampling, blur and phosphor spread.
#pragma once

#include <cstddef>
#include <vector>

#include "degrade/stage/picture.h"

namespace earthshine::degrade {

// out[i] = sum over k in [start[i], start[i+1]) of weight[k] * in[source[k]]. The weights of each i
// sum to 1, so that a constant is preserved up to the border. Squared weights map variances.
struct AxisMap {
  int in = 0;
  std::vector<std::size_t> start{0};
  std::vector<std::size_t> source;
  std::vector<double> weight;

  [[nodiscard]] int out() const { return static_cast<int>(start.size()) - 1; }
  bool operator==(const AxisMap&) const = default;
};

// Appends an output: weight[k] applies to input first + k. Inputs beyond the border are mirrored,
// so that no light is lost; the weights are scaled to the sum 1.
void add_output(AxisMap& map, int first, const std::vector<double>& weight);

// Exact area averages: output i is the mean of the inputs over [i, i + 1) * in / out.
[[nodiscard]] AxisMap area_average(int in, int out);

// The discrete Gaussian of Lindeberg (1990), e^-t I_n(t) with t = sigma^2. On a grid of one sample
// per resel its variance is exactly sigma^2, two of them cascade exactly, and its transfer is
// exp(-t (1 - cos 2 pi f)). A sampled Gaussian has none of these properties below sigma = 0.6, the
// range of cameras.
[[nodiscard]] std::vector<double> discrete_gaussian(double sigma);  // symmetric, odd length
[[nodiscard]] AxisMap gaussian_blur(int size, double sigma);
// `map` without weights of magnitude below `least`; the others are not scaled.
[[nodiscard]] AxisMap without_taps_below(const AxisMap& map, double least);
// The same taps, an odd number, at every position.
[[nodiscard]] AxisMap symmetric_filter(int size, const std::vector<double>& taps);

struct PlaneMap {
  AxisMap along, across;
  bool operator==(const PlaneMap&) const = default;
};

// Every row through `along`, then every column through `across`.
[[nodiscard]] Picture apply(const Picture& picture, const AxisMap& along, const AxisMap& across);

}  // namespace earthshine::degrade
