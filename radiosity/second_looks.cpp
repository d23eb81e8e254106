// SPDX-License-Identifier: Apache-2.0
#include "radiosity/second_looks.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "radiosity/split.h"
#include "scenes/spread_reflectance.h"

namespace earthshine::radiosity {
namespace {

constexpr int fewest_rays = 16;
constexpr double clearly_fewer = 0.4;  // patches, of twice the edge

struct Comparison {
  Patches patches;
  double error_ratio = 0.5;
  bool finer = false;
};

// Every cell halved both ways.
Patches quartered(const Patches& patches) {
  Patches finer = patches;
  for (const Cut cut : {Cut::S, Cut::T}) {
    std::vector<Cut> wanted(finer.count(), Cut::None);
    for (std::uint32_t i = 0; i < wanted.size(); ++i) {
      if (can_cut(finer, i, cut)) wanted[i] = cut;
    }
    finer = split(finer, wanted).patches;
  }
  return finer;
}

// Coarser where that is clearly coarser: faces of the model cannot be made larger, and the coarse
// cells that refinement left are the same in its earlier rounds.
Comparison cut_otherwise(const scenes::Scene& scene, const SolveOptions& options,
                         const Solution& solution) {
  const double edge_m = 2.0 * options.patch_edge_m;
  const double share = static_cast<double>(count_patches(scene, edge_m)) /
                       static_cast<double>(solution.patches.count());
  if (!options.refine.on && share <= clearly_fewer) {
    return {subdivide(scene, edge_m), std::sqrt(share), false};
  }
  return {quartered(solution.patches), 0.5, true};
}

constexpr std::size_t sampled_group = 0, sky_group = 1;

// Lamps, Sun and emitters together; what a wide Earth gives, which the form factors' rays bring, is
// kept apart.
scenes::LightGroups joined(const scenes::LightGroups& groups, const scenes::Effects& effects) {
  scenes::LightGroups two = groups;
  two.names = {"sampled", "sky"};
  const auto join = [](std::size_t& group) {
    if (group != scenes::no_group) group = sampled_group;
  };
  join(two.sun);
  join(two.earth);
  join(two.ambient);
  std::for_each(two.lamp.begin(), two.lamp.end(), join);
  std::for_each(two.material.begin(), two.material.end(), join);
  if (effects.earth_by_gather) {
    two.earth = sky_group;
  } else {
    two.names.pop_back();
  }
  return two;
}

// The solution with the direct light of `other` in place of `usual`, followed for one bounce.
Solution with_direct(const scenes::Scene& scene, const Solution& solution, const Solution& other,
                     const std::vector<double>& usual) {
  Solution changed;
  changed.patches = solution.patches;
  changed.columns = 3;
  const std::size_t count = solution.patches.count(), columns = solution.columns;
  const std::vector<Rgb> spread = scenes::spread_reflectances(scene);
  changed.radiosity.assign(count * 3, 0.0F);
  changed.soft_radiosity.assign(count * 3, 0.0F);
  for (std::size_t i = 0; i < count; ++i) {
    const Rgb& rho = spread[solution.patches.material(static_cast<std::uint32_t>(i))];
    for (std::size_t k = 0; k < columns; ++k) {
      changed.radiosity[i * 3 + k % 3] += solution.radiosity[i * columns + k];
      changed.soft_radiosity[i * 3 + k % 3] += solution.soft_radiosity[i * columns + k];
    }
    for (std::size_t c = 0; c < 3; ++c) {
      const double more =
          double(other.direct_lx[i * other.columns + 3 * sampled_group + c]) - usual[i * 3 + c];
      changed.radiosity[i * 3 + c] += static_cast<float>(rho[static_cast<int>(c)] * more);
    }
  }
  return changed;
}

std::vector<double> mean_direct(const std::vector<Solution>& looks) {
  const std::size_t count = looks.front().patches.count(), columns = looks.front().columns;
  std::vector<double> mean(count * 3, 0.0);
  for (const Solution& look : looks) {
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        mean[i * 3 + c] += double(look.direct_lx[i * columns + 3 * sampled_group + c]) /
                           static_cast<double>(looks.size());
      }
    }
  }
  return mean;
}

}  // namespace

SecondLooks look_again(const scenes::Scene& scene, const scenes::LightGroups& groups,
                       const scenes::Effects& effects, const scenes::RayQuery& query,
                       const SolveOptions& options, const Solution& solution,
                       const LookListener& listen) {
  // What differs by chance is far above these.
  constexpr double tolerance = 1e-5, balanced = 1e-3;
  SecondLooks looks;
  const scenes::LightGroups two = joined(groups, effects);
  const DirectOptions usual;
  std::uint32_t replicate = 0;
  const auto look = [&](const Patches& patches, int rays, int divided_by, int points) {
    SolveOptions with = options;
    with.form_factor_rays = std::min(rays, std::max(fewest_rays, rays / divided_by));
    with.tolerance = std::max(options.tolerance, tolerance);
    ++replicate;
    Solution other =
        solve(scene, two, effects, query, with, patches,
              {replicate,
               {points, usual.flux_rays / divided_by, base::mix64(options.seed + replicate)},
               balanced});
    looks.rays += other.report.form_factor_rays + other.report.shadow_rays;
    return other;
  };

  const int rays = solution.report.rays_per_patch;
  std::vector<Solution> few;
  for (std::uint32_t k = 0; k < few_rays_looks; ++k) {
    few.push_back(look(solution.patches, rays, 32, usual.points_per_patch / 4));
    listen(Look::FewRays, few.back());
  }
  looks.ray_share = std::min(1.0, std::max(fewest_rays / double(rays), 1.0 / 32.0));
  looks.point_share = 0.25;
  const std::vector<double> mean = mean_direct(few);
  for (const Solution& other : few) {
    listen(Look::OtherDirect, with_direct(scene, solution, other, mean));
  }

  const Comparison cut = cut_otherwise(scene, options, solution);
  looks.error_ratio = cut.error_ratio;
  looks.finer = cut.finer;
  looks.other_patches = cut.patches.count();
  // Cells cut in four have as many points as the solution has, and no more than twice the rays of
  // a coarser cut.
  const int points = cut.finer ? usual.points_per_patch / 4 : usual.points_per_patch;
  const int divided_by = cut.finer ? 32 : 16;
  for (std::uint32_t k = 0; k < other_patches_looks; ++k) {
    listen(Look::OtherPatches, look(cut.patches, rays, divided_by, points));
  }
  return looks;
}

}  // namespace earthshine::radiosity
