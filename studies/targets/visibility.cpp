// SPDX-License-Identifier: Apache-2.0
#include "studies/targets/visibility.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace earthshine::studies {
namespace {

double mean(const std::vector<float>& values) {
  double sum = 0.0;
  for (const float value : values) sum += double(value);
  return sum / static_cast<double>(values.size());
}

// The resel in which the centre of the pixel lies.
std::size_t resel_of(std::size_t pixel, const base::Image& image, const ClippedResels& resels) {
  const auto along = [](std::size_t at, int of, int onto) {
    return static_cast<std::size_t>((static_cast<double>(at) + 0.5) * onto / of);
  };
  const std::size_t width = static_cast<std::size_t>(image.width);
  return along(pixel / width, image.height, resels.rows) *
             static_cast<std::size_t>(resels.columns) +
         along(pixel % width, image.width, resels.columns);
}

}  // namespace

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

ShownRange shown_range(const degrade::CctvCamera& camera, const degrade::Report& report,
                       double mean_luminance) {
  // Signal per cd/m^2 before gain; glare takes a share off each point and gives its mean to all.
  const double per_luminance =
      degrade::lens_transfer(camera, report.exposure.f_number) / camera.white_lux;
  const double veil = camera.glare * mean_luminance;
  const auto luminance_of_signal = [&](double signal) {
    return (signal / per_luminance - veil) / (1.0 - camera.glare);
  };
  double white = degrade::white_signal / report.exposure.gain;
  if (camera.saturation > 0.0) white = std::min(white, camera.saturation);
  return {luminance_of_signal(std::sqrt(report.noise.at_black())), luminance_of_signal(white)};
}

std::vector<TargetMetrics> target_metrics(const scenes::Scene& scene, const scenes::Camera& camera,
                                          const base::Image& image,
                                          const std::optional<ClippedResels>& cctv) {
  const ObjectMap map = object_map(image);
  const std::vector<float> luminance = base::luminance_of(image);
  std::vector<TargetMetrics> metrics;
  for (TargetView& view : find_targets(scene, camera, map)) {
    TargetMetrics target;
    const auto seen = static_cast<double>(view.pixels);
    if (view.pixels_alone > 0) {
      target.visible_fraction = seen / static_cast<double>(view.pixels_alone);
    }
    target.light = measure_light(view, luminance);
    if (cctv && view.in_view()) {
      std::size_t saturated = 0, crushed = 0;
      for (std::size_t i = 0; i < luminance.size(); ++i) {
        if (map.object[i] != static_cast<std::int32_t>(view.object)) continue;
        const std::size_t resel = resel_of(i, image, *cctv);
        if (cctv->saturated[resel] > 0.0F) ++saturated;
        if (cctv->crushed[resel] > 0.0F) ++crushed;
      }
      target.saturated_share = static_cast<double>(saturated) / seen;
      target.crushed_share = static_cast<double>(crushed) / seen;
    }
    target.view = std::move(view);
    metrics.push_back(std::move(target));
  }
  return metrics;
}

double mean_over(const std::vector<float>& values, const std::vector<std::uint32_t>& pixels) {
  double sum = 0.0;
  for (const std::uint32_t pixel : pixels) sum += static_cast<double>(values[pixel]);
  return sum / static_cast<double>(pixels.size());
}

double mean_luminance(const base::Image& image) { return mean(base::luminance_of(image)); }

}  // namespace earthshine::studies
