// SPDX-License-Identifier: Apache-2.0
// Light of a source that a flat mirror throws onto a point: that of the source's image.
#pragma once

#include "scenes/light/lamp_light.h"

namespace earthshine::scenes {

// sample: of the source itself, as the mirror's image of `point` sees it. What comes out is seen
// from the point; its light is 0 where the mirror lies elsewhere. The mirror's own share is not in
// it: RayQuery::light_shares has that of the very place. Flat mirrors keep areas and angles, so
// that the whole way takes the place of the distance.
[[nodiscard]] LightSample thrown(const LightSample& sample, const FlatMirror& mirror,
                                 std::uint32_t number, const Vec3& point);

}  // namespace earthshine::scenes
