// SPDX-License-Identifier: Apache-2.0
#include "radiosity/objects/form_factors.h"

#include <algorithm>
#include <cmath>

#include "base/numbers/random.h"
#include "base/parallel.h"
#include "radiosity/objects/table.h"
#include "scenes/reflect/specular.h"
#include "scenes/surface_texture.h"

namespace earthshine::radiosity {
namespace {

constexpr std::uint32_t replicates = ray_replicates;
constexpr std::size_t signings = 64;

// A patch's hits by object; columns of sky and black backs follow the objects.
struct Tally {
  std::vector<std::uint32_t> start;  // per patch, and the end
  std::vector<std::uint32_t> column;
  std::vector<double> share;
};

Tally tally(const FormFactors& f, const Patches& patches, std::size_t objects) {
  Tally result;
  std::vector<double> to(objects + 2, 0.0);
  result.start.push_back(0);
  for (std::size_t i = 0; i < f.count(); ++i) {
    for (std::uint64_t e = f.row_start[i]; e < f.row_start[i + 1]; ++e) {
      to[patches.object(f.column[e])] += f.row_scale[i] * double(f.hits[e]);
    }
    to[objects] = f.sky[i];
    to[objects + 1] = f.black[i];
    for (std::size_t k = 0; k < to.size(); ++k) {
      if (to[k] == 0.0) continue;
      result.column.push_back(static_cast<std::uint32_t>(k));
      result.share.push_back(to[k]);
      to[k] = 0.0;
    }
    result.start.push_back(static_cast<std::uint32_t>(result.column.size()));
  }
  return result;
}

// Adds weight(patch) * area * share of every patch to its object's row. area_m2: open areas.
template <class Weight>
void add(const Tally& from, const Patches& patches, std::span<const double> area_m2, Weight weight,
         ObjectTable& table) {
  for (std::uint32_t i = 0; i + 1 < from.start.size(); ++i) {
    const double w = weight(i) * area_m2[i];
    double* row = table.row(patches.object(i));
    for (std::uint32_t e = from.start[i]; e < from.start[i + 1]; ++e) {
      row[from.column[e]] += w * from.share[e];
    }
  }
}

// Random signs: eight of a patch's sixteen replicates are +1, the others -1.
std::uint16_t half_of_the_replicates(std::uint64_t seed, std::size_t signing, std::size_t patch) {
  const base::Key key = base::Key(seed, base::Stream::HalfSample, patch).with(signing);
  std::uint32_t bits = 0;
  for (std::uint32_t chosen = 0, seen = 0; seen < replicates; ++seen) {
    const double odds = double(replicates / 2 - chosen) / (replicates - seen);
    if (base::uniform(key, seen) < odds) {
      bits |= 1U << seen;
      ++chosen;
    }
  }
  return static_cast<std::uint16_t>(bits);
}

double reciprocity_error(const ObjectFormFactors& o) {
  double worst = 0.0;
  for (std::size_t i = 0; i < o.F.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const double there = o.open_area_m2[i] * o.F[i][k];
      const double back = o.open_area_m2[k] * o.F[k][i];
      if (o.F[i][k] > 4.0 * o.std_error[i][k] && o.F[k][i] > 4.0 * o.std_error[k][i]) {
        worst = std::max(worst, std::abs(there - back) / std::max(there, back));
      }
    }
  }
  return worst;
}

struct Areas {
  std::vector<double> all, open;  // per object, m^2
};

ObjectFormFactors per_area(const ObjectTable& table, const Areas& areas) {
  const std::size_t n = table.objects();
  ObjectFormFactors o;
  o.area_m2 = areas.all;
  o.open_area_m2 = areas.open;
  o.F.assign(n, std::vector<double>(n, 0.0));
  o.std_error = o.F;
  o.sky.assign(n, 0.0);
  o.black = o.sky_std_error = o.black_std_error = o.sky;
  for (std::size_t i = 0; i < n; ++i) {
    if (o.open_area_m2[i] <= 0.0) {
      if (o.area_m2[i] > 0.0) o.black[i] = 1.0;  // like the row of a covered patch
      continue;
    }
    const double* row = table.row(i);
    for (std::size_t k = 0; k < n; ++k) o.F[i][k] = row[k] / o.open_area_m2[i];
    o.sky[i] = row[n] / o.open_area_m2[i];
    o.black[i] = row[n + 1] / o.open_area_m2[i];
  }
  return o;
}

double row_error(const ObjectFormFactors& o) {
  double worst = 0.0;
  for (std::size_t i = 0; i < o.F.size(); ++i) {
    if (o.area_m2[i] <= 0.0) continue;
    double sum = o.sky[i] + o.black[i] - 1.0;
    for (const double f : o.F[i]) sum += f;
    worst = std::max(worst, std::abs(sum));
  }
  return worst;
}

std::vector<double> object_areas(std::size_t objects, const Patches& patches,
                                 std::span<const double> area_m2) {
  std::vector<double> area(objects, 0.0);
  for (std::uint32_t i = 0; i < patches.count(); ++i) area[patches.object(i)] += area_m2[i];
  return area;
}

// max_i |sum_j a_j F_ij + sky + black - 1| over the patches.
double patch_row_error(const FormFactors& f) {
  double worst = 0.0;
  for (std::size_t i = 0; i < f.count(); ++i) {
    double sum = f.sky[i] + f.black[i] - 1.0;
    for (std::uint64_t e = f.row_start[i]; e < f.row_start[i + 1]; ++e) {
      const std::uint32_t j = f.column[e];
      sum += f.row_scale[i] * double(f.hits[e]) * f.column_scale[j] * f.kept[j];
    }
    worst = std::max(worst, std::abs(sum));
  }
  return worst;
}

void set_std_errors(const std::vector<ObjectTable>& signed_tables,
                    const std::vector<double>& rays_per_m2, bool joined, ObjectFormFactors& o) {
  const std::size_t n = o.F.size();
  for (std::size_t i = 0; i < n; ++i) {
    const double area = o.open_area_m2[i];
    if (area <= 0.0) continue;
    for (std::size_t k = 0; k < n + 2; ++k) {
      double square = 0.0;
      for (const ObjectTable& table : signed_tables) square += table.row(i)[k] * table.row(i)[k];
      double error = std::sqrt(square / double(signed_tables.size())) / area;
      // If all replicates agree to rounding, uses the error of one hit.
      const double other = joined && k < n ? rays_per_m2[k] : 0.0;
      const double one_hit = 1.0 / (area * (rays_per_m2[i] + other));
      if (error < 1e-3 * one_hit) error = one_hit;
      (k < n ? o.std_error[i][k] : k == n ? o.sky_std_error[i] : o.black_std_error[i]) = error;
    }
  }
}

// Two estimates of a pair that differ by more than their noise have another error, mostly from
// coincident faces (docs/theory.md, "Faces on each other"). Then half their difference is the
// error. Returns the number of such pairs.
std::size_t widen_by_disagreement(const ObjectFormFactors& cast, ObjectFormFactors& o) {
  constexpr double errors_apart = 6.0;
  std::size_t pairs = 0;
  for (std::size_t i = 0; i < o.F.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const std::vector<double>& area_m2 = cast.open_area_m2;
      const double there = area_m2[i] * cast.F[i][k], back = area_m2[k] * cast.F[k][i];
      const double noise =
          std::hypot(area_m2[i] * cast.std_error[i][k], area_m2[k] * cast.std_error[k][i]);
      const double apart = std::abs(there - back);
      if (!(apart > errors_apart * noise)) continue;
      ++pairs;
      o.std_error[i][k] = std::max(o.std_error[i][k], 0.5 * apart / area_m2[i]);
      o.std_error[k][i] = std::max(o.std_error[k][i], 0.5 * apart / area_m2[k]);
    }
  }
  return pairs;
}

}  // namespace

ObjectFormFactors object_form_factors(const scenes::Scene& scene, const Patches& patches,
                                      const FormFactors& factors) {
  ObjectTable table(scene.objects.size());
  FormFactors scaled = factors;
  for (std::size_t e = 0; e < scaled.hits.size(); ++e) {
    scaled.hits[e] *= static_cast<float>(factors.column_scale[factors.column[e]]);
  }
  const std::vector<double> open_m2 = open_areas(factors.open, patches.area_m2);
  add(
      tally(scaled, patches, table.objects()), patches, open_m2, [](std::uint32_t) { return 1.0; },
      table);
  ObjectFormFactors result =
      per_area(table, {object_areas(table.objects(), patches, patches.area_m2),
                       object_areas(table.objects(), patches, open_m2)});
  result.max_row_error = patch_row_error(factors);
  result.max_reciprocity_error = reciprocity_error(result);
  return result;
}

ObjectFormFactors object_form_factors_by_rays(const scenes::Scene& scene,
                                              const scenes::RayQuery& query, const Patches& patches,
                                              const ObjectFactorOptions& options,
                                              ObjectFactorReport& report) {
  const std::size_t objects = scene.objects.size();
  ObjectTable mean(objects);
  std::vector<ObjectTable> signed_tables(signings, ObjectTable(objects));
  Areas areas{object_areas(objects, patches, patches.area_m2), {}};
  areas.open = areas.all;
  // Signed covered area of each object, like the tables.
  std::vector<std::vector<double>> signed_covered(signings, std::vector<double>(objects, 0.0));
  report = {};
  std::vector<std::uint16_t> halves(signings * patches.count());
  base::parallel_chunks(halves.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      halves[k] = half_of_the_replicates(options.seed, k % signings, k / signings);
    }
  });
  for (std::uint32_t r = 0; r < replicates; ++r) {
    const FormFactors f =
        cast_form_factors(scene, query, patches,
                          {.rays_per_patch = options.rays_per_patch / static_cast<int>(replicates),
                           .seed = options.seed,
                           .replicate = r,
                           .leave_out_covered = true});
    const std::vector<double> open_m2 = open_areas(f.open, patches.area_m2);
    report.rays_per_patch += f.rays_per_patch;
    report.rays += f.ray_count;
    report.row_error_before = std::max(report.row_error_before, patch_row_error(f));
    const Tally hits = tally(f, patches, objects);
    const double part = 1.0 / replicates;
    add(
        hits, patches, open_m2, [part](std::uint32_t) { return part; }, mean);
    for (std::uint32_t i = 0; i < patches.count(); ++i) {
      areas.open[patches.object(i)] -= part * (patches.area_m2[i] - open_m2[i]);
    }
    base::parallel_chunks(signings, 1, [&](std::size_t b, std::size_t) {
      const auto sign = [&](std::uint32_t patch) {
        return ((halves[patch * signings + b] >> r) & 1) != 0 ? part : -part;
      };
      add(hits, patches, open_m2, sign, signed_tables[b]);
      for (std::uint32_t i = 0; i < patches.count(); ++i) {
        signed_covered[b][patches.object(i)] += sign(i) * (patches.area_m2[i] - open_m2[i]);
      }
    });
  }
  report.replicates = static_cast<int>(replicates);
  std::vector<double> rays_per_m2(objects, 0.0);
  for (std::size_t k = 0; k < objects; ++k) {
    if (areas.open[k] < 1e-12 * areas.all[k]) areas.open[k] = 0.0;  // covered, to rounding
  }
  for (std::uint32_t i = 0; i < patches.count(); ++i) {
    rays_per_m2[patches.object(i)] += report.rays_per_patch;
  }
  for (std::size_t k = 0; k < objects; ++k) {
    // Rays per open area: rays from covered points do not count.
    rays_per_m2[k] = areas.all[k] > 0.0 ? rays_per_m2[k] / areas.all[k] : 0.0;
  }
  ObjectFormFactors result = per_area(mean, areas);
  // F = x / a, where points estimate a = A - covered: dF = (dx + F dcovered) / a.
  base::parallel_chunks(signings, 1, [&](std::size_t b, std::size_t) {
    for (std::size_t i = 0; i < objects; ++i) {
      if (areas.open[i] <= 0.0) continue;
      double* row = signed_tables[b].row(i);
      for (std::size_t k = 0; k < objects + 2; ++k) {
        row[k] += mean.row(i)[k] / areas.open[i] * signed_covered[b][i];
      }
    }
  });
  set_std_errors(signed_tables, rays_per_m2, false, result);
  report.reciprocity_error_before = reciprocity_error(result);
  report.reconciled =
      !options.raw && !scenes::any_passes_light_on(scene) && !scenes::any_has_holes(scene);
  if (report.reconciled) {
    const Reconciliation reconcile(mean, areas.open, rays_per_m2);
    reconcile.apply(mean, true);
    base::parallel_chunks(
        signings, 1, [&](std::size_t b, std::size_t) { reconcile.apply(signed_tables[b], false); });
    const ObjectFormFactors cast = std::move(result);
    result = per_area(mean, areas);
    set_std_errors(signed_tables, rays_per_m2, true, result);
    report.disagreeing_pairs = widen_by_disagreement(cast, result);
  }
  result.max_row_error = report.reconciled ? row_error(result) : report.row_error_before;
  result.max_reciprocity_error = reciprocity_error(result);
  return result;
}

}  // namespace earthshine::radiosity
