// SPDX-License-Identifier: Apache-2.0
// Drawing on 8-bit pictures: antialiased lines and blending of two pictures.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/files/png_file.h"

namespace earthshine::base {

// End points in pixels from the top left corner; (0.5, 0.5) is the centre of the first pixel. They
// may be outside the picture.
struct Line {
  double x0 = 0.0, y0 = 0.0, x1 = 0.0, y1 = 0.0;
};

using Colour8 = std::array<std::uint8_t, 3>;

// Coverage of each pixel by lines of this width, in rows: width/2 + 1/2 minus the distance of the
// pixel's centre from the nearest line (with round ends), clamped to [0, min(1, width)]. At
// crossings the larger value is used, so that they are not brighter.
[[nodiscard]] std::vector<float> line_coverage(int width, int height, std::span<const Line> lines,
                                               double line_width_px);

// Blends `colour` over the picture with the opacity alpha * coverage, in display values as drawing
// programs do. coverage has one value per pixel.
void paint(Picture8& picture, std::span<const float> coverage, const Colour8& colour, double alpha);

// Blends a picture of the same size: (1 - alpha) picture + alpha over, in display values. Throws
// base::Error (Work) if the sizes differ.
void blend(Picture8& picture, std::span<const std::uint8_t> over_rgb, double alpha);

}  // namespace earthshine::base
