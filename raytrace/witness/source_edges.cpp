// SPDX-License-Identifier: Apache-2.0
#include "raytrace/witness/source_edges.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "raytrace/tuning.h"

namespace earthshine::raytrace {
namespace {

// Mean and standard deviation of a pixel's samples.
struct PixelStatistics {
  double mean = 0.0, deviation = 0.0;
};

PixelStatistics statistics_of(const PixelSums& sums, std::size_t pixel) {
  const double n = sums.samples[pixel];
  if (n == 0.0) return {};
  const double mean = sums.luminance[pixel] / n, square = sums.luminance2[pixel] / n;
  return {mean, std::sqrt(std::max(0.0, square - mean * mean))};
}

}  // namespace

std::uint32_t samples_for_edges(double error) {
  if (error <= 0.0) return tuning::fewest_at_source;
  const double wanted = std::pow(error_of_edge / error, 4.0 / 3.0);
  return std::bit_ceil(static_cast<std::uint32_t>(
      std::clamp(wanted, double(tuning::fewest_at_source), double(tuning::most_at_source))));
}

std::vector<std::uint32_t> wanted_for_source_edges(const PixelSums& sums, std::uint32_t samples,
                                                   double most_added) {
  const Window& window = sums.window;
  std::vector<std::size_t> edges;
  const auto is_at_edge = [&](int x, int y) {
    double low = std::numeric_limits<double>::infinity(), high = 0.0, scatter = 0.0;
    bool source = false;
    for (int qy = y - 1; qy <= y + 1; ++qy) {
      for (int qx = x - 1; qx <= x + 1; ++qx) {
        if (!window.contains(qx, qy)) continue;
        const std::size_t q = window.index(qx, qy);
        source = source || sums.source[q].luminance > 0.0;
        // The pixel's own samples do not decide: they would stop when they agree by chance, and
        // bias the mean.
        if (qx == x && qy == y) continue;
        const PixelStatistics pixel = statistics_of(sums, q);
        low = std::min(low, pixel.mean);
        high = std::max(high, pixel.mean);
        scatter = std::max(scatter, pixel.deviation);
      }
    }
    return source && std::max(high - low, scatter) > tuning::least_contrast * high;
  };
  for (int y = window.y; y < window.y + window.rows; ++y) {
    for (int x = window.x; x < window.x + window.columns; ++x) {
      if (is_at_edge(x, y)) edges.push_back(window.index(x, y));
    }
  }
  const auto added = [&](std::uint32_t each) {
    double sum = 0.0;
    for (const std::size_t p : edges) sum += each > sums.samples[p] ? each - sums.samples[p] : 0U;
    return sum;
  };
  while (samples > tuning::fewest_at_source && added(samples) > most_added) samples /= 2;
  std::vector<std::uint32_t> wanted = sums.samples;
  for (const std::size_t p : edges) wanted[p] = std::max(wanted[p], samples);
  return wanted;
}

}  // namespace earthshine::raytrace
