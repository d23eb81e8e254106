// SPDX-License-Identifier: Apache-2.0
#include "radiosity/solution.h"

#include <chrono>
#include <numeric>

#include "radiosity/covered_patches.h"
#include "radiosity/ledger.h"
#include "radiosity/light_ends.h"
#include "radiosity/linear_solve.h"
#include "radiosity/refine.h"
#include "scenes/sky.h"
#include "scenes/sky_parts.h"
#include "scenes/spread_reflectance.h"

namespace earthshine::radiosity {
namespace {

// The share of all surface area from which an emitter is carried by F.
constexpr double wide_emitter_share = 0.05;

constexpr double fewest_rays_met = 256.0;

class Stopwatch {
 public:
  explicit Stopwatch(SolveReport& report) : report_(report) {}
  void lap(const char* stage) {
    const auto now = Clock::now();
    report_.seconds.emplace_back(stage, std::chrono::duration<double>(now - last_).count());
    last_ = now;
  }

 private:
  using Clock = std::chrono::steady_clock;
  SolveReport& report_;
  Clock::time_point last_ = Clock::now();
};

// Per patch and column: a material's value, in the columns of its group or of all groups.
std::vector<double> reflectances(const scenes::Scene& scene, const Patches& patches,
                                 std::size_t groups) {
  std::vector<double> values(patches.count() * 3 * groups);
  const std::vector<Rgb> spread = scenes::spread_reflectances(scene);
  for (std::size_t i = 0; i < patches.count(); ++i) {
    const Rgb& rho = spread[patches.material(static_cast<std::uint32_t>(i))];
    for (std::size_t k = 0; k < 3 * groups; ++k) {
      values[i * 3 * groups + k] = rho[static_cast<int>(k % 3)];
    }
  }
  return values;
}

std::vector<double> exitances(const scenes::Scene& scene, const scenes::LightGroups& groups,
                              const Patches& patches, const std::vector<bool>& is_explicit) {
  const std::size_t columns = 3 * groups.count();
  std::vector<double> values(patches.count() * columns, 0.0);
  for (std::size_t i = 0; i < patches.count(); ++i) {
    const std::uint32_t m = patches.material(static_cast<std::uint32_t>(i));
    if (is_explicit[m] || groups.material[m] == scenes::no_group) continue;
    for (int c = 0; c < 3; ++c) {
      values[i * columns + 3 * groups.material[m] + static_cast<std::size_t>(c)] =
          scene.materials[m].emit[c];
    }
  }
  return values;
}

// Means over what is open of each object; over all of it where nothing is.
std::vector<ObjectLight> object_means(const scenes::Scene& scene, const Patches& patches,
                                      const std::vector<double>& open_m2, std::size_t columns,
                                      const std::vector<bool>& is_explicit,
                                      const std::vector<double>& direct,
                                      const std::vector<double>& indirect,
                                      const std::vector<double>& radiosity) {
  std::vector<ObjectLight> means(scene.objects.size());
  std::vector<double> open(means.size(), 0.0), weight(means.size(), 0.0);
  for (std::uint32_t i = 0; i < patches.count(); ++i) open[patches.object(i)] += open_m2[i];
  for (std::size_t i = 0; i < patches.count(); ++i) {
    const auto patch = static_cast<std::uint32_t>(i);
    const std::uint32_t object = patches.object(patch);
    ObjectLight& mean = means[object];
    const double area = open[object] > 0.0 ? open_m2[i] : patches.area_m2[i];
    mean.area_m2 += patches.area_m2[i];
    weight[object] += area;
    for (std::size_t k = 0; k < columns; ++k) {
      const auto c = static_cast<int>(k % 3);
      mean.illuminance_lx[c] += area * (direct[i * columns + k] + indirect[i * columns + k]);
      mean.radiosity_lm_m2[c] += area * radiosity[i * columns + k];
    }
    const std::uint32_t m = patches.material(patch);
    if (is_explicit[m]) mean.radiosity_lm_m2 += area * scene.materials[m].emit;
  }
  for (std::size_t o = 0; o < means.size(); ++o) {
    means[o].name = scene.objects[o].name;
    if (weight[o] > 0.0) {
      means[o].illuminance_lx /= weight[o];
      means[o].radiosity_lm_m2 /= weight[o];
    }
  }
  return means;
}

// Of the rays of exposed patches that met each object, the share that met its black back.
std::vector<double> back_shares(const scenes::Scene& scene, const Patches& patches,
                                const FormFactors& factors) {
  std::vector<double> met = factors.back_hits;
  for (std::size_t i = 0; i < factors.count(); ++i) {
    if (!is_exposed(factors.black[i])) continue;
    for (std::uint64_t e = factors.row_start[i]; e < factors.row_start[i + 1]; ++e) {
      met[patches.object(factors.column[e])] += double(factors.hits[e]);
    }
  }
  std::vector<double> share(scene.objects.size(), 0.0);
  for (std::size_t o = 0; o < share.size(); ++o) {
    // A few stray rays, as past a needle's edge, say nothing.
    if (met[o] >= fewest_rays_met) share[o] = factors.back_hits[o] / met[o];
  }
  return share;
}

double back_share(const FormFactors& factors) {
  return factors.count() > 0 ? std::accumulate(factors.black.begin(), factors.black.end(), 0.0) /
                                   double(factors.count())
                             : 0.0;
}

}  // namespace

std::vector<bool> emitter_is_explicit(const scenes::Scene& scene) {
  std::vector<double> area(scene.materials.size(), 0.0);
  double total = 0.0;
  for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
    const std::uint32_t m = scene.triangles[t].material;
    const double sides = scene.materials[m].two_sided ? 2.0 : 1.0;
    const double a = sides * scenes::triangle_area(scene, static_cast<std::uint32_t>(t));
    area[m] += a;
    total += a;
  }
  std::vector<bool> is_explicit(scene.materials.size(), false);
  for (std::size_t m = 0; m < area.size(); ++m) {
    is_explicit[m] = scene.materials[m].emits() && area[m] < wide_emitter_share * total;
  }
  return is_explicit;
}

SolveOptions solve_options(const scenes::QualityKnobs& knobs, std::uint64_t seed) {
  return {knobs.patch_edge_m,
          knobs.form_factor_rays,
          knobs.solver_tolerance,
          seed,
          {knobs.refine, knobs.start_edge_m, static_cast<std::size_t>(knobs.max_patches),
           knobs.refine_error}};
}

bool is_lit(const scenes::Effects& effects) {
  return effects.sun || effects.sun_parts || effects.earth || effects.lamps || effects.emitters;
}

Solution solve(const scenes::Scene& scene, const scenes::LightGroups& groups,
               const scenes::Effects& effects, const scenes::RayQuery& query,
               const SolveOptions& options, const PatchListener& listen) {
  SolveReport cutting;
  Stopwatch watch(cutting);
  Refined refined = refine(scene, groups, effects, query, options);
  watch.lap("patches");
  if (listen) listen(refined.patches);
  Solution solution = solve(scene, groups, effects, query, options, std::move(refined.patches));
  SolveReport& report = solution.report;
  report.seconds.insert(report.seconds.begin(), cutting.seconds.front());
  report.rounds = std::move(refined.rounds);
  report.refinement_rays = refined.rays;
  return solution;
}

Solution solve(const scenes::Scene& scene, const scenes::LightGroups& groups,
               const scenes::Effects& effects, const scenes::RayQuery& query,
               const SolveOptions& options, Patches cut, const SolveVariant& variant) {
  Solution solution;
  SolveReport& report = solution.report;
  Stopwatch watch(report);
  solution.patches = std::move(cut);
  const Patches& patches = solution.patches;
  report.patches = patches.count();
  if (!is_lit(effects) || patches.count() == 0) return solution;
  solution.columns = 3 * groups.count();

  SkyRadiance sky;
  if (effects.earth_by_gather) {
    sky = [&scene](const Vec3& direction) { return scenes::earth_radiance(scene, direction); };
  }
  FormFactorOptions rays{options.form_factor_rays, options.seed, variant.replicate};
  rays.leave_out_covered = true;
  if (scene.sky_parts && scene.sky_parts->cells) rays.sky_cells = &*scene.sky_parts->cells;
  FormFactors factors = cast_form_factors(scene, query, patches, rays, sky);
  const std::vector<double> open_m2 = open_areas(factors.open, patches.area_m2);
  report.form_factor_rays = factors.ray_count;
  report.rays_per_patch = factors.rays_per_patch;
  report.nonzeros = factors.hits.size();
  const std::vector<double> object_backs = back_shares(scene, patches, factors);
  report.back_share = back_share(factors);
  watch.lap("form factors");
  report.balance = balance(factors, open_m2, variant.balance);
  watch.lap("balance");

  DirectOptions direct_options = variant.direct;
  if (direct_options.seed == 0) direct_options.seed = options.seed;
  DirectLight light = direct_light(scene, groups, effects, query, patches, factors, direct_options);
  report.shadow_rays = light.shadow_rays;
  report.sources_cost = light.cost;
  report.sources = std::move(light.sources);
  watch.lap("direct light");

  const std::size_t columns = solution.columns;
  const std::vector<bool> is_explicit = emitter_is_explicit(scene);
  const std::vector<double> rho = reflectances(scene, patches, groups.count());
  const std::vector<double> emitted = exitances(scene, groups, patches, is_explicit);
  std::vector<double> source(rho.size());
  for (std::size_t k = 0; k < source.size(); ++k) {
    source[k] = emitted[k] + rho[k] * light.illuminance_lx[k];
  }
  check_light_ends(scene, patches, factors, source, rho, columns);
  LinearSolve linear = solve_linear(factors, source, rho, columns, options.tolerance);
  report.iterations = linear.iterations;
  report.residual = linear.residual;
  report.solver_error = linear.error;
  std::vector<double> indirect(source.size());
  multiply(factors, linear.x, indirect, columns);
  close_energy({factors, open_m2, columns, rho, emitted, light.illuminance_lx, indirect, linear.x},
               report.balance.balanced, linear.x, indirect);
  watch.lap("linear solve");

  report.groups = energy_ledger(
      {factors, open_m2, columns, rho, emitted, light.illuminance_lx, indirect, linear.x},
      groups.names);
  report.objects = object_means(scene, patches, open_m2, columns, is_explicit, light.illuminance_lx,
                                indirect, linear.x);
  for (std::size_t o = 0; o < object_backs.size(); ++o) {
    report.objects[o].back_share = object_backs[o];
  }
  solution.radiosity.assign(linear.x.begin(), linear.x.end());
  solution.direct_lx.assign(light.illuminance_lx.begin(), light.illuminance_lx.end());
  solution.indirect_lx.assign(indirect.begin(), indirect.end());
  solution.soft_radiosity.resize(source.size());
  const std::size_t sky_parts = scenes::earth_parts(scene);
  for (std::size_t k = 0; k < source.size(); ++k) {
    const std::size_t column = k % columns;
    const std::uint32_t material = patches.material(static_cast<std::uint32_t>(k / columns));
    const double diffuse = scene.materials[material].diffuse[static_cast<int>(column % 3)];
    double soft = diffuse * indirect[k];
    if (effects.earth_by_gather && column / 3 >= groups.earth &&
        column / 3 < groups.earth + sky_parts) {
      const std::size_t part = (k / columns) * sky_parts + column / 3 - groups.earth;
      soft += diffuse * factors.sky_illuminance[part][static_cast<int>(column % 3)];
    }
    solution.soft_radiosity[k] = static_cast<float>(soft);
  }
  const CoveredPatches covered(patches, factors.open);
  for (std::vector<float>* values : {&solution.radiosity, &solution.soft_radiosity,
                                     &solution.direct_lx, &solution.indirect_lx}) {
    covered.show_neighbours(*values, columns);
  }
  watch.lap("ledger");
  return solution;
}

}  // namespace earthshine::radiosity
