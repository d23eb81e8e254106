// SPDX-License-Identifier: Apache-2.0
#include "studies/targets/target_light.h"

namespace earthshine::studies {

std::optional<TargetLight> measure_light(const TargetView& view,
                                         const std::vector<float>& luminance) {
  if (!view.in_view()) return std::nullopt;
  TargetLight light;
  light.luminance = mean_over(luminance, view.measured);
  if (view.surround.empty()) return light;
  light.surround = mean_over(luminance, view.surround);
  if (*light.surround > 0.0) {
    light.contrast = (light.luminance - *light.surround) / *light.surround;
  }
  return light;
}

double mean_over(const std::vector<float>& values, const std::vector<std::uint32_t>& pixels) {
  double sum = 0.0;
  for (const std::uint32_t pixel : pixels) sum += static_cast<double>(values[pixel]);
  return sum / static_cast<double>(pixels.size());
}

}  // namespace earthshine::studies
