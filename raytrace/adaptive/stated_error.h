// SPDX-License-Identifier: Apache-2.0
// The stated error of a picture, per pixel, estimated from its own samples.
#pragma once

#include <array>
#include <vector>

#include "raytrace/frame/frame.h"
#include "raytrace/gather/gather_field.h"
#include "raytrace/shade/pixel_sums.h"

namespace earthshine::raytrace {

// Luminance of the window without sources that the camera sees itself, and its squared errors.
// Single pixels have few samples, so that their errors scatter; sums over many pixels are right.
[[nodiscard]] StatedError state_error(const PixelSums& sums, const GatherField* field);

}  // namespace earthshine::raytrace
