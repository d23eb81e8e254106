// SPDX-License-Identifier: Apache-2.0
// Gather points off the grid: where a pixel shows several surfaces, one for each that is not behind
// its centre. What nearby points of the grid say of the same surface is told apart from what is the
// case there by the off-grid point's own samples, as far as these know better (Wiener, as in
// share.h):
//   value = shared + c (own - shared),  c = s / (s + q)
// s: mean square of the true difference, a mean over the off-grid points of a region, no less
// than the noise there may hide; q: noise of as many samples as the off-grid point has, each of
// which has the mean noise of a sample there.
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
  std::uint32_t pixel = 0;  // of the window
  std::uint32_t base =
      0;  // nearest point of the grid on the same surface; no_base if there is none
  std::uint32_t region = 0;  // region_of() its pixel
  float cover = 0.0F;        // about, of the pixel
};
inline constexpr std::uint32_t no_base = 0xffffffffU;

// Parts of the picture, over which off-grid points are held to be alike, row by row.
[[nodiscard]] inline std::uint32_t region_of(std::size_t pixel, std::size_t columns) {
  const std::size_t x = pixel % columns / tuning::region_px,
                    y = pixel / columns / tuning::region_px;
  return static_cast<std::uint32_t>(y * (columns / tuning::region_px + 1) + x);
}

// OffGrid that lie side by side on one surface, each among its own: the last ones of some pixels.
struct MirrorNeighbourhood {
  std::span<const OffGridPoint> off_grid_points;
  std::span<const std::uint32_t> first;  // of a pixel, and behind the last
  std::span<const std::uint64_t>
      masks;                   // of an off-grid point: bits of the pixels about it, row by row
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

// Completes `shared`, which knows the points of the grid, by the off-grid points: point grid + k of
// the estimate is off-grid points[k].
void add_off_grid_points(std::span<const OffGridPoint> off_grid_points, const Estimate& estimate,
                         Shared& shared);

// Then off-grid points that have mirror neighbours are told apart from the mean of these in the
// same way; s and q are means over the mirror neighbours.
void share_among_mirror_neighbours(const MirrorNeighbourhood& mirror_neighbours,
                                   const Estimate& estimate, Shared& shared);

}  // namespace earthshine::raytrace
