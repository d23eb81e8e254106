// SPDX-License-Identifier: Apache-2.0
// The chain from radiance to what a viewer of the monitor sees: one table of stages in the order in
// which light meets the parts. A stage is a function from picture to picture; one that is off is
// not called, and what the others do does not depend on it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/image.h"
#include "degrade/camera.h"
#include "degrade/electronics.h"
#include "degrade/iris.h"
#include "degrade/monitor.h"
#include "degrade/noise.h"
#include "degrade/picture.h"

namespace earthshine::degrade {

struct Options {
  std::uint64_t seed = 1;
  std::uint64_t frame = 0;
  std::uint64_t view = 0;  // another number for each camera of a run: other noise
  std::vector<std::string>
      off;  // stages left out by name, e.g. both noises for the noise-free twin
};

struct Report {
  Exposure exposure;
  NoiseLaw noise;
  Grid sensor;                          // columns and rows used
  Levels levels;                        // of the amplified signal, before white is clipped
  std::size_t negative_pixels = 0;      // of the input, taken as black
  double clipped_negative_light = 0.0;  // share of the light that a sinc spread made negative
  std::vector<std::string> stages;      // that ran, in order
};

struct Result {
  int columns = 0;
  int rows = 0;
  int channels = 1;                  // 1 grey, 3 RGB
  std::vector<std::uint8_t> pixels;  // sRGB; 255 is the screen's white under the room's light
  base::Image viewed;                // what the viewer sees, cd/m^2: Y, or R, G, B
  base::Image signal;                // the line signal on the sensor's grid, 1 = white
  Report report;
};

struct Setup {
  CctvCamera camera;
  Monitor monitor;
  Options options;
};

// A picture on its way, and what the stages found out.
struct Frame {
  Picture picture;
  Report report;
};

enum class Part { Camera, Monitor };

struct Stage {
  std::string_view name;
  Part part;
  std::string_view in, out;  // units
  std::string_view law;
  // Report: what earlier stages found, nullptr while there is no picture yet.
  bool (*runs)(const Setup&, const Report*);
  Frame (*apply)(Frame, const Setup&);
};

// All stages in order.
[[nodiscard]] std::span<const Stage> stages();

// Which stages this camera and monitor call for, as far as it is known without a picture (an
// automatic gain may turn out to be 1).
struct StagePlan {
  const Stage* stage = nullptr;
  bool runs = false;
};
[[nodiscard]] std::vector<StagePlan> plan(const CctvCamera& camera, const Monitor& monitor,
                                          const Options& options = {});

// radiance: R, G, B or Y in cd/m^2, any size; its whole field of view goes onto the grid of
// picture_grid. Same input, settings, seed, frame and view: same bytes, on any number of threads.
// Throws base::Error (Input) if a pixel is NaN or infinite, or options.off names no stage.
[[nodiscard]] Result degrade(const base::Image& radiance, const CctvCamera& camera,
                             const Monitor& monitor, const Options& options = {});

}  // namespace earthshine::degrade
