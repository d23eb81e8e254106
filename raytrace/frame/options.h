// SPDX-License-Identifier: Apache-2.0
// Options of a picture.
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
  None,         // direct light only
  Paths         // the reference: trace_paths (path_tracer.h) instead of render()
};

// Of Indirect::Paths.
enum class PathSet {
  All,
  NoCaustics  // as in render(): of light by mirrors and glass onto other surfaces, only the light
              // that shadow rays (flat mirrors, straight glass) and gather rays find
};

struct RenderOptions {
  int columns = 512;
  int rows = 512;
  Window crop;  // of the picture; without columns, the whole picture
  // Rays per gather point, rounded down to a power of two; only without has_rounds().
  int gather_rays = 32;
  int camera_samples = 16;  // per pixel
  bool denoise = true;      // shares samples of gather points on the same surface
  Indirect indirect = Indirect::Radiosity;
  PathSet paths = PathSet::All;
  int distributed_lights = 64;  // N of Indirect::Distributed
  // Edge, in pixels, of the square that a gather point in its middle serves; 1 if columns or rows
  // are no multiple of it.
  int gather_step = 1;
  std::string distributed_over;  // the [[area]] with the Earth's N lights; empty: its disc
  bool per_light = false;
  // With per_light: pixels, ascending, of the regions in Frame::regions.
  std::vector<std::vector<std::uint32_t>> regions;
  // With per_light and an `error`, and without a crop: weights of the layers' luminance in the sums
  // that must have the error, in place of the sum of all layers. Sums far above it (tuning.h) get
  // no samples of their own.
  std::vector<std::vector<double>> sums;
  std::vector<std::string> aovs;  // of aov_names()
  std::uint64_t seed = 1;
  // Adds samples of all kinds where they help most until the stated error, over the mean luminance,
  // is at most this; 0: no wanted error.
  double error = 0.0;
  // Takes initial samples as for a picture with this many pixels; 0: its own number.
  std::size_t initial_sampling_pixels = 0;
  // Ends the picture after these seconds, and without an `error` not earlier; 0: no limit. The
  // bytes then differ between runs.
  double time_limit_s = 0.0;
  // Whether samples follow the stated error, until an error or a time is reached; otherwise their
  // numbers are fixed.
  [[nodiscard]] bool has_rounds() const { return error > 0.0 || time_limit_s > 0.0; }
  // Called often, by many threads; if it returns true, the unfinished frame is returned.
  std::function<bool()> stop = {};
};

// The part of the picture to draw. Throws base::Error (Input) if the crop leaves the picture.
[[nodiscard]] Window window_of(const RenderOptions& options);

// Options from the quality settings; the size, the seed and the others keep their defaults.
[[nodiscard]] RenderOptions render_options(const scenes::QualityKnobs& knobs);

[[nodiscard]] const std::vector<std::string>& aov_names();  // as in frame.h

// Gets the finished share of the expected work; called by one thread at a time.
using Progress = std::function<void(std::size_t done, std::size_t total)>;
// Called with the name of each stage at its beginning; returns the listener for its progress, which
// may be empty.
using StageListener = std::function<Progress(const std::string& stage)>;

}  // namespace earthshine::raytrace
