// SPDX-License-Identifier: Apache-2.0
#include "radiosity/fill_solution.h"

#include <algorithm>
#include <cmath>

#include "base/free_memory.h"
#include "base/parallel.h"
#include "radiosity/factors/covered_patches.h"
#include "radiosity/factors/row_sums.h"
#include "radiosity/patches/patches.h"
#include "scenes/sky/sky_cells.h"

namespace earthshine::radiosity {
namespace {

// Means over the open part of each object; over the whole object if nothing is open.
std::vector<ObjectLight> object_means(const scenes::Scene& scene, const Patches& patches,
                                      const LedgerInput& in) {
  const std::vector<bool> is_explicit = emitter_is_explicit(scene);
  const std::size_t objects = scene.objects.size();
  std::vector<double> open(objects, 0.0);
  for (std::uint32_t i = 0; i < patches.count(); ++i) open[patches.object(i)] += in.area_m2[i];
  // Per object: area, weight, illuminance and radiosity.
  constexpr std::size_t each = 8;
  std::vector<double> sums(objects * each, 0.0);
  in.factors.shares.add_up(sums, false, [&](std::vector<double>& all) {
    const auto [begin, end] = in.factors.shares.own(patches.count());
    for (std::size_t i = begin; i < end; ++i) {
      const auto patch = static_cast<std::uint32_t>(i);
      const std::size_t object = patches.object(patch), row = (i - begin) * in.columns;
      double* const of = &all[object * each];
      const double area = open[object] > 0.0 ? in.area_m2[i] : patches.area_m2[i];
      of[0] += patches.area_m2[i];
      of[1] += area;
      for (std::size_t k = 0; k < in.columns; ++k) {
        of[2 + k % 3] += area * (in.direct[row + k] + in.indirect[row + k]);
        of[5 + k % 3] += area * in.radiosity[row + k];
      }
      const std::uint32_t m = patches.material(patch);
      if (!is_explicit[m]) continue;
      const Rgb emitted = area * patch_emit(scene, patches, patch);
      for (int c = 0; c < 3; ++c) of[5 + c] += emitted[c];
    }
  });
  std::vector<ObjectLight> means(objects);
  for (std::size_t o = 0; o < objects; ++o) {
    const double* const of = &sums[o * each];
    means[o].name = scene.objects[o].name;
    means[o].area_m2 = of[0];
    const double weight = of[1] > 0.0 ? of[1] : 1.0;
    means[o].illuminance_lx = Rgb(of[2], of[3], of[4]) / weight;
    means[o].radiosity_lm_m2 = Rgb(of[5], of[6], of[7]) / weight;
  }
  return means;
}

// body(patch, its row on this rank, sums).
template <class Body>
std::vector<double> sums_over_patches(const LedgerInput& in, std::size_t each, Body body) {
  const std::size_t first = in.factors.shares.own(in.factors.count()).begin;
  return sums_over_rows(in.factors, each, [&](std::size_t begin, std::size_t end, double* sums) {
    for (std::size_t row = begin; row < end; ++row) body(first + row, row, sums);
  });
}

}  // namespace

std::vector<double> reflectances(const scenes::Scene& scene, const Patches& patches,
                                 base::Shares::Range rows) {
  std::vector<double> values;
  values.reserve((rows.end - rows.begin) * 3);
  const PatchAlbedos albedos(scene);
  for (std::size_t i = rows.begin; i < rows.end; ++i) {
    const Rgb rho = albedos.of(patches, static_cast<std::uint32_t>(i));
    for (int c = 0; c < 3; ++c) values.push_back(rho[c]);
  }
  return values;
}

std::vector<double> exitances(const scenes::Scene& scene, const scenes::LightGroups& groups,
                              const Patches& patches, base::Shares::Range rows) {
  const std::vector<bool> is_explicit = emitter_is_explicit(scene);
  const std::size_t columns = 3 * groups.count();
  std::vector<double> values((rows.end - rows.begin) * columns, 0.0);
  for (std::size_t i = rows.begin; i < rows.end; ++i) {
    const std::uint32_t m = patches.material(static_cast<std::uint32_t>(i));
    if (is_explicit[m] || groups.material[m] == scenes::no_group) continue;
    const Rgb emitted = patch_emit(scene, patches, static_cast<std::uint32_t>(i));
    for (int c = 0; c < 3; ++c) {
      values[(i - rows.begin) * columns + 3 * groups.material[m] + static_cast<std::size_t>(c)] =
          emitted[c];
    }
  }
  return values;
}

void fill_solution(const scenes::World& world, const FormFactors& factors, bool balanced,
                   PatchLight light, Solution& solution) {
  const Patches& patches = solution.patches;
  const std::size_t columns = solution.columns;
  {
    const std::vector<double> open_m2 = open_areas(factors.open, patches.area_m2);
    const LedgerInput ledger{factors,       open_m2,      columns,        light.reflectance,
                             light.emitted, light.direct, light.indirect, light.radiosity};
    close_energy(ledger, balanced, light.radiosity, light.indirect);
    SolveReport& report = solution.report;
    report.groups = energy_ledger(ledger, world, report.sources);
    report.objects = object_means(world.scene, patches, ledger);
  }
  base::release(light.reflectance);
  base::release(light.emitted);
  const auto own = factors.shares.own(patches.count());
  const std::size_t begin = own.begin;
  const CoveredPatches covered(patches, factors.open);
  // row_of(row, values): fills the values of an own row.
  const auto gather_rows = [&](std::vector<float>& values, auto row_of) {
    values.resize(patches.count() * columns);
    base::parallel_chunks(own.end - begin, 4096, [&](std::size_t from, std::size_t to) {
      for (std::size_t row = from; row < to; ++row) row_of(row, &values[(begin + row) * columns]);
    });
    factors.shares.all_gather(values.data(), columns);
    covered.show_neighbours(values, columns);
  };
  const auto copy_of = [columns](const std::vector<double>& from) {
    return [&from, columns](std::size_t row, float* values) {
      std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(row * columns), columns, values);
    };
  };
  gather_rows(solution.radiosity, copy_of(light.radiosity));
  base::release(light.radiosity);
  gather_rows(solution.direct_lx, copy_of(light.direct));
  base::release(light.direct);
  const std::size_t sky_parts = scenes::earth_parts(world.scene);
  gather_rows(solution.indirect_radiosity, [&](std::size_t row, float* values) {
    const std::size_t i = begin + row;
    const Rgb diffuse = patch_diffuse(world.scene, patches, static_cast<std::uint32_t>(i));
    for (std::size_t k = 0; k < columns; ++k) {
      const auto c = static_cast<int>(k % 3);
      double reflected = diffuse[c] * light.indirect[row * columns + k];
      if (world.effects.earth_by_gather && k / 3 >= world.groups.earth &&
          k / 3 < world.groups.earth + sky_parts) {
        reflected += diffuse[c] * light.sky[i * sky_parts + k / 3 - world.groups.earth][c];
      }
      values[k] = static_cast<float>(reflected);
    }
  });
  gather_rows(solution.indirect_lx, copy_of(light.indirect));
}

// Groups with light from infinitely far away, which gives what lands.
std::vector<bool> sky_groups(const scenes::World& world) {
  std::vector<bool> is_sky(world.groups.count(), false);
  const auto mark = [&](std::size_t first, std::size_t count) {
    for (std::size_t k = 0; first != scenes::no_group && k < count; ++k) is_sky[first + k] = true;
  };
  mark(world.groups.sun, 1);
  mark(world.groups.earth, scenes::earth_parts(world.scene));
  mark(world.groups.sun_parts, world.scene.sky_parts ? world.scene.sky_parts->suns.size() : 0);
  for (std::size_t k = 0; k < world.scene.lamps.size(); ++k) {
    if (world.scene.lamps[k].kind == scenes::LampKind::Distant) mark(world.groups.lamp[k], 1);
  }
  return is_sky;
}

std::vector<GroupLedger> energy_ledger(const LedgerInput& in, const scenes::World& world,
                                       std::span<const SourceFlux> sources) {
  const std::vector<std::string>& group_names = world.groups.names;
  enum { Emitted, Landed, Absorbed, Escaped, Lines };
  const std::vector<double> sums =
      sums_over_patches(in, in.columns * Lines, [&](std::size_t i, std::size_t row, double* all) {
        const double area = in.area_m2[i];
        for (std::size_t k = 0; k < in.columns; ++k) {
          const std::size_t at = row * in.columns + k;
          const double rho = in.reflectance[row * 3 + k % 3];
          const double ends = in.factors.kept_direct.empty()
                                  ? 1.0
                                  : in.factors.kept_direct[i][static_cast<int>(k % 3)];
          double* const line = &all[k * Lines];
          line[Emitted] += area * in.emitted[at];
          line[Landed] += area * ends * in.direct[at];
          line[Absorbed] +=
              area * ((in.factors.kept[i] - rho) * in.indirect[at] + (ends - rho) * in.direct[at] +
                      in.radiosity[at] * in.factors.lost[i]);
          line[Escaped] += area * in.radiosity[at] * in.factors.escape[i];
        }
      });
  std::vector<GroupLedger> ledger(group_names.size());
  for (std::size_t g = 0; g < group_names.size(); ++g) {
    GroupLedger& line = ledger[g];
    line.name = group_names[g];
    for (int c = 0; c < 3; ++c) {
      const double* const found = &sums[(3 * g + static_cast<std::size_t>(c)) * Lines];
      line.emitted_lm[c] = found[Emitted];
      line.landed_lm[c] = found[Landed];
      line.absorbed_lm[c] = found[Absorbed];
      line.escaped_lm[c] = found[Escaped];
      const double in_all = found[Emitted] + found[Landed];
      if (in_all > 0.0) {
        line.imbalance =
            std::max(line.imbalance, std::abs(in_all - found[Absorbed] - found[Escaped]) / in_all);
      }
    }
  }
  std::vector<Rgb> of_sky(ledger.size());  // landed
  for (std::size_t g = 0; g < ledger.size(); ++g) {
    of_sky[g] = ledger[g].landed_lm;
    ledger[g].given_lm = ledger[g].emitted_lm;
  }
  for (const SourceFlux& source : sources) {
    GroupLedger& line = ledger[source.group];
    line.escaped_at_once_lm += source.escaped_lm();
    line.lost_at_once_lm += source.lost_lm();
    line.given_lm += source.emitted_lm;
    of_sky[source.group] -= source.landed_lm;
  }
  const std::vector<bool> is_sky = sky_groups(world);
  for (std::size_t g = 0; g < ledger.size(); ++g) {
    GroupLedger& line = ledger[g];
    if (is_sky[g]) line.given_lm += of_sky[g];
    const Rgb found =
        line.escaped_at_once_lm + line.lost_at_once_lm + line.emitted_lm + line.landed_lm;
    for (int c = 0; c < 3; ++c) {
      if (line.given_lm[c] <= 0.0) continue;
      line.imbalance =
          std::max(line.imbalance, std::abs(line.given_lm[c] - found[c]) / line.given_lm[c]);
    }
  }
  return ledger;
}

void close_energy(const LedgerInput& in, bool balanced, std::span<double> radiosity,
                  std::span<double> indirect) {
  // Per column the emitted light and where it ends.
  const std::vector<double> sums =
      sums_over_patches(in, in.columns * 2, [&](std::size_t i, std::size_t row, double* all) {
        for (std::size_t k = 0; k < in.columns; ++k) {
          const std::size_t at = row * in.columns + k;
          const double rho = in.reflectance[row * 3 + k % 3];
          // Balanced: by absorption, sky and black backs. Otherwise by the solver's residual.
          const double end =
              balanced ? (in.factors.kept[i] - rho) * in.indirect[at] +
                             in.radiosity[at] * (in.factors.lost[i] + in.factors.escape[i])
                       : in.radiosity[at] - rho * in.indirect[at];
          all[2 * k] += in.area_m2[i] * (in.emitted[at] + rho * in.direct[at]);
          all[2 * k + 1] += in.area_m2[i] * end;
        }
      });
  for (std::size_t at = 0; at < radiosity.size(); ++at) {
    const double all = sums[at % in.columns * 2], end = sums[at % in.columns * 2 + 1];
    if (all <= 0.0 || std::abs(all - end) > 0.01 * all) continue;
    radiosity[at] *= all / end;
    indirect[at] *= all / end;
  }
}

}  // namespace earthshine::radiosity
