// SPDX-License-Identifier: Apache-2.0
// A square of gather points on a plane, and synthetic estimates.
#pragma once

#include <cstddef>
#include <vector>

#include "raytrace/share/share.h"

namespace earthshine::raytrace::flat_estimate {

inline constexpr int edge_px = 48;
inline constexpr std::size_t count = static_cast<std::size_t>(edge_px) * edge_px;
inline constexpr Window window{0, 0, edge_px, edge_px};

inline std::size_t pixel(int x, int y) { return static_cast<std::size_t>(y * edge_px + x); }

// Points on a plane 2 m in front of the camera, facing it, one per pixel.
inline std::vector<GatherPoint> flat() {
  std::vector<GatherPoint> points(count);
  for (int y = 0; y < edge_px; ++y) {
    for (int x = 0; x < edge_px; ++x) {
      GatherPoint& point = points[pixel(x, y)];
      point.position =
          glm::vec3(0.01F * static_cast<float>(x), 0.01F * static_cast<float>(y), -2.0F);
      point.normal = glm::vec3(0.0F, 0.0F, 1.0F);
      point.reach_m = 1.0F;
      point.triangle = static_cast<std::uint32_t>(pixel(x, y));
      point.spacing_m = 0.01F;
    }
  }
  return points;
}

// Two samples a point, one in each half: value(x, y, half).
template <class Value>
Estimate estimate_of(const Value& value) {
  Estimate estimate(count, 1, 1);
  for (int y = 0; y < edge_px; ++y) {
    for (int x = 0; x < edge_px; ++x) {
      const std::size_t p = pixel(x, y);
      const auto first = static_cast<float>(value(x, y, std::size_t{0}));
      const auto second = static_cast<float>(value(x, y, std::size_t{1}));
      estimate.add_luminance(p, first, second);
      estimate.sum[p] = glm::vec3(first + second);
      estimate.samples[p] = 2.0F;
    }
  }
  return estimate;
}

}  // namespace earthshine::raytrace::flat_estimate
