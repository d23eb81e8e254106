// SPDX-License-Identifier: Apache-2.0
#include "app/render/solution.h"

#include "app/memory.h"
#include "app/options.h"
#include "base/files/output_file.h"
#include "radiosity/store/solution_mesh.h"

namespace earthshine::app {
namespace {

radiosity::SolutionOrigin origin_of(const LoadedScene& loaded,
                                    const radiosity::SolveOptions& options) {
  return {loaded.scene, loaded.groups, options, EARTHSHINE_VERSION};
}

}  // namespace

void add_solution_option(CLI::App& command, std::string& path) {
  command
      .add_option("--solution", path, "Take the solution from this file of \"solve -o\" instead")
      ->type_name("FILE.h5");
}

radiosity::Solution solve_or_read(const LoadedScene& loaded, const scenes::RayQuery& query,
                                  const radiosity::SolveOptions& options, const std::string& path,
                                  StageTimes& times) {
  radiosity::Solution solution;
  if (path.empty()) {
    const auto fits = [&](const radiosity::Patches& patches) {
      check_patch_memory(loaded, query, options, patches.count());
    };
    solution = radiosity::solve(loaded.scene, loaded.groups, loaded.effects, query, options, fits);
    times.add(solution.report.seconds);
  } else {
    solution = times.measure("read solution", [&] {
      return radiosity::read_solution(path, origin_of(loaded, options));
    });
  }
  note_balance(solution);
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
