// SPDX-License-Identifier: Apache-2.0
// The chain from radiance to the picture on the monitor: a table of stages in the order of the
// light path. A stage maps a picture to a picture. Stages that are off are skipped; the other
// stages do not depend on them.
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
  std::uint64_t view = 0;  // of the camera in a run; gives each camera different noise
  std::vector<std::string>
      off;               // names of stages to skip, e.g. both noises for the noise-free twin
  double fov_deg = 0.0;  // vertical, of the picture; 0: unknown
  // Called with the picture after each stage that ran; for interlaced cameras, of the first field.
  std::function<void(const Stage& stage, const Picture&)> watch = {};
};

struct Report {
  Exposure exposure;
  NoiseLaw noise;
  Grid sensor;                          // columns and rows used
  Levels levels;                        // of the amplified signal, before white is clipped
  double white = 1.0;                   // luminance of signal 1 with room light, cd/m^2
  double excess_share = 0.0;            // share of the signal above saturation
  double lost_share = 0.0;              // share of the signal lost by saturation and bloom
  std::size_t negative_pixels = 0;      // of the input, replaced by black
  double clipped_negative_light = 0.0;  // share of negative light after a sinc spread
  std::vector<std::string> stages;      // that ran, in order
};

// State of a camera between frames.
struct Memory {
  std::optional<double> f_number;  // of the iris
  Picture charge;                  // left on the target by the last field; empty without lag
};

struct Result {
  int columns = 0;
  int rows = 0;
  int channels = 1;                  // 1 grey, 3 RGB
  std::vector<std::uint8_t> pixels;  // sRGB; 255 is the screen's white under the room's light
  base::Image viewed;                // luminance of the screen, cd/m^2: Y, or R, G, B
  base::Image signal;                // the line signal on the sensor's grid, 1 = white
  Report report;
  Memory memory;  // for the next frame
};

struct Setup {
  CctvCamera camera;
  Monitor monitor;
  Options options;
};

// Context of a stage: settings, results of earlier stages, state of the camera, and the number of
// this field in the frame.
struct StageContext {
  const Setup& setup;
  Report& report;
  Memory& memory;
  std::uint64_t field = 0, fields = 1;
};

struct Moments;  // degrade/carry.h

// Lens: once for both fields. Sensor: for each field. Monitor: for the frame.
enum class Part { Lens, Sensor, Monitor };

// Effects of a stage on a flat or linear signal, so that measurements can switch it off. Bit flags.
enum class Kind : unsigned {
  Plain = 0,
  Noise = 1,    // adds noise
  Uneven = 2,   // makes a flat field uneven
  Spatial = 4,  // spreads light over resels
  Limit = 8,    // limits a linear signal: saturation, black, white
  Coding = 16,  // gamma and quantisation
  Meter = 32    // counts saturated and black resels of the amplified signal
};
[[nodiscard]] constexpr Kind operator|(Kind a, Kind b) {
  return static_cast<Kind>(static_cast<unsigned>(a) | static_cast<unsigned>(b));
}

// Law of a stage: a function of the whole picture, a point map, or filters along and across the
// lines. For the last two the moments of noise follow from the law.
struct StageLaw {
  using OfPicture = Picture (*)(Picture&&, const StageContext&);
  using OfPoints = void (*)(PointMap&, const StageContext&);
  using OfLines = PlaneMap (*)(const Picture&, const StageContext&);
  OfPicture picture = nullptr;
  OfPoints points = nullptr;
  OfLines filter = nullptr;

  template <class Law>
  constexpr StageLaw(Law law) {  // NOLINT(google-explicit-constructor): implicit, for the rows of
                                 // the table
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
  // Settings that decide whether the stage runs; settings of the monitor as "monitor.NAME". Empty:
  // always.
  std::array<std::string_view, 3> settings;
  std::string_view in, out;  // units
  std::string_view formula;
  // Report: results of earlier stages; nullptr while there is no picture.
  bool (*runs)(const Setup&, const Report*);
  StageLaw law;
  // Moments after a law of the whole picture. By default noise passes unchanged and the mean passes
  // through the law. Stages of the lens precede all noise.
  Moments (*carry)(Moments, const StageContext&) = nullptr;
  // Merges two fields into a frame, instead of the law.
  Picture (*merge)(Picture first, const Picture& second) = nullptr;

  [[nodiscard]] constexpr bool is(Kind of) const {
    return (static_cast<unsigned>(kind) & static_cast<unsigned>(of)) != 0;
  }
};

// All stages in order.
[[nodiscard]] std::span<const Stage> stages();

// Whether the stage runs: its settings require it, and it is not switched off.
[[nodiscard]] bool runs(const Stage& stage, const Setup& setup, const Report* found);
// Whether the camera merges two fields into a frame.
[[nodiscard]] bool has_fields(const Setup& setup, const Report& found);

// Input of the chain: luminance, or red, green and blue. Negative values become 0 and are counted.
// Throws base::Error (Input) for a NaN or infinite pixel.
[[nodiscard]] Picture sensor_input(const base::Image& radiance, bool colour,
                                   std::size_t& negative_pixels);

// Share of the signal that remains in the next picture: after one field of an interlaced camera,
// else after one frame, which lasts two fields.
[[nodiscard]] double lag_of(const StageContext& at);

// The screen's bytes on another grid: means of the linear signal over its pixels.
void resize_screen(Result& result, int columns, int rows);

// Stages that run for this camera and monitor, as far as known without a picture: an automatic gain
// may be 1.
struct StagePlan {
  const Stage* stage = nullptr;
  bool runs = false;
};
[[nodiscard]] std::vector<StagePlan> plan(const CctvCamera& camera, const Monitor& monitor,
                                          const Options& options = {});

// radiance: R, G, B or Y in cd/m^2, of any size; its whole field of view is mapped onto the grid of
// picture_grid. Equal input, settings, seed, frame, view and memory give equal bytes on any number
// of threads.
// before: memory of the previous frame. Without it the scene is taken as still for a long time: the
// iris is in its steady state, and the lag has settled.
// Throws base::Error (Input) if a pixel is NaN or infinite, options.off names no stage, fall_off is
// set but fov_deg is unknown, or `before` belongs to a picture of another shape.
[[nodiscard]] Result degrade(const base::Image& radiance, const CctvCamera& camera,
                             const Monitor& monitor, const Options& options = {},
                             const Memory& before = {});

// The same for a scene that moves between the two fields of a frame: one picture per field, of
// equal size. The iris meters the first one. Also throws base::Error (Input) if the camera is not
// interlaced or the sizes differ.
[[nodiscard]] Result degrade_fields(const base::Image& first, const base::Image& second,
                                    const CctvCamera& camera, const Monitor& monitor,
                                    const Options& options = {}, const Memory& before = {});

}  // namespace earthshine::degrade
