// SPDX-License-Identifier: Apache-2.0
// Measures the cost of accuracy: one picture of the ladder with its cost, and the reference
// pictures.
//
// The reference is the path tracer: it has no patches, no form factors and no shared gather rays.
// Its only error is noise, which is subtracted (picture_error.h). There are three references.
//   full      all light paths: the correct picture
//   gathered  without the paths that a render on a solution omits by design (PathSet): the limit of
//             radiosity with ever finer settings
//   straight  direct light only, by Indirect::None: the limit of distributed lights
// The difference of the second or third to `full` is the method's limit, independent of settings.
//
// Every picture has the box filter, the only one of the path tracer.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "raytrace/frame/error_estimate.h"
#include "raytrace/paths/path_tracer.h"
#include "raytrace/render.h"
#include "studies/accuracy/ladder.h"
#include "studies/picture_error.h"

namespace earthshine::studies {

struct AccuracyView {
  scenes::Camera camera;  // with the box filter
  int columns = 0, rows = 0;
  std::uint64_t seed = 1;
  std::function<bool()> stop = {};
  std::function<bool(double patches, int rays)> fits = {};  // into memory; empty: always
  // Wraps each solve, whose result is discarded if it is interrupted; empty: no wrapper.
  std::function<void(const std::function<void()>& solve)> while_solving = {};
};
[[nodiscard]] AccuracyView accuracy_view(const scenes::Camera& camera, int columns, int rows,
                                         std::uint64_t seed);

// Seconds without reading the scene and building the ray query, which all steps share. CPU seconds
// are the sum over threads; on a machine with other load they are the better measure.
struct StepCost {
  double wall_seconds = 0.0, cpu_seconds = 0.0;              // solve and picture
  double solve_wall_seconds = 0.0, solve_cpu_seconds = 0.0;  // the solve's part
  std::uint64_t patches = 0;
  std::uint64_t solve_rays = 0, picture_rays = 0;
  int form_factor_rays = 0, gather_rays = 0;  // per patch, per pixel
  double camera_samples = 0.0;                // per pixel, mean
  double memory_bytes = 0.0;                  // memory.h, for its patches and rows
  raytrace::ErrorEstimate stated;             // the picture's stated error (error_budget.h)
  // CPU seconds of the statement; not included above, except for settings that depend on it.
  double statement_cpu_seconds = 0.0;
};
struct StepResult {
  std::vector<float> luminance;  // without light straight from the sources
  StepCost cost;
};

// The solution of the last step, for following steps with the same solver.
struct SolutionShelf {
  std::optional<radiosity::SolveOptions> key;  // the solution's options
  radiosity::Solution solution;
  double wall_seconds = 0.0, cpu_seconds = 0.0;
};

[[nodiscard]] bool same_solver(const radiosity::SolveOptions& a, const radiosity::SolveOptions& b);
[[nodiscard]] radiosity::SolveOptions solver_of(const scenes::World& study,
                                                const AccuracyStep& step, std::uint64_t seed);
[[nodiscard]] raytrace::RenderOptions picture_of(const scenes::World& study,
                                                 const AccuracyView& view,
                                                 const AccuracyStep& step);

// Empty if view.stop interrupted it. Omits effects without influence, as `render` does.
[[nodiscard]] std::optional<StepResult> run_step(const scenes::World& study,
                                                 const AccuracyView& view, const AccuracyStep& step,
                                                 SolutionShelf& shelf,
                                                 const raytrace::Progress& progress = {});

// A part of a reference.
struct Batch {
  raytrace::PathSet paths = raytrace::PathSet::All;
  int side = 0;   // of the pair, 0 or 1
  int index = 0;  // of the side
  int paths_per_pixel = 0;
};
// Channels Y and variance, without light straight from the sources, and counts. Empty if view.stop
// interrupted it.
[[nodiscard]] std::optional<base::Image> trace_batch(const scenes::World& study,
                                                     const AccuracyView& view, const Batch& batch,
                                                     const raytrace::Progress& progress = {});
// One side: the mean over batches, weighted by their paths.
[[nodiscard]] NoisyPicture mean_of_batches(const std::vector<Batch>& batches,
                                           const std::vector<base::Image>& pictures);

// Divides the paths per pixel and side that improve `resolution` to `wanted` into batches. The
// first batch had the resolution `found`, which improves with the root of the paths. At most `most`
// paths in all.
[[nodiscard]] std::vector<int> further_batches(int first_paths, double found, double wanted,
                                               int most);

// Whether the scene has paths that a render on a solution omits: without mirrors and glass both
// sets are the same.
[[nodiscard]] bool leaves_paths_out(const scenes::Effects& effects);

// The two pictures of the straight reference are the finest step with direct light, with different
// random numbers.
[[nodiscard]] AccuracyStep straight_step(double error);
[[nodiscard]] std::uint64_t reference_seed(std::uint64_t seed, int side, int index);

}  // namespace earthshine::studies
