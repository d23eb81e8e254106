// SPDX-License-Identifier: Apache-2.0
#include "studies/accuracy/accuracy.h"

#include <chrono>

#include "base/parallel.h"
#include "radiosity/bodies/walls.h"
#include "raytrace/error_budget.h"
#include "raytrace/solve_control/wanted_error.h"
#include "scenes/effects/culling.h"
#include "scenes/effects/quality.h"
#include "studies/cost/memory.h"

namespace earthshine::studies {
namespace {

using raytrace::Indirect;

class Clock {
 public:
  [[nodiscard]] double wall() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_).count();
  }
  [[nodiscard]] double cpu() const { return base::cpu_seconds() - cpu_; }

 private:
  std::chrono::steady_clock::time_point wall_ = std::chrono::steady_clock::now();
  double cpu_ = base::cpu_seconds();
};

scenes::LightPaths paths_of(Indirect indirect) {
  switch (indirect) {
    case Indirect::Paths:
      return scenes::LightPaths::Traced;
    case Indirect::None:
      return scenes::LightPaths::Straight;
    case Indirect::Distributed:
      return scenes::LightPaths::Distributed;
    case Indirect::Radiosity:
      break;
  }
  return scenes::LightPaths::All;
}

scenes::QualityKnobs knobs_of(const scenes::Scene& scene, const AccuracyStep& step) {
  return scenes::resolve_quality(scene, step.quality);
}

// Light groups and effects as `render` has them for the step.
struct Asked {
  scenes::LightGroups groups;
  scenes::Effects effects;
  const scenes::World world;

  Asked(const scenes::World& study, const AccuracyView& view, const AccuracyStep& step)
      : groups(study.groups), world{study.scene, groups, effects, study.query} {
    scenes::Asked asked;
    asked.cameras = {&view.camera};
    asked.paths = paths_of(step.indirect);
    effects = scenes::find_effects(study.scene, groups, asked);
    if (step.indirect == Indirect::Paths) return;
    (void)scenes::cull_effects(
        study.scene, asked, step.quality.error.value_or(scenes::default_error),
        radiosity::hidden_lights(study.scene, asked.cameras), groups, effects);
  }
};

radiosity::Solution solve(const scenes::World& world, const AccuracyView& view,
                          const radiosity::SolveOptions& solver) {
  radiosity::Solution solution;
  const auto work = [&] { solution = radiosity::solve(world, solver); };
  if (view.while_solving) {
    view.while_solving(work);
  } else {
    work();
  }
  return solution;
}

void fill_shelf(SolutionShelf& shelf, const scenes::World& world, const AccuracyView& view,
                const radiosity::SolveOptions& solver) {
  if (shelf.key && same_solver(*shelf.key, solver)) return;
  shelf = {};
  const Clock clock;
  shelf.solution = solve(world, view, solver);
  shelf.wall_seconds = clock.wall();
  shelf.cpu_seconds = clock.cpu();
  shelf.key = solver;
}

double memory_of(const scenes::World& world, const radiosity::SolveOptions& solver,
                 const raytrace::RenderOptions& picture, const radiosity::Solution* solution) {
  MemoryCase sizes = memory_case(world.scene, world.groups, world.effects, solver,
                                 solution != nullptr ? solution->report.patches : 0);
  if (solution != nullptr) {
    expect_rows(sizes, world.scene, world.query, solver);
  } else {
    sizes.solves = false;
    sizes.columns = 0;
  }
  add_picture(sizes, world.groups, world.effects, picture);
  return memory_needed(sizes).total();
}

std::uint64_t solve_rays(const radiosity::SolveReport& report) {
  return report.refinement_rays + report.form_factor_rays + report.shadow_rays;
}

struct Work {
  const scenes::World& study;
  const AccuracyView& view;
  const AccuracyStep& step;
  const Asked& asked;
  const raytrace::Progress& progress;
};

// Adds a picture's luminance, cost and stated error; solution: the one that it reads, if any.
void add_picture(StepResult& result, const Work& work, const raytrace::Frame& frame,
                 const radiosity::SolveOptions& solver, const raytrace::RenderOptions& options,
                 const radiosity::Solution* solution) {
  StepCost& cost = result.cost;
  result.luminance = frame.error.luminance;
  cost.picture_rays = frame.report.rays.total();
  cost.gather_rays = frame.report.gather_rays;
  cost.camera_samples = frame.report.camera_samples;
  if (solution != nullptr) {
    cost.patches = solution->report.patches;
    cost.solve_rays = solve_rays(solution->report);
    cost.form_factor_rays = solver.form_factor_rays;
  }
  cost.memory_bytes = memory_of(work.asked.world, solver, options, solution);
  const Clock statement;
  cost.stated = raytrace::error_budget(work.asked.world, {&work.view.camera, options}, frame).total;
  cost.statement_cpu_seconds = statement.cpu();
}

// As `render` does for the step's settings.
std::optional<StepResult> run_plain(const Work& work, SolutionShelf& shelf) {
  const auto& [study, view, step, asked, progress] = work;
  const radiosity::SolveOptions solver = solver_of(study, step, view.seed);
  const raytrace::RenderOptions options = picture_of(study, view, step);
  const bool solves = step.indirect == Indirect::Radiosity && asked.effects.solution;
  const radiosity::Solution none;
  if (solves) fill_shelf(shelf, asked.world, view, solver);
  const radiosity::Solution& solution = solves ? shelf.solution : none;

  StepResult result;
  StepCost& cost = result.cost;
  const Clock clock;
  const raytrace::Frame frame =
      step.indirect == Indirect::Paths
          ? raytrace::trace_paths(asked.world, view.camera,
                                  {options.columns, options.rows, options.gather_rays, false,
                                   raytrace::PathSet::All, options.seed, options.stop},
                                  progress)
          : raytrace::render(asked.world, solution, view.camera, options, progress);
  cost.wall_seconds = clock.wall();
  cost.cpu_seconds = clock.cpu();
  if (frame.report.stopped) return std::nullopt;
  if (solves) {
    cost.solve_wall_seconds = shelf.wall_seconds;
    cost.solve_cpu_seconds = shelf.cpu_seconds;
    cost.wall_seconds += shelf.wall_seconds;
    cost.cpu_seconds += shelf.cpu_seconds;
  }
  add_picture(result, work, frame, solver, options, solves ? &solution : nullptr);
  return result;
}

// As `render --error`: adds samples where they help until the stated error is as wanted. The cost
// includes the error statements of all rounds.
std::optional<StepResult> run_steered(const Work& work) {
  const auto& [study, view, step, asked, progress] = work;
  const radiosity::SolveOptions solver =
      raytrace::picture_solver(study.scene, step.quality, view.seed);
  raytrace::RenderOptions options = picture_of(study, view, step);
  options.error = *step.quality.error;
  const Clock clock;
  StepResult result;
  StepCost& cost = result.cost;
  radiosity::Solution solution;
  if (asked.effects.solution) {
    solution = solve(asked.world, view, solver);
    cost.solve_wall_seconds = clock.wall();
    cost.solve_cpu_seconds = clock.cpu();
  }
  const raytrace::Frame frame =
      raytrace::render(asked.world, solution, view.camera, options, progress);
  cost.wall_seconds = clock.wall();
  cost.cpu_seconds = clock.cpu();
  if (frame.report.stopped) return std::nullopt;
  add_picture(result, work, frame, solver, options, asked.effects.solution ? &solution : nullptr);
  cost.statement_cpu_seconds = 0.0;  // included in cpu_seconds
  return result;
}

}  // namespace

bool same_solver(const radiosity::SolveOptions& a, const radiosity::SolveOptions& b) {
  return a.patch_edge_m == b.patch_edge_m && a.form_factor_rays == b.form_factor_rays &&
         a.tolerance == b.tolerance && a.seed == b.seed && a.flux_rays == b.flux_rays &&
         a.direct_points == b.direct_points && a.refine.on == b.refine.on &&
         a.refine.start_edge_m == b.refine.start_edge_m &&
         a.refine.max_patches == b.refine.max_patches && a.refine.error == b.refine.error;
}

AccuracyView accuracy_view(const scenes::Camera& camera, int columns, int rows,
                           std::uint64_t seed) {
  AccuracyView view{camera, columns, rows, seed, {}};
  view.camera.filter = scenes::FilterShape::Box;
  view.camera.filter_width_px = 1.0;
  return view;
}

radiosity::SolveOptions solver_of(const scenes::World& study, const AccuracyStep& step,
                                  std::uint64_t seed) {
  return radiosity::solve_options(knobs_of(study.scene, step), seed);
}

raytrace::RenderOptions picture_of(const scenes::World& study, const AccuracyView& view,
                                   const AccuracyStep& step) {
  raytrace::RenderOptions options = raytrace::render_options(knobs_of(study.scene, step));
  options.columns = view.columns;
  options.rows = view.rows;
  options.indirect = step.indirect;
  if (step.lights > 0) options.distributed_lights = step.lights;
  options.seed = view.seed;
  options.stop = view.stop;
  return options;
}

std::optional<StepResult> run_step(const scenes::World& study, const AccuracyView& view,
                                   const AccuracyStep& step, SolutionShelf& shelf,
                                   const raytrace::Progress& progress) {
  const Asked asked(study, view, step);
  return step.steered() ? run_steered({study, view, step, asked, progress})
                        : run_plain({study, view, step, asked, progress}, shelf);
}

}  // namespace earthshine::studies
