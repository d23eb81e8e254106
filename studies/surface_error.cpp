// SPDX-License-Identifier: Apache-2.0
#include "studies/surface_error.h"

#include <chrono>
#include <cmath>

#include "base/random.h"
#include "studies/error_budget.h"
#include "studies/pixel_choice.h"

namespace earthshine::studies {
namespace {

constexpr std::size_t points = 8192;

struct SurfacePoint {
  std::uint32_t facet;
  bool front;
  radiosity::Parameters where;
};

// Spread over the surfaces by area. Of a triangle's cells, which are trapezoids, by their
// parameters within the cell.
std::vector<SurfacePoint> spread_points(const radiosity::Patches& patches, std::uint64_t seed) {
  const auto chosen = spread_by_weight(patches.area_m2, points, seed);
  std::vector<SurfacePoint> spread;
  base::Rng rng(base::Key(seed, base::Stream::ErrorBudget, 2));
  for (const std::size_t k : chosen) {
    const auto patch = static_cast<std::uint32_t>(k);
    const radiosity::Rectangle cell = patches.rectangle(patch);
    const double x = rng.next(), y = rng.next();
    spread.push_back({patches.facet[patch],
                      patches.is_back[patch] == 0,
                      {std::lerp(cell.s0, cell.s1, x), std::lerp(cell.t0, cell.t1, y)}});
  }
  return spread;
}

// Luminance of the patches' radiosity, lm/m^2.
std::vector<double> read(const radiosity::Solution& solution,
                         const std::vector<SurfacePoint>& where) {
  std::vector<double> values;
  values.reserve(where.size());
  for (const SurfacePoint& point : where) {
    const radiosity::Facet& facet = solution.patches.facets[point.facet];
    const std::size_t patch = (point.front ? facet.first_front : facet.first_back) +
                              solution.patches.leaf(facet, point.where);
    Rgb sum(0.0);
    for (std::size_t k = 0; k < solution.columns; ++k) {
      sum[static_cast<int>(k % 3)] += double(solution.radiosity[patch * solution.columns + k]);
    }
    values.push_back(base::luminance(sum));
  }
  return values;
}

double root_mean_square(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return values.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(values.size()));
}

}  // namespace

SurfaceError surface_error(const StudyScene& scene, const radiosity::Solution& solution,
                           const radiosity::SolveOptions& solver) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  SurfaceError error;
  error.not_captured = not_captured(scene, {});
  if (solution.columns == 0 || solution.patches.count() == 0) return error;
  const std::vector<SurfacePoint> where = spread_points(solution.patches, solver.seed);
  Looks looks;
  looks.own = read(solution, where);
  const radiosity::SecondLooks made =
      radiosity::look_again(scene.scene, scene.groups, scene.effects, scene.query, solver, solution,
                            [&](radiosity::Look look, const radiosity::Solution& other) {
                              looks.add(look, read(other, where));
                            });
  const double scale = root_mean_square(looks.own);
  error.known = scale > 0.0;
  error.parts =
      solution_error(looks, made, solution.report.solver_error, {scale, Reading::Constant});
  error.rays = made.rays;
  error.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  return error;
}

}  // namespace earthshine::studies
