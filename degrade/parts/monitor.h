// SPDX-License-Identifier: Apache-2.0
// Settings and stages of the monitor: drive to light, phosphor spread, room light (docs/cctv.md).
//   v       line signal, 0 black, 1 white
//   I       luminance of the screen, cd/m^2
//   resel   picture element of the monitor: square, 300 rows x 400 columns fill a 4:3 screen
#pragma once

#include <array>
#include <string_view>

#include "degrade/stage/axis_map.h"
#include "degrade/stage/fields.h"
#include "degrade/stage/picture.h"

namespace earthshine::degrade {

enum class Spread { None, Gaussian, Triangle, Sinc };
[[nodiscard]] constexpr std::array<std::string_view, 4> words_of(Spread) {
  return {"none", "gaussian", "triangle", "sinc"};
}

struct Monitor {
  int rows = 300;
  int columns = 400;
  int pixels_per_resel = 3;
  Spread spread = Spread::Gaussian;
  double spread_width = 1.0;
  double gamma = 2.2;
  double white_luminance = 100.0;
  double black_luminance = 1.0;
  double room_illuminance = 50.0;
  double reflectance = 0.05;
};

template <class AnyMonitor, class Visitor>
void visit_monitor_fields(AnyMonitor& m, Visitor&& field) {
  field("rows", m.rows, Limits{1.0, 2000.0}, "resel", "picture elements from top to bottom");
  field("columns", m.columns, Limits{1.0, 2000.0}, "resel", "picture elements from side to side");
  field("pixels_per_resel", m.pixels_per_resel, Limits{1.0, 8.0}, "px", "of the picture written");
  field("spread", m.spread, no_limits, "", "shape of a point on the phosphor");
  field(
      "spread_width", m.spread_width, Limits{0.05, 10.0}, "resel",
      "gaussian: full width at half maximum; triangle: the same; sinc: from centre to first zero");
  field("gamma", m.gamma, Limits{0.2, 5.0}, "1", "light = v^gamma");
  field("white_luminance", m.white_luminance, Limits{1e-3, 1e5}, "cd/m^2", "of v = 1");
  field("black_luminance", m.black_luminance, Limits{0.0, 1e5}, "cd/m^2", "of v = 0");
  field("room_illuminance", m.room_illuminance, Limits{0.0, 1e6}, "lx", "on the screen");
  field("reflectance", m.reflectance, Limits{0.0, 1.0}, "1", "of the screen");
}

// Whether a field has an effect on this monitor.
[[nodiscard]] bool is_used(const Monitor& monitor, std::string_view field);

// Part of the screen that a picture of width x height covers: the whole height if it is not wider
// than the screen (columns = rows * width / height), else the whole width. Resels are square;
// nothing is cropped.
struct Grid {
  int columns = 0;
  int rows = 0;
};
[[nodiscard]] Grid picture_grid(int width, int height, const Monitor& monitor);

// Integral of the point spread from -infinity to x (resels), from 0 to 1. Not monotone for the
// sinc, which is windowed (Lanczos, 8 zeros).
[[nodiscard]] double spread_integral(Spread spread, double width, double x);

// Maps a line of `resels` values to `pixels_per_resel` samples each. The light of a resel is
// constant over its width, spread by the phosphor and sampled at the centres of the pixels. Row
// sums are 1.
[[nodiscard]] AxisMap spread_map(Spread spread, double width, int resels, int pixels_per_resel);

// Spreads light, on the finer grid of pixels. Applied after gamma, because light is additive.
// Negative light (sinc) is clipped; `negative_share` is its ratio to all light.
[[nodiscard]] Picture spread_on_screen(const Picture& light, const Monitor& monitor,
                                       double& negative_share);
// Luminance added by the room, cd/m^2: reflectance * illuminance / pi.
[[nodiscard]] double room_luminance(const Monitor& monitor);
[[nodiscard]] Picture add_light(Picture light, double veil);

}  // namespace earthshine::degrade
