// SPDX-License-Identifier: Apache-2.0
// Two pictures of one view by independent random numbers, made one.
#pragma once

#include "raytrace/frame.h"

namespace earthshine::raytrace {

// share * b + (1 - share) * a for radiance, with the variance that this leaves; the layers that one
// ray a pixel fills, which both have, stay as they are. Light layers add up to the picture to the
// last bit, as in render(). Rays and samples add up. Both of the same window and layers.
[[nodiscard]] Frame blend(Frame a, const Frame& b, double share);

}  // namespace earthshine::raytrace
