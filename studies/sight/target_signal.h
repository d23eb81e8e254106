// SPDX-License-Identifier: Apache-2.0
// The values of studies/sight/sight.h that need a CCTV.
#pragma once

#include <optional>

#include "studies/sight/sight.h"
#include "studies/sight/weighted_resels.h"

namespace earthshine::studies {

struct TargetSignal {
  SignalSight signal;
  MonitorSight monitor;
  std::optional<double> cycles;                                  // empty without a surround
  std::optional<Probability> probability;                        // empty without a surround
  std::optional<Probability> probability_low, probability_high;  // at the bounds of the contrast
  double saturated = 0.0, crushed = 0.0;
  double lines = 0.0;  // TV lines across the least extent
};

// The resels of a target on a grid.
struct TargetResels {
  degrade::PlaneMap spread;  // of the screen for which the `..._screen` members hold
  WeightedResels measured, seen, surround;
  WeightedResels measured_screen, surround_screen;  // screen_sources
  struct Part {
    WeightedResels target, surround;
    double share = 0.0;
  };
  std::vector<Part> parts;
};

// Empty for targets without visible pixels.
[[nodiscard]] std::vector<std::optional<TargetSignal>> target_signals(
    const SightPlan& plan, const CctvSignal& line, const degrade::Setup& setup,
    const SightOptions& options, std::span<const ContrastBounds> bounds);

// Effect of a tube's lag on a target that moves by `speed` resels per field in `direction_rad`. The
// signal of a field is (1 - lag) sum lag^k of the light k fields ago. The target was k speed behind
// then. share: remaining difference from the surround, the mean over a box of `extent` resels:
//   (1 - lag) sum lag^k max(0, 1 - k speed / extent).
struct Trail {
  double lag = 0.0, speed = 0.0, direction_rad = 0.0;
  [[nodiscard]] double share(double extent) const;
  // Of `frequency` cycles per resel in a direction: (1 - lag) / |1 - lag e^(2 pi i u speed)|.
  [[nodiscard]] double modulation(double direction, double frequency) const;
};

// MTF of the chain at `frequency` cycles per resel in a direction of the picture (radians from
// along to across). The chain has lens, area average of the resel, tube and video line, and on the
// screen the width of a resel and the phosphor. Stages that are off have an MTF of 1.
[[nodiscard]] double chain_modulation(const degrade::Setup& setup, double direction_rad,
                                      double frequency);

}  // namespace earthshine::studies
