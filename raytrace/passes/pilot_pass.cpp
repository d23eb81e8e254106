// SPDX-License-Identifier: Apache-2.0
#include "raytrace/passes/pilot_pass.h"

#include <algorithm>
#include <mutex>

#include "base/parallel.h"
#include "raytrace/tuning.h"

namespace earthshine::raytrace {
PilotPass run_pilot_pass(ShadingScene shared, const CameraModel& camera, int samples,
                         const std::function<bool()>& stop) {
  shared.diffuse = DiffuseSource::Solution;
  shared.splits_parts = false;
  const int step = std::max(1, std::min(camera.columns, camera.rows) / tuning::planning_grid);
  const int columns = (camera.columns + step - 1) / step, rows = (camera.rows + step - 1) / step;
  const auto count = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  std::vector<PixelSums> looks(count, PixelSums({0, 0, 1, 1}, shared.layers, false));
  PilotPass pilot;
  std::mutex mutex;
  base::parallel_chunks(count, 16, [&](std::size_t begin, std::size_t end) {
    RayCounts rays;
    for (std::size_t k = begin; k < end; ++k) {
      const int column = static_cast<int>(k) % columns, row = static_cast<int>(k) / columns;
      looks[k].window.x = std::min(camera.columns - 1, column * step + step / 2);
      looks[k].window.y = std::min(camera.rows - 1, row * step + step / 2);
      shade_samples(shared, camera, {static_cast<std::uint32_t>(samples)}, looks[k], rays, stop,
                    {});
    }
    const std::lock_guard lock(mutex);
    pilot.rays += rays;
  });
  double pixels = 0.0;
  pilot.dimmest.assign(shared.light_of_layer.back() + 1, 0.0);
  for (const PixelSums& look : looks) {
    if (!look.counts(0)) continue;
    pilot.luminance += look.reflected(0);
    for (std::size_t k = 0; k < shared.layers; ++k) {
      pilot.dimmest[shared.light_of_layer[k]] +=
          tuning::dimmest_share * base::luminance(Rgb(look.radiance[k])) / samples;
    }
    pixels += 1.0;
  }
  pilot.luminance /= std::max(1.0, pixels);
  for (double& of_light : pilot.dimmest) of_light /= std::max(1.0, pixels);
  for (const PixelSums& look : looks) {
    pilot.deviation += look.deviation(0, pilot.bright()) / static_cast<double>(count);
  }
  return pilot;
}

}  // namespace earthshine::raytrace
