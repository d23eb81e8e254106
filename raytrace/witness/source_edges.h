// SPDX-License-Identifier: Apache-2.0
// Edges of sources that the camera sees: the limbs of the Earth and the Sun, the rims of lamps and
// emitting surfaces, and silhouettes of bodies in front of them.
#pragma once

#include <cstdint>
#include <vector>

#include "raytrace/shade/pixel_sums.h"

namespace earthshine::raytrace {

// Samples for an RMS error of `error` in the share of a pixel that an edge covers. Samples of a
// pixel are stratified, so that the error is 0.27 n^-3/4 (edges in all directions and places).
// Between 64 and 1024, a power of two: with fewer, steps beside black are visible. error = 0: 64.
[[nodiscard]] std::uint32_t samples_for_edges(double error);

// Samples per pixel, so that pixels at the edges of sources have that many samples before their
// errors are stated. A pixel is at an edge if some of its 3 x 3 pixels show a source, and the eight
// around it, or the samples of one of them, differ by more than a third of the brightest. If the
// pixels would together take more than most_added, each gets fewer, but at least 64.
[[nodiscard]] std::vector<std::uint32_t> wanted_for_source_edges(const PixelSums& sums,
                                                                 std::uint32_t samples,
                                                                 double most_added);

}  // namespace earthshine::raytrace
