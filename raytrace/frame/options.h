// SPDX-License-Identifier: Apache-2.0
// What a picture is asked to be, and how its rays are spent.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "raytrace/camera/camera.h"
#include "scenes/effects/quality.h"

namespace earthshine::raytrace {

enum class Indirect {
  Radiosity,    // final gather on the solution
  Distributed,  // the 1990 report's approximation: the Earth and area lamps as N lights, no
                // interreflection
  None,         // direct light alone
  Paths         // the reference: trace_paths (path_tracer.h) instead of render()
};

// Of Indirect::Paths.
enum class PathSet {
  All,
  NoCaustics  // as render() has them: of what mirrors and glass throw onto other surfaces, what
              // shadow rays bring (flat mirrors, straight glass) and what gather rays meet
};

struct RenderOptions {
  int columns = 512;
  int rows = 512;
  Window crop;  // of the picture; without columns the whole of it
  // Per gather point and pixel, rounded down to powers of two; only where has_rounds() is false.
  // Paths of Indirect::Paths per pixel.
  int gather_rays = 32;
  int camera_samples = 16;  // per pixel
  bool denoise = true;      // gather points with their neighbours on the same surface
  Indirect indirect = Indirect::Radiosity;
  PathSet paths = PathSet::All;
  int distributed_lights = 64;  // N of Indirect::Distributed
  // Pixels along the edge of the square that a gather point serves, in the middle of which it lies;
  // 1 where columns or rows are no multiple of it.
  int gather_step = 1;
  std::string distributed_over;  // the [[area]] that the Earth's N lights lie on; empty: its disc
  bool per_light = false;
  // With per_light: pixels, ascending, over whose means Frame::regions knows the layers' noise.
  std::vector<std::vector<std::uint32_t>> regions;
  std::vector<std::string> aovs;  // of aov_names()
  std::uint64_t seed = 1;
  // Samples of all kinds go where they help most until the picture's stated error, over its mean
  // luminance, is no more than this; 0: no error is wanted.
  double error = 0.0;
  // The initial samples are those of a picture of so many pixels; 0: of its own.
  std::size_t initial_sampling_pixels = 0;
  // The picture ends after these seconds, and without an `error` not before; 0: no limit. The bytes
  // then differ between runs.
  double time_limit_s = 0.0;
  // Whether samples follow the stated error, to an error or a time; else their numbers are fixed.
  [[nodiscard]] bool has_rounds() const { return error > 0.0 || time_limit_s > 0.0; }
  // Asked often, from many threads; once it says true the frame is returned with what is finished.
  std::function<bool()> stop = {};
};

// What is drawn. Throws base::Error (Input) if the crop leaves the picture.
[[nodiscard]] Window window_of(const RenderOptions& options);

// The knobs' part of the options; the size, the seed and the rest stay at their defaults.
[[nodiscard]] RenderOptions render_options(const scenes::QualityKnobs& knobs);

[[nodiscard]] const std::vector<std::string>& aov_names();  // as in frame.h

// Told how much of the expected work is done; called from one thread at a time.
using Progress = std::function<void(std::size_t done, std::size_t total)>;
// Told the name of each stage as it begins; gives the listener for its progress, which may be
// empty.
using StageListener = std::function<Progress(const std::string& stage)>;

}  // namespace earthshine::raytrace
