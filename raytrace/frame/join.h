// SPDX-License-Identifier: Apache-2.0
// A picture from parts of it that were drawn apart.
#pragma once

#include <vector>

#include "raytrace/frame/frame.h"

namespace earthshine::raytrace {

// The frame of `window` from frames whose windows lie in it, each of its pixels in exactly one:
// image, stated error and what the report says of the pixels are those of one frame drawn at once.
// Rays and seconds are all that the parts took. Throws std::invalid_argument where the windows do
// not fill it or the frames have other layers.
[[nodiscard]] Frame join(const std::vector<Frame>& parts, const Window& window);

}  // namespace earthshine::raytrace
