// SPDX-License-Identifier: Apache-2.0
// Lamps without size that send much of their flux into a narrow beam: what it lights is so small
// that samples which are even over surfaces or pixels miss it.
#pragma once

#include <span>
#include <vector>

#include "scenes/scene.h"

namespace earthshine::scenes {

struct Beam {
  struct Ray {
    Vec3 direction;
    double share;           // of the lamp's flux
    double solid_angle_sr;  // that the ray represents, by the distance of its neighbours
  };
  Vec3 origin{0.0}, axis{0.0};
  double half_angle_rad = 0.0;  // about the axis, of all rays
  std::vector<Ray> rays;
};

// Of spot lamps and measured luminaires: those with a cone of 5 degrees half angle that holds a
// twelfth of the flux. The same rays for every call.
[[nodiscard]] std::vector<Beam> narrow_beams(std::span<const Lamp> lamps);

}  // namespace earthshine::scenes
