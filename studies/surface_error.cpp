// SPDX-License-Identifier: Apache-2.0
#include "studies/surface_error.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/random.h"
#include "raytrace/radiance_table.h"
#include "studies/error_budget.h"
#include "studies/pixel_choice.h"

namespace earthshine::studies {
namespace {

constexpr std::size_t points = 8192;

// Spread over the surfaces by area, sheets on both sides.
std::vector<scenes::Hit> spread_points(const scenes::Scene& scene, std::uint64_t seed) {
  std::vector<double> area;
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    const bool sheet = scene.materials[scene.triangles[t].material].two_sided;
    area.push_back((sheet ? 2.0 : 1.0) * scenes::triangle_area(scene, t));
  }
  std::vector<scenes::Hit> spread;
  base::Rng rng(base::Key(seed, base::Stream::ErrorBudget, 2));
  for (const std::size_t t : spread_by_weight(area, points, seed)) {
    double u = rng.next(), v = rng.next();
    if (u + v > 1.0) {
      u = 1.0 - u;
      v = 1.0 - v;
    }
    const bool sheet = scene.materials[scene.triangles[t].material].two_sided;
    const bool front = !sheet || rng.next() < 0.5;
    scenes::Hit hit;
    hit.triangle = static_cast<std::uint32_t>(t);
    hit.u = static_cast<decltype(hit.u)>(u);
    hit.v = static_cast<decltype(hit.v)>(v);
    hit.front = front;
    spread.push_back(hit);
  }
  return spread;
}

// Luminance of the radiosity, lm/m^2.
std::vector<double> read(const radiosity::Solution& solution,
                         const std::vector<scenes::Hit>& where) {
  const raytrace::RadianceTable table(solution, solution.radiosity, false);
  std::vector<double> values;
  values.reserve(where.size());
  for (const scenes::Hit& hit : where) {
    std::array<Rgb, 1> sum{Rgb(0.0)};
    table.add(hit, Rgb(base::pi), sum);
    values.push_back(base::luminance(sum[0]));
  }
  return values;
}

}  // namespace

SurfaceError surface_error(const StudyScene& scene, const radiosity::Solution& solution,
                           const radiosity::SolveOptions& solver) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  SurfaceError error;
  error.not_captured = not_captured(scene, {});
  if (solution.columns == 0 || solution.patches.count() == 0) return error;
  const std::vector<scenes::Hit> where = spread_points(scene.scene, solver.seed);
  Looks looks;
  looks.own = read(solution, where);
  const radiosity::SecondLooks made =
      radiosity::look_again(scene.scene, scene.groups, scene.effects, scene.query, solver, solution,
                            [&](radiosity::Look look, const radiosity::Solution& other) {
                              looks.add(look, read(other, where));
                            });
  error.known = std::any_of(looks.own.begin(), looks.own.end(), [](double b) { return b > 0.0; });
  error.parts = weighed_error(std::move(looks), made, solution.report.solver_error);
  error.rays = made.rays;
  error.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  return error;
}

}  // namespace earthshine::studies
