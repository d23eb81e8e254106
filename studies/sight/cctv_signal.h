// SPDX-License-Identifier: Apache-2.0
// The noise-free signal of a CCTV camera, the variances of the noise where it enters, and the rest
// of the chain as linear filters and two point maps. This gives the noise of any weighted sum of
// resels (studies/sight/weighted_resels.h) without the covariances of the whole picture, which
// degrade::twin computes in fifty times the time. The scene is still, and all fields are alike.
#pragma once

#include <vector>

#include "degrade/chain.h"
#include "degrade/stage/axis_map.h"
#include "degrade/stage/point_map.h"

namespace earthshine::studies {

// One plane of the picture: luminance, or red, green or blue.
struct SignalPlane {
  degrade::Plane signal;   // S before black clamp and gain, noise-free
  degrade::Plane grain;    // variance of the light's noise where it enters, independent in every
                           // frame
  degrade::Plane pattern;  // variance of fixed-pattern noise there; empty: none
  degrade::Plane passed;   // share of that noise that passes saturation; empty: all
  // Variances of S in a frame: parts of the light's noise and of the amplifier's noise.
  degrade::Plane grain_at_line, pattern_at_line;  // pattern_at_line is empty without a pattern
};

struct CctvSignal {
  int columns = 0, rows = 0;  // resels
  degrade::Report report;
  std::vector<double> luminance_share;  // of each plane
  std::vector<SignalPlane> planes;
  degrade::Plane level;              // luminance of the noise-free signal after the gain
  double amplifier = 0.0;            // variance that enters before the bandwidth, per frame
  double amplifier_pattern = 0.0;    // variance of the fixed pattern there
  degrade::Plane amplifier_at_line;  // per column: factor of the filters on the variance of white
                                     // noise
  bool has_fields = false;
  double lag_per_field = 0.0;  // correlation of the light's noise from field to field
  degrade::AxisMap blur_along, blur_across, bandwidth;  // filters of the noise
  degrade::PointMap line, screen;                       // S to line signal; S to cd/m^2
  degrade::AxisMap spread_along, spread_across;         // mean light over each resel of the screen
  double room_luminance = 0.0;
  double screen_luminance = 0.0;  // mean, noise-free, with the room's light

  [[nodiscard]] std::size_t resel_count() const { return level.size(); }
};

// The luminances between which a CCTV camera distinguishes differences, cd/m^2: at `white` the
// amplified signal reaches 0.995, at `black` it is one standard deviation of the noise at black.
// The thresholds of degrade::Levels, traced back through gain, glare, lens and iris.
struct ShownRange {
  double black = 0.0;  // negative if glare alone lifts every pixel above the noise
  double white = 0.0;
};
// report: of degrade::degrade for a picture of this mean luminance.
[[nodiscard]] ShownRange shown_range(const degrade::CctvCamera& camera,
                                     const degrade::Report& report, double mean_luminance);

// CctvSignal::spread_along and spread_across.
[[nodiscard]] degrade::PlaneMap screen_spread(const degrade::Setup& setup, int columns, int rows);

// Throws as degrade::degrade does.
[[nodiscard]] CctvSignal pass_through(const base::Image& radiance, const degrade::Setup& setup);

}  // namespace earthshine::studies
