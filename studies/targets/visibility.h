// SPDX-License-Identifier: Apache-2.0
// How well a camera sees each target (docs/studies.md has the formulas and their thresholds).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/image.h"
#include "degrade/stage/camera.h"
#include "degrade/twin.h"
#include "studies/study.h"
#include "studies/targets/target_view.h"

namespace earthshine::studies {

// Luminance of a target and of what is round it, cd/m^2, and C_W = (L_t - L_b) / L_b.
struct TargetLight {
  double luminance = 0.0;          // mean over TargetView::measured
  std::optional<double> surround;  // mean; none where the target fills the picture
  std::optional<double> contrast;  // Weber; none without a surround or round a black one
};

// Nothing where the target is not in view. `luminance` per pixel, as base::luminance_of gives it.
[[nodiscard]] std::optional<TargetLight> measure_light(const TargetView& view,
                                                       const std::vector<float>& luminance);

// The luminances between which a CCTV camera tells differences, cd/m^2: at `white` the amplified
// signal reaches 0.995, at `black` it lies within one standard deviation of black's noise. The
// thresholds of degrade::Levels, carried back through gain, glare, lens and iris.
struct ShownRange {
  double black = 0.0;  // below 0 where glare alone lifts every pixel over the noise
  double white = 0.0;
};
// report: of degrade::degrade for a picture of this mean luminance.
[[nodiscard]] ShownRange shown_range(const degrade::CctvCamera& camera,
                                     const degrade::Report& report, double mean_luminance);

// What a camera's picture loses: 1 or 0 for each resel (degrade::Twin).
struct ClippedResels {
  int columns = 0;
  int rows = 0;
  degrade::Plane saturated, crushed;
};

struct TargetMetrics {
  TargetView view;
  std::optional<double> visible_fraction;  // seen / alone; none where it would not even show alone
  std::optional<TargetLight> light;        // in the clean picture; none where it is not in view
  // Shares of the seen pixels whose resel the CCTV clips at white or loses in the noise of black;
  // none without a CCTV camera or out of view.
  std::optional<double> saturated_share, crushed_share;
};

// One entry per target of the scene, in its order. image: of `camera`, with the layer "object".
// A pixel counts as the target's by its centre, and its resel is the one in which its centre lies.
[[nodiscard]] std::vector<TargetMetrics> target_metrics(const scenes::Scene& scene,
                                                        const scenes::Camera& camera,
                                                        const base::Image& image,
                                                        const std::optional<ClippedResels>& cctv);

// The mean of the values at these pixels, at least one.
[[nodiscard]] double mean_over(const std::vector<float>& values,
                               const std::vector<std::uint32_t>& pixels);

// Mean luminance of a picture, cd/m^2.
[[nodiscard]] double mean_luminance(const base::Image& image);

}  // namespace earthshine::studies
