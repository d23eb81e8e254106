// SPDX-License-Identifier: Apache-2.0
// What a CCTV camera makes of a picture, up to where its signal goes through maps point by point:
// the noise-free signal with the variances that noise enters it with, and all that follows as a few
// linear filters and two point maps. With it the noise of any weighted sum of resels can be told
// (studies/sight/weighted_resels.h) without carrying the covariances of the whole picture, which is
// what degrade::twin does and what takes it fifty times as long. A still scene; fields alike.
#pragma once

#include <vector>

#include "degrade/chain.h"
#include "degrade/stage/axis_map.h"
#include "degrade/stage/point_map.h"

namespace earthshine::studies {

// One plane of the picture: luminance, or red, green or blue.
struct SignalPlane {
  degrade::Plane signal;   // S before black clamp and gain, noise-free
  degrade::Plane grain;    // variance of the light's noise where it enters, other in every frame
  degrade::Plane pattern;  // the same of what stays; empty: none
  degrade::Plane passed;   // share of that noise that saturation lets through; empty: all
  // Of S, with all noise, in a frame: what the light's and the amplifier's parts become.
  degrade::Plane grain_at_line, pattern_at_line;  // pattern_at_line is empty without a pattern
};

struct CctvSignal {
  int columns = 0, rows = 0;  // resels
  degrade::Report report;
  std::vector<double> luminance_share;  // of each plane
  std::vector<SignalPlane> planes;
  degrade::Plane level;              // luminance of the noise-free signal behind the gain
  double amplifier = 0.0;            // variance that enters before the bandwidth, a frame's
  double amplifier_pattern = 0.0;    // the same of what stays
  degrade::Plane amplifier_at_line;  // of each column: what white noise is multiplied by there
  bool has_fields = false;
  double lag_per_field = 0.0;  // correlation of the light's noise from field to field
  degrade::AxisMap blur_along, blur_across, bandwidth;  // filters of the noise
  degrade::PointMap line, screen;                       // S to line signal; S to cd/m^2
  degrade::AxisMap spread_along, spread_across;         // mean light over each resel of the screen
  double room_luminance = 0.0;
  double screen_luminance = 0.0;  // mean, noise-free, with the room's

  [[nodiscard]] std::size_t resel_count() const { return level.size(); }
};

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

// CctvSignal::spread_along and spread_across.
[[nodiscard]] degrade::PlaneMap screen_spread(const degrade::Setup& setup, int columns, int rows);

// Throws as degrade::degrade does.
[[nodiscard]] CctvSignal pass_through(const base::Image& radiance, const degrade::Setup& setup);

}  // namespace earthshine::studies
