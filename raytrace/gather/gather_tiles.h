// SPDX-License-Identifier: Apache-2.0
// Tiles of gather points: the unit of work of a thread.
#pragma once

#include <algorithm>
#include <span>

#include "raytrace/camera/camera.h"
#include "raytrace/gather/gather_rays.h"

namespace earthshine::raytrace {

[[nodiscard]] inline Window tile_of(const Window& window, std::size_t tile) {
  const int columns = (window.columns + gather_tile_px - 1) / gather_tile_px;
  const int x = window.x + static_cast<int>(tile) % columns * gather_tile_px;
  const int y = window.y + static_cast<int>(tile) / columns * gather_tile_px;
  return {x, y, std::min(gather_tile_px, window.x + window.columns - x),
          std::min(gather_tile_px, window.y + window.rows - y)};
}

[[nodiscard]] inline std::size_t tile_count(const Window& window) {
  const auto up = [](int px) {
    return static_cast<std::size_t>((px + gather_tile_px - 1) / gather_tile_px);
  };
  return up(window.columns) * up(window.rows);
}

[[nodiscard]] inline double luminance_of(std::span<const Rgb> layers) {
  Rgb sum(0.0);
  for (const Rgb& layer : layers) sum += layer;
  return base::luminance(sum);
}

}  // namespace earthshine::raytrace
