// SPDX-License-Identifier: Apache-2.0
// The sums that camera samples leave per pixel, and how many more a pixel deserves.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "raytrace/shading.h"

namespace earthshine::raytrace {

struct PixelSums {
  Window window;
  std::size_t entries = 0;           // image layers, then parts
  std::vector<glm::dvec3> radiance;  // pixel * entries, summed over samples
  std::vector<std::uint32_t> samples, source_samples;
  std::vector<double> luminance, luminance2;  // sums over samples, of the luminance and its square
  std::vector<double> field_error;            // sum of the gather points' standard errors

  PixelSums(const Window& of, std::size_t entries_per_pixel);
  // Of the mean luminance, from the spread of the samples alone.
  [[nodiscard]] double sample_variance(std::size_t pixel) const;
  // Standard deviation of one sample's luminance. Pixels brighter than `bright` are wanted as exact
  // in proportion, not more: theirs is scaled down to that luminance, or glints and lamps would
  // take all samples.
  [[nodiscard]] double deviation(std::size_t pixel, double bright) const;
  // The same with what the gather points' own errors add. All samples of a pixel share a point,
  // hence the errors of its samples do not average out.
  [[nodiscard]] double squared_error(std::size_t pixel) const;
  [[nodiscard]] double squared_field_error(std::size_t pixel) const;
};

// Brings every pixel up to wanted[pixel] samples. Sample k of a pixel is the same whatever came
// before. Returns early, between tiles, when stop says so.
void shade_samples(const ShadingScene& shared, const CameraModel& camera,
                   const std::vector<std::uint32_t>& wanted, PixelSums& sums, RayCounts& rays,
                   const std::function<bool()>& stop,
                   const std::function<void(std::uint64_t samples)>& progress);

// Samples that give the picture the least error for their number are proportional to each pixel's
// standard deviation: deviation / per_deviation, within [least, most], at most four times what the
// pixel has. The deviation is that of the noisiest of the eight neighbours: a pixel's own samples
// would stop where they happen to agree, and its mean would be biased. bright: as in deviation().
[[nodiscard]] std::vector<std::uint32_t> wanted_samples(const PixelSums& sums, double per_deviation,
                                                        double bright, int least, int most);

}  // namespace earthshine::raytrace
