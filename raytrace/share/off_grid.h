// SPDX-License-Identifier: Apache-2.0
// Off-grid gather points: a pixel that shows several surfaces has one for each surface that is not
// behind its centre. Grid points nearby on the same surface give a shared value. The point's own
// samples correct it by a Wiener gain, as in share.h:
//   value = shared + c (own - shared),  c = s / (s + q)
//   s  mean square of the true difference, over the off-grid points of a region; at least its own
//      standard error
//   q  noise of as many samples as the off-grid point has, from the mean noise of a sample there
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "raytrace/share/share.h"
#include "raytrace/tuning.h"

namespace earthshine::raytrace {

struct OffGridPoint {
  std::uint32_t pixel = 0;  // index in the window
  std::uint32_t base =
      0;  // nearest point of the grid on the same surface; no_base if there is none
  std::uint32_t region = 0;  // region_of() the pixel
  float cover = 0.0F;        // approximate share of the pixel
};
inline constexpr std::uint32_t no_base = 0xffffffffU;

// Square regions of the picture, row by row. Off-grid points of a region share s and q.
[[nodiscard]] inline std::uint32_t region_of(std::size_t pixel, std::size_t columns) {
  const std::size_t x = pixel % columns / tuning::region_px,
                    y = pixel / columns / tuning::region_px;
  return static_cast<std::uint32_t>(y * (columns / tuning::region_px + 1) + x);
}

// Off-grid points on one surface that a mirror shows: the last points of neighbouring pixels.
struct MirrorNeighbourhood {
  std::span<const OffGridPoint> off_grid_points;
  std::span<const std::uint32_t> first;  // per pixel, and one past the last
  std::span<const std::uint64_t>
      masks;                   // per off-grid point: a bit per pixel around it, row by row
  std::ptrdiff_t columns = 0;  // of the window
  template <class Visit>
  void each(std::size_t off_grid_point, const Visit& visit) const {
    std::uint64_t bits = masks[off_grid_point];
    for (; bits != 0; bits &= bits - 1) {
      constexpr int width = 2 * tuning::mirror_reach_px + 1;
      const int bit = std::countr_zero(bits);
      const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(off_grid_points[off_grid_point].pixel) +
                                (bit / width - tuning::mirror_reach_px) * columns + bit % width -
                                tuning::mirror_reach_px;
      visit(std::size_t{first[static_cast<std::size_t>(at) + 1]} - 1);
    }
  }
};

// Adds the off-grid points to `shared`, which has the grid points: point grid + k of the estimate
// is off_grid_points[k].
void add_off_grid_points(std::span<const OffGridPoint> off_grid_points, const Estimate& estimate,
                         Shared& shared);

// Then shrinks off-grid points with mirror neighbours to the mean of these in the same way; s and q
// are means over the mirror neighbours.
void share_among_mirror_neighbours(const MirrorNeighbourhood& mirror_neighbours,
                                   const Estimate& estimate, Shared& shared);

}  // namespace earthshine::raytrace
