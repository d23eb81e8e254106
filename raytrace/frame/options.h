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

// How rays are spent on the final gather.
struct SharedGather {
  // On: gather rays start at one point per pixel and serve all of its camera samples, and
  // neighbouring points share theirs. Camera samples go where the picture is not yet as exact as
  // wanted. Off: every camera sample has gather rays of its own and every pixel equally many of
  // both: unbiased given the solution, slow, the oracle of the former.
  bool on = false;
  double smooth_share = 0.25;  // 0: neighbouring points share nothing
  double noise = 0.02;  // wanted RMS standard error from camera samples, over the mean luminance
  int least_samples = 4, most_samples = 1024;  // per pixel, powers of two
};

struct RenderOptions {
  int columns = 512;
  int rows = 512;
  Window crop;            // of the picture; without columns the whole of it
  int gather_rays = 256;  // per pixel
  SharedGather shared = {};
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
  // With SharedGather: samples of all kinds go where they help most until the picture's stated
  // error, over its mean luminance, is no more than this; 0: as many as the settings say.
  double error = 0.0;
  // The first look is as coarse as that of a picture of so many pixels; 0: of its own.
  std::size_t first_look_pixels = 0;
  // With SharedGather: goes on until these seconds have passed, however exact the picture is by
  // then, with samples of all kinds where they help most; 0: no limit. The bytes then differ
  // between runs.
  double time_limit_s = 0.0;
  // Off: the limit is one alone, and the picture is done when it is as exact as wanted.
  bool fills_time = true;
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
