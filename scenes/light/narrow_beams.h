// SPDX-License-Identifier: Apache-2.0
// Lamps without size that emit much of their flux into a narrow beam: uniform samples of surfaces
// or pixels would miss the small area it lights.
#pragma once

#include <span>
#include <vector>

#include "scenes/scene.h"

namespace earthshine::scenes {

struct Beam {
  struct Ray {
    Vec3 direction;
    double share;           // of the lamp's flux
    double solid_angle_sr;  // represented by the ray, from its neighbours
  };
  Vec3 origin{0.0}, axis{0.0};
  double half_angle_rad = 0.0;  // about the axis, of all rays
  std::vector<Ray> rays;
};

// Beams of spot lamps and measured luminaires that have a twelfth of their flux in a cone of 5
// degrees half angle. Deterministic.
[[nodiscard]] std::vector<Beam> narrow_beams(std::span<const Lamp> lamps);

}  // namespace earthshine::scenes
