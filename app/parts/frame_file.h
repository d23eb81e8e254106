// SPDX-License-Identifier: Apache-2.0
// A frame as a result that is kept: its image with the stated error of each pixel as further
// layers, and its report.
#pragma once

#include "app/parts/result_cache.h"
#include "raytrace/frame/frame.h"

namespace earthshine::app {

// picture: the size of the whole, of which the frame's window is the EXR file's data window.
[[nodiscard]] CachedResult kept_frame(const raytrace::Frame& frame,
                                      const raytrace::Window& picture);

// Back, bit for bit. Throws Json::exception where the facts are not those of a frame.
[[nodiscard]] raytrace::Frame frame_of(CachedResult kept);

}  // namespace earthshine::app
