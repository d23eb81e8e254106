// SPDX-License-Identifier: Apache-2.0
// Sources, and what narrow beams light, that the camera sees smaller than its pixels are.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "raytrace/shade/pixel_sums.h"

namespace earthshine::raytrace {

// Samples that each pixel of the sums should have so that those which show a lamp, a Sun, an
// emitting surface or the place that a narrow beam lights, smaller than a pixel, meet it some 64 times: few would miss it by chance, or make
// it far too bright. No source whose middle and what is about it lie behind opaque surfaces;
// mirrors are not looked into. At most 2^20 more in the whole picture, or four a pixel: of more all
// get less. The others keep what they have. Once stop says so, no more sources are looked at.
[[nodiscard]] std::vector<std::uint32_t> wanted_for_small_sources(
    const ShadingScene& shared, const CameraModel& camera, const PixelSums& sums,
    const std::function<bool()>& stop);

}  // namespace earthshine::raytrace
