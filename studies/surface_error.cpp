// SPDX-License-Identifier: Apache-2.0
#include "studies/surface_error.h"

#include <algorithm>
#include <chrono>

#include "studies/error_budget.h"
#include "studies/surface_points.h"

namespace earthshine::studies {
namespace {

constexpr std::size_t points = 8192;

}  // namespace

SurfaceError surface_error(const StudyScene& scene, const radiosity::Solution& solution,
                           const radiosity::SolveOptions& solver) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  SurfaceError error;
  error.not_captured = not_captured(scene, {});
  if (solution.columns == 0 || solution.patches.count() == 0) return error;
  const std::vector<scenes::Hit> where = spread_over_surfaces(scene.scene, points, solver.seed);
  Looks looks;
  looks.own = radiosity_at(scene.query, solution, where);
  const radiosity::SecondLooks made =
      radiosity::look_again(scene.scene, scene.groups, scene.effects, scene.query, solver, solution,
                            [&](radiosity::Look look, const radiosity::Solution& other) {
                              looks.add(look, radiosity_at(scene.query, other, where));
                            });
  error.known = std::any_of(looks.own.begin(), looks.own.end(), [](double b) { return b > 0.0; });
  error.parts = weighed_error(std::move(looks), made, solution.report.solver_error);
  error.rays = made.rays;
  error.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  return error;
}

}  // namespace earthshine::studies
