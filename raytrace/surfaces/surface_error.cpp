// SPDX-License-Identifier: Apache-2.0
#include "raytrace/surfaces/surface_error.h"

#include <chrono>
#include <numeric>

#include "raytrace/light/uncaught_light.h"
#include "raytrace/surfaces/residual_error.h"
#include "scenes/sky/sky.h"
#include "scenes/sky/sky_cells.h"

namespace earthshine::raytrace {
namespace {

constexpr double points = 8192.0;
constexpr int matrix_rays = 64;  // per patch: the matrix carries the error, not the light
constexpr std::uint32_t replicate = 0x5E57;

// Casts the matrix for the error anew, because a solution does not store its form factors.
radiosity::FormFactors matrix_of(const scenes::World& scene, const radiosity::Solution& solution,
                                 std::uint64_t seed) {
  radiosity::SkyRadiance sky;
  if (scene.effects.earth_by_gather) {
    sky = scenes::EarthRadiance(scene.scene);
  }
  radiosity::FormFactorOptions options{matrix_rays, seed, replicate};
  options.leave_out_covered = true;
  const auto& parts = scene.scene.sky_parts;
  if (parts && parts->cells) options.sky_cells = &*parts->cells;
  return radiosity::cast_form_factors(scene.scene, scene.query, solution.patches, options, sky);
}

}  // namespace

SurfaceError surface_error(const scenes::World& scene, const radiosity::Solution& solution,
                           const radiosity::SolveOptions& solver) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  SurfaceError error;
  error.not_captured = not_captured(scene, {});
  if (solution.columns == 0 || solution.patches.count() == 0) return error;
  radiosity::FormFactors matrix = matrix_of(scene, solution, solver.seed);
  error.rays = matrix.ray_count;
  radiosity::Solution lit;
  lit.patches = solution.patches;
  lit.columns = solution.columns;
  lit.direct_lx = solution.direct_lx;
  lit.indirect_lx = solution.indirect_lx;
  const LightOnSurfaces light(scene, std::move(lit), std::move(matrix),
                              2.0 * solution.report.rays_per_patch);
  const double mean = light.mean_on_all_ranks();
  error.known = mean > 0.0;
  if (!error.known) return error;
  std::vector<std::uint32_t> all(light.patches().count());
  std::iota(all.begin(), all.end(), 0U);
  const std::vector<SampleBudget> budget = even_budget(light, points);
  const SurfaceSampler sampler(scene, solver.seed);
  const SurfaceSamples samples =
      sampler.sample(light.light(), all, budget, 1, mean, light.bodies(), {}, SamplesOf::Residual,
                     light.shares().receivers());
  LightNoise noise;
  if (light.shares().is_root()) {
    noise = noise_of(light, ray_variance(light.patches(), samples, all, budget), samples);
  }
  const ResidualError found =
      residual_error(light, samples, noise, sampler.reflectances(), solution.report.solver_error);
  error.parts = found.parts;
  error.unweighted = found.unweighted;
  error.rays += samples.rays;
  error.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  return error;
}

}  // namespace earthshine::raytrace
