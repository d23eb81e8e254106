// SPDX-License-Identifier: Apache-2.0
// Joins parts of a picture.
#pragma once

#include <vector>

#include "raytrace/frame/frame.h"

namespace earthshine::raytrace {

// The frame of `window` from frames whose windows divide it. Image, stated error and the report's
// values per pixel are as in a frame drawn at once. Rays and seconds are sums over the parts.
// Throws std::invalid_argument if the windows do not fill it or the frames have different layers.
[[nodiscard]] Frame join(const std::vector<Frame>& parts, const Window& window);

}  // namespace earthshine::raytrace
