// SPDX-License-Identifier: Apache-2.0
// What a picture says of its own error, pixel by pixel, from the samples that it is made of.
#pragma once

#include <array>
#include <vector>

#include "raytrace/frame/frame.h"
#include "raytrace/gather/gather_field.h"
#include "raytrace/shade/pixel_sums.h"

namespace earthshine::raytrace {

// What the window shows without sources that the camera sees itself, and how far off it may be.
// Single pixels are stated by few samples and scatter; sums over many are right.
[[nodiscard]] StatedError state_error(const PixelSums& sums, const GatherField* field);

}  // namespace earthshine::raytrace
