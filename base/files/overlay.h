// SPDX-License-Identifier: Apache-2.0
// Drawing on a picture of 8 bits: smooth lines, and one picture laid over another.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/files/png_file.h"

namespace earthshine::base {

// Ends in pixels from the top left corner: (0.5, 0.5) is the centre of the first pixel. They may
// lie outside the picture.
struct Line {
  double x0 = 0.0, y0 = 0.0, x1 = 0.0, y1 = 0.0;
};

using Colour8 = std::array<std::uint8_t, 3>;

// How much of each pixel lines of that width cover, 0 to 1, row by row: width/2 + 1/2 less the
// distance of the pixel's centre from the nearest line (with round ends), cut to [0, 1], or to
// [0, width] of lines thinner than a pixel. Where lines cross the larger value counts, so that
// crossings are no brighter.
[[nodiscard]] std::vector<float> line_coverage(int width, int height, std::span<const Line> lines,
                                               double line_width_px);

// colour over picture with the opacity alpha times coverage, in display values (as drawing programs
// do). coverage has one value per pixel.
void paint(Picture8& picture, std::span<const float> coverage, const Colour8& colour, double alpha);

// over, of the same size, over picture: (1 - alpha) picture + alpha over, in display values.
// Throws base::Error (Work) when the sizes differ.
void blend(Picture8& picture, std::span<const std::uint8_t> over_rgb, double alpha);

}  // namespace earthshine::base
