// SPDX-License-Identifier: Apache-2.0
#include "radiosity/fill_solution.h"

#include <algorithm>
#include <cmath>

#include "radiosity/factors/covered_patches.h"
#include "radiosity/patches/patches.h"
#include "scenes/sky/sky_cells.h"

namespace earthshine::radiosity {
namespace {

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
    if (is_explicit[m]) mean.radiosity_lm_m2 += area * patch_emit(scene, patches, patch);
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

}  // namespace

std::vector<double> reflectances(const scenes::Scene& scene, const Patches& patches,
                                 std::size_t groups) {
  std::vector<double> values(patches.count() * 3 * groups);
  const PatchAlbedos albedos(scene);
  for (std::size_t i = 0; i < patches.count(); ++i) {
    const Rgb rho = albedos.of(patches, static_cast<std::uint32_t>(i));
    for (std::size_t k = 0; k < 3 * groups; ++k) {
      values[i * 3 * groups + k] = rho[static_cast<int>(k % 3)];
    }
  }
  return values;
}

std::vector<double> exitances(const scenes::Scene& scene, const scenes::LightGroups& groups,
                              const Patches& patches) {
  const std::vector<bool> is_explicit = emitter_is_explicit(scene);
  const std::size_t columns = 3 * groups.count();
  std::vector<double> values(patches.count() * columns, 0.0);
  for (std::size_t i = 0; i < patches.count(); ++i) {
    const std::uint32_t m = patches.material(static_cast<std::uint32_t>(i));
    if (is_explicit[m] || groups.material[m] == scenes::no_group) continue;
    const Rgb emitted = patch_emit(scene, patches, static_cast<std::uint32_t>(i));
    for (int c = 0; c < 3; ++c) {
      values[i * columns + 3 * groups.material[m] + static_cast<std::size_t>(c)] = emitted[c];
    }
  }
  return values;
}

void fill_solution(const scenes::World& world, const FormFactors& factors, bool balanced,
                   PatchLight& light, Solution& solution) {
  const Patches& patches = solution.patches;
  const std::size_t columns = solution.columns;
  const std::vector<double> open_m2 = open_areas(factors.open, patches.area_m2);
  const LedgerInput ledger{factors,       open_m2,      columns,        light.reflectance,
                           light.emitted, light.direct, light.indirect, light.radiosity};
  close_energy(ledger, balanced, light.radiosity, light.indirect);
  SolveReport& report = solution.report;
  report.groups = energy_ledger(ledger, world.groups.names, report.sources);
  report.objects =
      object_means(world.scene, patches, open_m2, columns, emitter_is_explicit(world.scene),
                   light.direct, light.indirect, light.radiosity);
  solution.radiosity.assign(light.radiosity.begin(), light.radiosity.end());
  solution.direct_lx.assign(light.direct.begin(), light.direct.end());
  solution.indirect_lx.assign(light.indirect.begin(), light.indirect.end());
  solution.soft_radiosity.resize(light.radiosity.size());
  const std::size_t sky_parts = scenes::earth_parts(world.scene);
  Rgb patch_k_d(0.0);
  for (std::size_t k = 0; k < light.radiosity.size(); ++k) {
    const std::size_t column = k % columns;
    if (column == 0) {
      patch_k_d = patch_diffuse(world.scene, patches, static_cast<std::uint32_t>(k / columns));
    }
    const double diffuse = patch_k_d[static_cast<int>(column % 3)];
    double soft = diffuse * light.indirect[k];
    if (world.effects.earth_by_gather && column / 3 >= world.groups.earth &&
        column / 3 < world.groups.earth + sky_parts) {
      const std::size_t part = (k / columns) * sky_parts + column / 3 - world.groups.earth;
      soft += diffuse * light.sky[part][static_cast<int>(column % 3)];
    }
    solution.soft_radiosity[k] = static_cast<float>(soft);
  }
  const CoveredPatches covered(patches, factors.open);
  for (std::vector<float>* values : {&solution.radiosity, &solution.soft_radiosity,
                                     &solution.direct_lx, &solution.indirect_lx}) {
    covered.show_neighbours(*values, columns);
  }
}

std::vector<GroupLedger> energy_ledger(const LedgerInput& in,
                                       const std::vector<std::string>& group_names,
                                       std::span<const SourceFlux> sources) {
  std::vector<GroupLedger> ledger(group_names.size());
  for (std::size_t g = 0; g < group_names.size(); ++g) {
    GroupLedger& line = ledger[g];
    line.name = group_names[g];
    for (int c = 0; c < 3; ++c) {
      double emitted = 0.0, landed = 0.0, absorbed = 0.0, escaped = 0.0;
      for (std::size_t i = 0; i < in.area_m2.size(); ++i) {
        const std::size_t k = i * in.columns + 3 * g + static_cast<std::size_t>(c);
        const double area = in.area_m2[i];
        emitted += area * in.emitted[k];
        const double ends = in.factors.kept_direct.empty() ? 1.0 : in.factors.kept_direct[i][c];
        landed += area * ends * in.direct[k];
        absorbed += area * ((in.factors.kept[i] - in.reflectance[k]) * in.indirect[k] +
                            (ends - in.reflectance[k]) * in.direct[k] +
                            in.radiosity[k] * in.factors.lost[i]);
        escaped += area * in.radiosity[k] * in.factors.escape[i];
      }
      line.emitted_lm[c] = emitted;
      line.landed_lm[c] = landed;
      line.absorbed_lm[c] = absorbed;
      line.escaped_lm[c] = escaped;
      const double in_all = emitted + landed;
      if (in_all > 0.0) {
        line.imbalance = std::max(line.imbalance, std::abs(in_all - absorbed - escaped) / in_all);
      }
    }
  }
  for (const SourceFlux& source : sources) {
    ledger[source.group].escaped_at_once_lm += source.escaped_lm();
    ledger[source.group].lost_at_once_lm += source.lost_lm();
  }
  for (GroupLedger& line : ledger) {
    line.given_lm =
        line.emitted_lm + line.landed_lm + line.escaped_at_once_lm + line.lost_at_once_lm;
  }
  return ledger;
}

void close_energy(const LedgerInput& in, bool balanced, std::span<double> radiosity,
                  std::span<double> indirect) {
  std::vector<double> source(in.columns, 0.0), ended(in.columns, 0.0);
  for (std::size_t k = 0; k < radiosity.size(); ++k) {
    const std::size_t i = k / in.columns;
    const double s = in.emitted[k] + in.reflectance[k] * in.direct[k];
    // Balanced: where B ends, in absorption, the sky and black backs. Else by what the solver left.
    const double end = balanced ? (in.factors.kept[i] - in.reflectance[k]) * in.indirect[k] +
                                      in.radiosity[k] * (in.factors.lost[i] + in.factors.escape[i])
                                : in.radiosity[k] - in.reflectance[k] * in.indirect[k];
    source[k % in.columns] += in.area_m2[i] * s;
    ended[k % in.columns] += in.area_m2[i] * end;
  }
  for (std::size_t k = 0; k < radiosity.size(); ++k) {
    const double all = source[k % in.columns], end = ended[k % in.columns];
    if (all <= 0.0 || std::abs(all - end) > 0.01 * all) continue;
    radiosity[k] *= all / end;
    indirect[k] *= all / end;
  }
}

}  // namespace earthshine::radiosity
