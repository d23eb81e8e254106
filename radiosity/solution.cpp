// SPDX-License-Identifier: Apache-2.0
#include "radiosity/solution.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <numeric>
#include <set>

#include "base/error.h"
#include "base/ranks/ranks.h"
#include "radiosity/bodies/closed_bodies.h"
#include "radiosity/broadcast_solution.h"
#include "radiosity/fill_solution.h"
#include "radiosity/linear_solve.h"
#include "radiosity/refine.h"
#include "scenes/light/lamp_light.h"
#include "scenes/reflect/energy.h"
#include "scenes/sky/sky.h"
#include "scenes/sky/sky_cells.h"

namespace earthshine::radiosity {
namespace {

constexpr double fewest_rays_met = 256.0;

// Rays per patch if nothing reflects, emits through F or reads the sky: they only find covered
// points and visible backs.
constexpr int rays_without_light = 256;

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

// Connected parts of the graph of light exchange, each named by its lowest patch.
std::vector<std::uint32_t> connected_parts(const FormFactors& f) {
  std::vector<std::uint32_t> parent(f.count());
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  const auto join = [&](std::uint32_t i, std::uint32_t j) {
    const std::uint32_t a = root(i), b = root(j);
    parent[std::max(a, b)] = std::min(a, b);
  };
  for (std::uint32_t i = 0; i < f.count(); ++i) {
    for (std::uint64_t e = f.row_start[i]; e < f.row_start[i + 1]; ++e) join(i, f.column[e]);
  }
  f.shares.sequential_reduce([&](base::Parcel& parcel) { parcel.pass(parent); },
                             [&](base::Parcel& parcel) {
                               std::vector<std::uint32_t> theirs;
                               parcel.pass(theirs);
                               for (std::uint32_t i = 0; i < f.count(); ++i) join(i, theirs[i]);
                             });
  for (std::uint32_t i = 0; i < f.count(); ++i) parent[i] = root(i);
  return parent;
}

// In a closed part of the scene that absorbs nothing, B = S + rho F B has no solution for any S
// above 0. Throws base::Error (Input) with the materials of such a part. Own rows, source: x
// columns, reflectance: x 3.
void check_enclosure(const scenes::Scene& scene, const Patches& patches, const FormFactors& factors,
                     std::span<const double> source, std::span<const double> reflectance,
                     std::size_t columns) {
  // A part can keep all light only if some material absorbs nothing.
  const std::size_t count = factors.count();
  const auto [begin, end] = factors.shares.own(count);
  // Rounding of 1 - mirror - diffuse is no absorption.
  constexpr double rounding = 1e-12;
  std::vector<std::uint8_t> takes(3 * count);  // absorbs; per patch and colour
  for (std::size_t i = begin; i < end; ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      takes[3 * i + c] = factors.kept[i] - reflectance[3 * (i - begin) + c] > rounding;
    }
  }
  factors.shares.all_gather(takes.data(), 3);
  if (std::find(takes.begin(), takes.end(), 0) == takes.end()) return;
  const std::vector<std::uint32_t> part = connected_parts(factors);
  std::vector<std::uint8_t> lit(columns * count, 0);
  for (std::size_t k = 0; k < source.size(); ++k) lit[begin * columns + k] = source[k] > 0.0;
  factors.shares.all_gather(lit.data(), columns);
  for (std::size_t c = 0; c < columns; ++c) {
    std::vector<char> part_ends(count, 0), part_lit(count, 0);
    for (std::size_t i = 0; i < count; ++i) {
      if (takes[3 * i + c % 3] != 0 || factors.escape[i] > 0.0 || factors.lost[i] > 0.0) {
        part_ends[part[i]] = 1;
      }
      if (lit[i * columns + c] != 0) part_lit[part[i]] = 1;
    }
    std::set<std::string> names;
    for (std::size_t i = 0; i < count; ++i) {
      if (part_lit[part[i]] == 0 || part_ends[part[i]] != 0) continue;
      names.insert(scene.materials[patches.material(static_cast<std::uint32_t>(i))].name);
    }
    if (names.empty()) continue;
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "\"" : ", \"") + name + "\"";
    throw base::Error(base::Blame::Input, scene.path.string(),
                      "a closed part of the scene reflects everything: material " + list,
                      "somewhere in it light must be absorbed, pass out or meet a black back",
                      "Lower a diffuse reflectance below 1, for instance to 0.999999");
  }
}

// Whether any surface has a radiosity: it reflects, or emits through F.
bool any_sends(const scenes::Scene& scene, const Patches& patches,
               const std::vector<bool>& is_explicit) {
  const std::vector<Rgb> spread = scenes::bihemispherical_albedos(scene);
  return std::any_of(patches.facets.begin(), patches.facets.end(), [&](const Facet& facet) {
    const std::uint32_t m = facet.material;
    return base::max_component(spread[m]) > 0.0 || (scene.materials[m].emits() && !is_explicit[m]);
  });
}

// Share of the rays of exposed patches to each object that hit its black back.
std::vector<double> back_shares(const scenes::Scene& scene, const Patches& patches,
                                const FormFactors& factors) {
  std::vector<double> met = factors.back_hits;
  const bool whole_hits = std::all_of(factors.kept.begin(), factors.kept.end(),
                                      [](double share) { return share == 1.0; });
  factors.shares.add_up(met, whole_hits, [&](std::vector<double>& sums) {
    const auto [begin, end] = factors.shares.own(factors.count());
    for (std::size_t i = begin; i < end; ++i) {
      if (!is_exposed(factors.black[i])) continue;
      for (std::uint64_t e = factors.row_start[i]; e < factors.row_start[i + 1]; ++e) {
        sums[patches.object(factors.column[e])] += double(factors.hits[e]);
      }
    }
  });
  std::vector<double> share(scene.objects.size(), 0.0);
  for (std::size_t o = 0; o < share.size(); ++o) {
    // Few rays, such as those past a needle's edge, are not significant.
    if (met[o] >= fewest_rays_met) share[o] = factors.back_hits[o] / met[o];
  }
  return share;
}

double back_share(const FormFactors& factors) {
  return factors.count() > 0 ? std::accumulate(factors.black.begin(), factors.black.end(), 0.0) /
                                   double(factors.count())
                             : 0.0;
}

// Finds what moved since the kept pose, and makes the kept pose this one.
std::unique_ptr<const MovedParts> begin_pose(const scenes::World& world, const Patches& patches,
                                             KeptPose& kept) {
  const scenes::Scene& scene = world.scene;
  const bool light_outside = scenes::has_light_outside(scene);
  const bool same = kept.rows.rows.size() == patches.count() &&
                    kept.centre == world.query.centre() && kept.light_outside == light_outside;
  const auto earlier = std::move(kept.bodies);
  kept.bodies = std::make_shared<const ClosedBodies>(scene, world.query.centre(),
                                                     same ? earlier.get() : nullptr);
  std::unique_ptr<const MovedParts> moved;
  if (same) {
    double offset_m = 0.0;
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
      offset_m = std::max(offset_m, world.query.offset_m(t));
    }
    moved = std::make_unique<const MovedParts>(kept.vertices, *earlier, scene, *kept.bodies,
                                               patches, 2.0 * offset_m);
  } else {
    kept.rows.rows.assign(patches.count(), {});
    kept.samples.of_source.clear();
  }
  kept.rows.moved = kept.samples.moved = moved.get();
  kept.vertices = scene.vertices;
  kept.centre = world.query.centre();
  kept.light_outside = light_outside;
  return moved;
}

}  // namespace

SolveOptions solve_options(const scenes::QualityKnobs& knobs, std::uint64_t seed) {
  return {knobs.patch_edge_m,
          knobs.form_factor_rays,
          knobs.solver_tolerance,
          seed,
          {knobs.refine, knobs.start_edge_m, static_cast<std::size_t>(knobs.max_patches),
           knobs.refine_error},
          1 << 16};
}

Solution unsolved(const scenes::LightGroups& groups) {
  Solution solution;
  solution.columns = 3 * groups.count();
  return solution;
}

bool is_lit(const scenes::Effects& effects) {
  return effects.sun || effects.sun_parts || effects.earth || effects.lamps || effects.emitters;
}

Solution solve(const scenes::World& world, const SolveOptions& options,
               const PatchListener& listen) {
  SolveReport cutting;
  Stopwatch watch(cutting);
  Refined refined = refine(world, options);
  watch.lap("patches");
  if (listen) listen(refined.patches);
  Solution solution = solve(world, options, std::move(refined.patches));
  SolveReport& report = solution.report;
  report.seconds.insert(report.seconds.begin(), cutting.seconds.front());
  report.rounds = std::move(refined.rounds);
  report.refinement_rays = refined.rays;
  return solution;
}

Solution solve(const scenes::World& world, const SolveOptions& options, Patches cut,
               const SolveVariant& variant) {
  FormFactors factors;
  return solve_keeping(world, options, std::move(cut), variant, factors);
}

Solution solve_keeping(const scenes::World& world, const SolveOptions& options, Patches cut,
                       const SolveVariant& variant, FormFactors& factors) {
  Solution solution;
  SolveReport& report = solution.report;
  Stopwatch watch(report);
  solution.patches = std::move(cut);
  const Patches& patches = solution.patches;
  report.patches = patches.count();
  if (!is_lit(world.effects) || world.scene.triangles.empty()) return solution;
  if (patches.count() == 0) {
    throw base::Error(base::Blame::Work, world.scene.path.string(),
                      "surfaces were left without patches, which would show them without light", {},
                      "Raise quality.patch_edge, and report this as a fault of the program");
  }
  solution.columns = 3 * world.groups.count();

  SkyRadiance sky;
  if (world.effects.earth_by_gather) {
    sky = scenes::EarthRadiance(world.scene);
  }
  FormFactorOptions rays{options.form_factor_rays, options.seed, variant.replicate};
  const std::vector<bool> is_explicit = emitter_is_explicit(world.scene);
  if (!world.effects.earth_by_gather && !any_sends(world.scene, patches, is_explicit)) {
    rays.rays_per_patch = std::min(rays.rays_per_patch, rays_without_light);
  }
  rays.leave_out_covered = true;
  rays.know_objects = variant.know_objects;
  if (world.scene.sky_parts && world.scene.sky_parts->cells)
    rays.sky_cells = &*world.scene.sky_parts->cells;
  KeptPose* const kept = base::ranks() == nullptr ? variant.kept : nullptr;
  std::unique_ptr<const MovedParts> moved;
  if (kept != nullptr) {
    moved = begin_pose(world, patches, *kept);
    rays.kept = &kept->rows;
    rays.bodies = kept->bodies;
  }
  factors = cast_form_factors(world.scene, world.query, patches, rays, sky);
  const std::vector<double> open_m2 = open_areas(factors.open, patches.area_m2);
  report.form_factor_rays = factors.ray_count;
  report.rays_per_patch = factors.rays_per_patch;
  report.nonzeros = factors.shares.sum(factors.hits.size());
  const std::vector<double> object_backs = back_shares(world.scene, patches, factors);
  report.back_share = back_share(factors);
  watch.lap("form factors");
  report.balance = balance(factors, open_m2, options.balance);
  watch.lap("balance");

  DirectOptions direct_options = variant.direct;
  if (direct_options.seed == 0) direct_options.seed = options.seed;
  direct_options.flux_rays = std::min(direct_options.flux_rays, options.flux_rays);
  direct_options.points_per_patch =
      std::min(direct_options.points_per_patch, options.direct_points);
  if (kept != nullptr) direct_options.kept = &kept->samples;
  DirectLight light = direct_light(world, patches, factors, direct_options);
  if (kept != nullptr) {
    const auto mirrors = world.query.specular_paths().mirrors();
    kept->samples.mirrors.assign(mirrors.begin(), mirrors.end());
    kept->samples.open_share = factors.open.share;
    kept->rows.moved = kept->samples.moved = nullptr;
  }
  report.shadow_rays = light.shadow_rays;
  report.sources_cost = light.cost;
  report.sources = std::move(light.sources);
  watch.lap("direct light");

  const std::size_t columns = solution.columns;
  const base::Shares::Range rows = factors.shares.own(patches.count());
  PatchLight found;
  found.reflectance = reflectances(world.scene, patches, rows);
  found.direct = std::move(light.illuminance_lx);
  found.sky = factors.sky_illuminance;
  std::vector<double> source = exitances(world.scene, world.groups, patches, rows);
  for (std::size_t k = 0; k < source.size(); ++k) {
    source[k] += found.reflectance[k / columns * 3 + k % 3] * found.direct[k];
  }
  check_enclosure(world.scene, patches, factors, source, found.reflectance, columns);
  LinearSolve linear =
      solve_linear(factors, std::move(source), found.reflectance, columns, options.tolerance);
  report.iterations = linear.iterations;
  report.residual = linear.residual;
  report.solver_error = linear.error;
  found.radiosity = std::move(linear.x);
  found.indirect = std::move(linear.fx);
  watch.lap("linear solve");

  found.emitted = exitances(world.scene, world.groups, patches, rows);
  fill_solution(world, factors, report.balance.balanced, std::move(found), solution);
  for (std::size_t o = 0; o < object_backs.size(); ++o) {
    report.objects[o].back_share = object_backs[o];
  }
  broadcast_report(factors.shares, report);
  watch.lap("ledger");
  return solution;
}

}  // namespace earthshine::radiosity
