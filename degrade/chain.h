// SPDX-License-Identifier: Apache-2.0
// The chain from radiance to what a viewer of the monitor sees: one table of stages in the order in
// which light meets the parts. A stage is a function from picture to picture; one that is off is
// not called, and what the others do does not depend on it.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "base/image.h"
#include "degrade/parts/electronics.h"
#include "degrade/parts/iris.h"
#include "degrade/parts/monitor.h"
#include "degrade/parts/noise.h"
#include "degrade/stage/axis_map.h"
#include "degrade/stage/camera.h"
#include "degrade/stage/picture.h"
#include "degrade/stage/point_map.h"

namespace earthshine::degrade {

struct Stage;

struct Options {
  std::uint64_t seed = 1;
  std::uint64_t frame = 0;
  std::uint64_t view = 0;  // another number for each camera of a run: other noise
  std::vector<std::string>
      off;               // stages left out by name, e.g. both noises for the noise-free twin
  double fov_deg = 0.0;  // vertical, of the picture; 0: not known
  // Called with the picture after each stage that ran; of an interlaced camera the first field's.
  std::function<void(const Stage& stage, const Picture&)> watch = {};
};

struct Report {
  Exposure exposure;
  NoiseLaw noise;
  Grid sensor;                          // columns and rows used
  Levels levels;                        // of the amplified signal, before white is clipped
  double white = 1.0;                   // what the screen shows of signal 1, under the room's light
  double excess_share = 0.0;            // of the signal: what lay above saturation
  double lost_share = 0.0;              // of the signal: what saturation and bloom threw away
  std::size_t negative_pixels = 0;      // of the input, taken as black
  double clipped_negative_light = 0.0;  // share of the light that a sinc spread made negative
  std::vector<std::string> stages;      // that ran, in order
};

// What a camera remembers from frame to frame.
struct Memory {
  std::optional<double> f_number;  // where the iris stood
  Picture charge;                  // what the last field left on the target; empty without lag
};

struct Result {
  int columns = 0;
  int rows = 0;
  int channels = 1;                  // 1 grey, 3 RGB
  std::vector<std::uint8_t> pixels;  // sRGB; 255 is the screen's white under the room's light
  base::Image viewed;                // what the viewer sees, cd/m^2: Y, or R, G, B
  base::Image signal;                // the line signal on the sensor's grid, 1 = white
  Report report;
  Memory memory;  // for the next frame
};

struct Setup {
  CctvCamera camera;
  Monitor monitor;
  Options options;
};

// A stage's surroundings: what the settings are, what earlier stages found out, what the camera
// remembers, and which of how many fields of the frame this is.
struct StageContext {
  const Setup& setup;
  Report& report;
  Memory& memory;
  std::uint64_t field = 0, fields = 1;
};

struct Moments;  // degrade/carry.h

// Lens: the same for both fields. Sensor: each field of a frame for itself. Monitor: the frame.
enum class Part { Lens, Sensor, Monitor };

// What a stage does to a flat or linear signal: what a measurement has to leave out. Bits.
enum class Kind : unsigned {
  Plain = 0,
  Noise = 1,    // adds it
  Uneven = 2,   // makes a flat field uneven
  Spatial = 4,  // spreads light over resels
  Limit = 8,    // ends a linear signal: saturation, black, white
  Coding = 16,  // gamma and steps
  Meter = 32    // counts saturated and black resels of the amplified signal
};
[[nodiscard]] constexpr Kind operator|(Kind a, Kind b) {
  return static_cast<Kind>(static_cast<unsigned>(a) | static_cast<unsigned>(b));
}

// What a stage does: to the picture as a whole, to each point alike, or as filters along and across
// the lines. Of the last two the moments of noise follow.
struct StageLaw {
  using OfPicture = Picture (*)(Picture&&, const StageContext&);
  using OfPoints = void (*)(PointMap&, const StageContext&);
  using OfLines = PlaneMap (*)(const Picture&, const StageContext&);
  OfPicture picture = nullptr;
  OfPoints points = nullptr;
  OfLines filter = nullptr;

  template <class Law>
  constexpr StageLaw(Law law) {  // NOLINT(google-explicit-constructor): rows of the table say it
    if constexpr (std::is_convertible_v<Law, OfPicture>) {
      picture = law;
    } else if constexpr (std::is_convertible_v<Law, OfPoints>) {
      points = law;
    } else if constexpr (std::is_convertible_v<Law, OfLines>) {
      filter = law;
    }
  }
  [[nodiscard]] Picture operator()(Picture&& in, const StageContext& at) const;
};

struct Stage {
  std::string_view name;
  Part part;
  Kind kind;
  // That decide whether it runs; those of the monitor as "monitor.NAME". None: it always does.
  std::array<std::string_view, 3> settings;
  std::string_view in, out;  // units
  std::string_view formula;
  // Report: what earlier stages found, nullptr while there is no picture yet.
  bool (*runs)(const Setup&, const Report*);
  StageLaw law;
  // What the law of a whole picture does to the moments of one with noise; without it noise passes
  // unchanged and the mean goes through the law. Stages of the lens come before any noise.
  Moments (*carry)(Moments, const StageContext&) = nullptr;
  // Where the two fields become a frame, in place of the law.
  Picture (*merge)(Picture first, const Picture& second) = nullptr;

  [[nodiscard]] constexpr bool is(Kind of) const {
    return (static_cast<unsigned>(kind) & static_cast<unsigned>(of)) != 0;
  }
};

// All stages in order.
[[nodiscard]] std::span<const Stage> stages();

// Whether the stage runs: its settings call for it, and it is not left out.
[[nodiscard]] bool runs(const Stage& stage, const Setup& setup, const Report* found);
// Whether the camera's two fields become a frame.
[[nodiscard]] bool has_fields(const Setup& setup, const Report& found);

// What the chain works on: luminance, or red, green and blue. Negative light counts as none and is
// counted. Throws base::Error (Input) for a pixel that is NaN or infinite.
[[nodiscard]] Picture sensor_input(const base::Image& radiance, bool colour,
                                   std::size_t& negative_pixels);

// Share of the signal that is left when the next picture comes: after a field of an interlaced
// camera, else after a frame, which lasts two fields.
[[nodiscard]] double lag_of(const StageContext& at);

// Which stages this camera and monitor call for, as far as it is known without a picture (an
// automatic gain may turn out to be 1).
struct StagePlan {
  const Stage* stage = nullptr;
  bool runs = false;
};
[[nodiscard]] std::vector<StagePlan> plan(const CctvCamera& camera, const Monitor& monitor,
                                          const Options& options = {});

// radiance: R, G, B or Y in cd/m^2, any size; its whole field of view goes onto the grid of
// picture_grid. Same input, settings, seed, frame, view and memory: same bytes, on any number of
// threads. before: the memory of the frame before; without it the camera has looked at this scene
// for long: its iris stands where it ends and the charge that lags is that of a still scene.
// Throws base::Error (Input) if a pixel is NaN or infinite, options.off names no stage, fall_off is
// asked for and fov_deg is not known, or `before` belongs to a picture of another shape.
[[nodiscard]] Result degrade(const base::Image& radiance, const CctvCamera& camera,
                             const Monitor& monitor, const Options& options = {},
                             const Memory& before = {});

// The same for a scene that moved between the two fields of a frame: each field of its own picture,
// of the same size; the iris follows the first. Throws base::Error (Input) also when the camera is
// not interlaced or the sizes differ.
[[nodiscard]] Result degrade_fields(const base::Image& first, const base::Image& second,
                                    const CctvCamera& camera, const Monitor& monitor,
                                    const Options& options = {}, const Memory& before = {});

}  // namespace earthshine::degrade
