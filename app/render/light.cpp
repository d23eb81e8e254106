// SPDX-License-Identifier: Apache-2.0
#include "app/render/light.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "app/call/memory.h"
#include "app/console.h"
#include "app/options.h"
#include "base/files/output_file.h"
#include "base/parallel.h"
#include "radiosity/store/solution_mesh.h"
#include "raytrace/solve_control/reach_surfaces.h"
#include "raytrace/solve_control/wanted_error.h"

namespace earthshine::app {
namespace {

// Stopped by the time limit of the whole command, or by a stop request.
Solved solve_in_time(const LightCall& wanted, const radiosity::SolveOptions& solver,
                     StageTimes& times) {
  const double before = times.total(), limit = wanted.call.time_limit_s;
  const auto start = std::chrono::steady_clock::now();
  const auto gone = [start] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  Solved light;
  light.solver = solver;
  try {
    const base::StopInForce stop(
        [&] { return (wanted.stop && wanted.stop()) || (limit > 0.0 && before + gone() > limit); });
    light.solution = solve_or_read(wanted.loaded, wanted.query, solver, "", wanted.common, times);
    light.solved = true;
  } catch (const base::Stopped&) {
    times.add({{"solve, broken off", gone()}});
    light.solution = radiosity::unsolved(wanted.loaded.groups);
    light.broken_off = true;
  }
  return light;
}

// Within a time limit the solve gets about a fifth of the time: a coarse solve measures the speed.
// Patches and rays are each inversely proportional to their error.
Solved solve_within(const LightCall& wanted, double seconds, StageTimes& times) {
  constexpr double coarse = 0.2, share = 0.2, worthwhile = 0.5;
  scenes::Quality quality = wanted.loaded.scene.quality;
  const double finest = quality.error.value_or(scenes::default_error);
  const auto solve = [&](double error) {
    quality.error = error;
    return solve_in_time(
        wanted, raytrace::picture_solver(wanted.loaded.scene, quality, wanted.common.seed), times);
  };
  const double before = times.total();
  Solved light = solve(std::max(coarse, finest));
  const double taken = std::max(1e-3, times.total() - before);
  const double error = std::max(finest, coarse * std::sqrt(taken / (share * seconds)));
  if (light.broken_off || error >= worthwhile * coarse) return light;
  Solved finer = solve(error);
  return finer.broken_off ? std::move(light) : std::move(finer);
}

bool says_how_to_solve(const scenes::Quality& quality) {
  return quality.patch_edge_m || quality.max_patches || quality.form_factor_rays;
}

Solved solve_or_take(const LightCall& wanted, StageTimes& times) {
  const RenderCall& call = wanted.call;
  const LoadedScene& loaded = wanted.loaded;
  Solved light;
  light.solver = solver_of(call, loaded.scene, wanted.common);
  if (call.indirect != raytrace::Indirect::Radiosity) return light;
  if (!loaded.effects.solution && call.solution.empty()) return light;
  if (call.time_limit_s > 0.0 && call.solution.empty() &&
      !says_how_to_solve(loaded.scene.quality)) {
    return solve_within(wanted, call.time_limit_s, times);
  }
  const auto solve = [&] {
    return solve_or_read(loaded, wanted.query, light.solver, call.solution, wanted.common, times);
  };
  if (!wanted.share && call.solution.empty()) return solve_in_time(wanted, light.solver, times);
  light.solution = wanted.share && call.solution.empty() ? wanted.share(solve) : solve();
  light.solved = true;
  return light;
}

radiosity::SolutionOrigin origin_of(const LoadedScene& loaded,
                                    const radiosity::SolveOptions& options) {
  return {loaded.scene, loaded.groups, options, EARTHSHINE_VERSION};
}

}  // namespace

radiosity::SolveOptions solver_of(const RenderCall& call, const scenes::Scene& scene,
                                  const Common& common) {
  // A solution from a file keeps the settings of its solve.
  if (!call.solution.empty() || !steers(call, scene)) return solve_options(scene, common);
  return raytrace::picture_solver(scene, scene.quality, common.seed);
}

Solved solve_as_exactly(const ExactCall& call, StageTimes& times) {
  const LoadedScene& loaded = call.loaded;
  const scenes::World scene = loaded.world(call.query);
  const auto start = std::chrono::steady_clock::now();
  const double triangles = static_cast<double>(loaded.scene.triangles.size());
  call.common.progress->expect(Work::Surfaces, triangles);
  if (call.time_limit_s > 0.0) call.common.progress->end_within(call.time_limit_s);
  const Progress::Listener passes = call.common.progress->begin("solve", Work::Surfaces, triangles);
  double in_stages = 0.0;
  raytrace::Wanted wanted = wanted_error(loaded, call.common, call.time_limit_s, times);
  wanted.stop = Interrupt::asked;
  std::optional<Interrupt> interrupt;  // before the first solve there is no partial result
  const raytrace::SolveListener listen = [&](const radiosity::SolveReport& report) {
    if (!interrupt) interrupt.emplace();
    times.add(report.seconds);
    for (const auto& [stage, seconds] : report.seconds) in_stages += seconds;
  };
  raytrace::SteeredSolution found = raytrace::reach_surfaces(
      scene, wanted, call.common.seed, listen, [&](const std::string& stage) -> raytrace::Progress {
        call.common.progress->relabel(stage);
        return passes;
      });
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  times.add({{"residual", std::max(0.0, taken.count() - in_stages)}});
  note_balance(found.solution);
  Solved light;
  light.solution = std::move(found.solution);
  light.solver = found.solver;
  light.solved = light.steered = true;
  light.surface = std::move(found.surface);
  light.steps = std::move(found.steps);
  light.limit = found.limit;
  return light;
}

bool steers(const RenderCall& call, const scenes::Scene& scene) {
  return scene.quality.error && !call.no_error && call.indirect != raytrace::Indirect::Paths;
}

void want_usual_error(const RenderCall& call, scenes::Scene& scene) {
  constexpr double usual_error = 0.05;
  const scenes::Quality& given = scene.quality;
  const bool is_said = given.error || given.gather_rays || given.camera_samples || given.denoise ||
                       call.no_error || call.time_limit_s > 0.0 || !call.solution.empty() ||
                       call.part.in_parts() || call.indirect == raytrace::Indirect::Paths;
  if (!is_said) scene.quality.error = usual_error;
}

raytrace::Wanted wanted_error(const LoadedScene& loaded, const Common& common, double time_limit_s,
                              const StageTimes& times) {
  raytrace::Wanted wanted;
  wanted.error = loaded.scene.quality.error.value_or(wanted.error);
  wanted.seconds = time_limit_s;
  const double before = times.total();
  const auto start = std::chrono::steady_clock::now();
  wanted.now = [before, start] {
    const std::chrono::duration<double> gone = std::chrono::steady_clock::now() - start;
    return before + gone.count();
  };
  wanted.fits = [&loaded, &common](double patches, int rays) {
    radiosity::SolveOptions options = solve_options(loaded.scene, common);
    options.form_factor_rays = rays;
    return patches_fit(loaded, options, static_cast<std::size_t>(patches), true);
  };
  return wanted;
}

Solved find_light(const LightCall& wanted, StageTimes& times) {
  Solved light = solve_or_take(wanted, times);
  if (light.solved && !wanted.common.quiet) {
    note_backs(light.solution.report);
    note_lost_flux(light.solution.report);
  }
  if (light.broken_off && !wanted.common.quiet) {
    note("note: the solve was broken off: the picture finds light between surfaces by paths alone");
  }
  return light;
}

void note_lost_flux(const radiosity::SolveReport& report) {
  constexpr double least = 1e-6;
  for (const radiosity::GroupLedger& group : report.groups) {
    const double given = base::luminance(group.given_lm);
    const double found = base::luminance(group.landed_lm + group.emitted_lm +
                                         group.escaped_at_once_lm + group.lost_at_once_lm);
    if (std::abs(given - found) <= least * given) continue;
    note(fmt::format(
        "warning: light group \"{}\" gives {:.6g} lm, and samples found {:.6g} lm: it shines "
        "where no point of a patch is. Lower quality.patch_edge or raise "
        "quality.max_patches",
        group.name, given, found));
  }
}

void add_solution_option(CLI::App& command, std::string& path) {
  command
      .add_option("--solution", path, "Take the solution from this file of \"solve -o\" instead")
      ->type_name("FILE.h5");
}

radiosity::Solution solve_or_read(const LoadedScene& loaded, const scenes::RayQuery& query,
                                  const radiosity::SolveOptions& options, const std::string& path,
                                  const Common& common, StageTimes& times) {
  radiosity::Solution solution;
  if (path.empty()) {
    (void)common.progress->begin("solve", Work::Solve,
                                 static_cast<double>(loaded.scene.triangles.size()));
    const auto fits = [&](const radiosity::Patches& patches) {
      check_patch_memory(loaded, query, options, patches.count());
    };
    solution = radiosity::solve(loaded.world(query), options, fits);
    times.add(solution.report.seconds);
  } else {
    std::vector<std::string> others;
    solution = times.measure("read solution", [&] {
      radiosity::SolutionOrigin origin = origin_of(loaded, options);
      origin.other_settings = &others;
      return radiosity::read_solution(path, origin);
    });
    if (!others.empty() && !common.quiet) {
      note(fmt::format("note: {} was solved with other settings: {}", path,
                       fmt::join(others, ", ")));
    }
  }
  note_balance(solution, options.balance);
  return solution;
}

void write_solution(const std::string& path, const radiosity::Solution& solution,
                    const LoadedScene& loaded, const radiosity::SolveOptions& options) {
  radiosity::write_solution(path, solution, origin_of(loaded, options));
}

void write_mesh(const std::string& path, const radiosity::Solution& solution,
                const LoadedScene& loaded) {
  const radiosity::SolutionMesh mesh = radiosity::solution_mesh(loaded.scene, solution);
  const std::vector<scenes::GltfNote> notes = {{"radiosity_lm_m2_per_unit", mesh.lm_m2_per_unit},
                                               {"clipped_area_share", mesh.clipped_share},
                                               {"scene", loaded.scene.path.string()},
                                               {"program", "earthshine " EARTHSHINE_VERSION}};
  base::write_text(path, scenes::make_glb(loaded.scene.name, mesh.parts, notes));
}

}  // namespace earthshine::app
