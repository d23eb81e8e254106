// SPDX-License-Identifier: Apache-2.0
// The figures of studies/sight/sight.h that a CCTV is needed for.
#pragma once

#include <optional>

#include "studies/sight/sight.h"
#include "studies/sight/weighted_resels.h"

namespace earthshine::studies {

struct TargetSignal {
  SignalSight signal;
  MonitorSight monitor;
  std::optional<double> cycles;                                  // none without a surround
  std::optional<Probability> probability;                        // none without a surround
  std::optional<Probability> probability_low, probability_high;  // at the bounds of the contrast
  double saturated = 0.0, crushed = 0.0;
  double lines = 0.0;  // TV lines across the least extent
};

// Where a target stands on a grid of resels.
struct TargetResels {
  degrade::PlaneMap spread;  // of the screen that its `..._screen` are of
  WeightedResels measured, seen, surround;
  WeightedResels measured_screen, surround_screen;  // screen_sources
  struct Part {
    WeightedResels target, surround;
    double share = 0.0;
  };
  std::vector<Part> parts;
};

// Targets of which no pixel is seen get nothing.
[[nodiscard]] std::vector<std::optional<TargetSignal>> target_signals(
    const SightPlan& plan, const CctvSignal& line, const degrade::Setup& setup,
    const SightOptions& options, std::span<const ContrastBounds> bounds);

// What a tube's lag leaves of a target that moves by `speed` resels a field in `direction_rad`. The
// signal of a field is (1 - lag) sum lag^k of the light k fields ago, when the target stood k speed
// behind. share: of its difference from the surround, the mean over a box of `extent` resels,
// (1 - lag) sum lag^k max(0, 1 - k speed / extent).
struct Trail {
  double lag = 0.0, speed = 0.0, direction_rad = 0.0;
  [[nodiscard]] double share(double extent) const;
  // Of `frequency` cycles per resel in a direction: (1 - lag) / |1 - lag e^(2 pi i u speed)|.
  [[nodiscard]] double modulation(double direction, double frequency) const;
};

// Modulation that the chain leaves of `frequency` cycles per resel in a direction of the picture
// (radians from along to across): lens, area average of the resel, tube, video line, and on the
// screen the resel held over its width and the phosphor. Stages that are off leave all.
[[nodiscard]] double chain_modulation(const degrade::Setup& setup, double direction_rad,
                                      double frequency);

}  // namespace earthshine::studies
