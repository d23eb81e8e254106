// SPDX-License-Identifier: Apache-2.0
// What accuracy costs: one picture of the ladder with what it took, and the pictures that it is
// measured against.
//
// The truth is the path tracer's: it knows no patches, no form factors and no shared gather rays,
// has no error but noise, and that is taken off (picture_error.h). Three truths are told apart:
//   full      all light paths: what the picture should be
//   gathered  without those that a render on a solution leaves out by its design (PathSet): what
//             radiosity comes to with ever finer settings
//   straight  light from the sources alone, by Indirect::None: what distributed lights come to
// The difference of one of the latter to `full` is the method's limit, no setting's error.
//
// Every picture has the box filter, which is the path tracer's only one.
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
  std::function<bool(double patches, int rays)> fits = {};  // into memory; empty: anything does
  // Around each solve, of which nothing is kept if it is broken off; empty: nothing.
  std::function<void(const std::function<void()>& solve)> while_solving = {};
};
[[nodiscard]] AccuracyView accuracy_view(const scenes::Camera& camera, int columns, int rows,
                                         std::uint64_t seed);

// Seconds without reading the scene and building the ray query, which are the same for all. CPU
// seconds are of all threads together: on a machine that others use too they are the better
// measure.
struct StepCost {
  double wall_seconds = 0.0, cpu_seconds = 0.0;              // solve and picture
  double solve_wall_seconds = 0.0, solve_cpu_seconds = 0.0;  // the solve's share
  std::uint64_t patches = 0;
  std::uint64_t solve_rays = 0, picture_rays = 0;
  int form_factor_rays = 0, gather_rays = 0;  // per patch, per pixel
  double camera_samples = 0.0;                // per pixel, mean
  double memory_bytes = 0.0;                  // memory.h, for the patches and rows it had
  raytrace::ErrorEstimate stated;  // the error as the picture itself states it (error_budget.h)
  // CPU seconds that this took; not in the above, but of settings that were chosen by it.
  double statement_cpu_seconds = 0.0;
};
struct StepResult {
  std::vector<float> luminance;  // without light straight from the sources
  StepCost cost;
};

// The solution that several steps read, kept for the next of them.
struct SolutionShelf {
  std::optional<radiosity::SolveOptions> key;  // what the solution was made with
  radiosity::Solution solution;
  double wall_seconds = 0.0, cpu_seconds = 0.0;
};

[[nodiscard]] bool same_solver(const radiosity::SolveOptions& a, const radiosity::SolveOptions& b);
[[nodiscard]] radiosity::SolveOptions solver_of(const scenes::World& study,
                                                const AccuracyStep& step, std::uint64_t seed);
[[nodiscard]] raytrace::RenderOptions picture_of(const scenes::World& study,
                                                 const AccuracyView& view,
                                                 const AccuracyStep& step);

// None if view.stop said so meanwhile. Effects that cannot matter are left out as `render` does.
[[nodiscard]] std::optional<StepResult> run_step(const scenes::World& study,
                                                 const AccuracyView& view, const AccuracyStep& step,
                                                 SolutionShelf& shelf,
                                                 const raytrace::Progress& progress = {});

// A part of a reference: so many paths per pixel.
struct Batch {
  raytrace::PathSet paths = raytrace::PathSet::All;
  int side = 0;   // of the pair, 0 or 1
  int index = 0;  // of the side
  int paths_per_pixel = 0;
};
// Channels Y and variance, without light straight from the sources, and counts. None if view.stop
// said so.
[[nodiscard]] std::optional<base::Image> trace_batch(const scenes::World& study,
                                                     const AccuracyView& view, const Batch& batch,
                                                     const raytrace::Progress& progress = {});
// One side: the mean over batches, weighted by their paths.
[[nodiscard]] NoisyPicture mean_of_batches(const std::vector<Batch>& batches,
                                           const std::vector<base::Image>& pictures);

// How the paths per pixel and side that bring `resolution` down to `wanted` are cut into batches
// after a first one, whose paths left `found`: resolution falls with the root of the paths. At most
// `most` paths in all.
[[nodiscard]] std::vector<int> further_batches(int first_paths, double found, double wanted,
                                               int most);

// Whether the paths that a render on a solution leaves out exist at all: without mirrors and glass
// both sets are the same.
[[nodiscard]] bool leaves_paths_out(const scenes::Effects& effects);

// The two pictures of the straight truth come from the finest step of that way, other random
// numbers each.
[[nodiscard]] AccuracyStep straight_step(double error);
[[nodiscard]] std::uint64_t reference_seed(std::uint64_t seed, int side, int index);

}  // namespace earthshine::studies
