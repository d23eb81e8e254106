// SPDX-License-Identifier: Apache-2.0
// Edges of sources that the camera sees itself: the limb of the Earth and of the Sun, the rims of
// lamps and emitting surfaces, and whatever stands in front of them.
#pragma once

#include <cstdint>
#include <vector>

#include "raytrace/shade/pixel_sums.h"

namespace earthshine::raytrace {

// Samples that leave the share of a pixel which an edge covers an RMS error of `error`: samples of
// a pixel are spread evenly, so that the error of n is 0.27 n^-3/4 (edges in all directions and
// places). 64 to 1024, a power of two: with fewer, the eye sees steps beside black. error = 0: 64.
[[nodiscard]] std::uint32_t samples_for_edges(double error);

// Samples that each pixel of the sums should have so that pixels at the edges of sources have as
// many as that, before their errors are stated. A pixel is at an edge if the eight pixels around
// it, or the samples of one of them, differ by more than a third of the brightest and some of the
// nine show a source. All get fewer, but at least 64, where together they would take more than
// most_added.
[[nodiscard]] std::vector<std::uint32_t> wanted_for_source_edges(const PixelSums& sums,
                                                                 std::uint32_t samples,
                                                                 double most_added);

}  // namespace earthshine::raytrace
