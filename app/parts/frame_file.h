// SPDX-License-Identifier: Apache-2.0
// A frame as a stored result: its image, the stated error of each pixel as further layers, and its
// report.
#pragma once

#include "app/parts/result_cache.h"
#include "raytrace/frame/frame.h"

namespace earthshine::app {

// picture: the size of the whole picture; the frame's window is the EXR file's data window.
[[nodiscard]] CachedResult kept_frame(const raytrace::Frame& frame,
                                      const raytrace::Window& picture);

// The exact frame again. Throws Json::exception if the facts are not those of a frame.
[[nodiscard]] raytrace::Frame frame_of(CachedResult kept);

}  // namespace earthshine::app
