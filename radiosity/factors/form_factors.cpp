// SPDX-License-Identifier: Apache-2.0
#include "radiosity/factors/form_factors.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "base/free_memory.h"
#include "base/ranks/ranks.h"
#include "radiosity/factors/covered_patches.h"
#include "radiosity/factors/patch_rays.h"
#include "radiosity/factors/row_caster.h"

namespace earthshine::radiosity {
namespace {

// a = 1 - mirror - transmit, as luminance: the three channels share one matrix.
std::vector<double> kept_shares(const scenes::Scene& scene, const Patches& patches) {
  std::vector<double> kept(patches.count());
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const scenes::Material& m = scene.materials[patches.material(static_cast<std::uint32_t>(i))];
    kept[i] = m.passes_light_on()
                  ? std::clamp(1.0 - base::luminance(m.mirror + m.transmit), 0.0, 1.0)
                  : 1.0;
  }
  return kept;
}

// Starts of bands with about equal numbers of rays, and the end of the last one.
std::vector<std::size_t> cut_in_bands(const Patches& patches, std::span<const std::uint32_t> rows,
                                      const std::vector<std::uint32_t>& runs) {
  constexpr std::uint32_t runs_of_a_band = 64;
  std::vector<std::size_t> start = {0};
  std::uint32_t in_band = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    in_band += runs.empty() ? 1 : runs[patches.object(rows[i])];
    if (in_band < runs_of_a_band && i + 1 < rows.size()) continue;
    start.push_back(i + 1);
    in_band = 0;
  }
  return start;
}

// Joins the bands' data except entries, and computes where each row's entries start.
void join_rows(std::vector<Band>& bands, FormFactors& factors) {
  // A single band was cast by every rank.
  const bool divided = bands.size() > 1 && base::ranks() != nullptr;
  std::vector<double> cost;
  for (Band& band : bands) {
    for (const Row& row : band.rows) {
      if (divided) cost.push_back(1.0 + row.entries);
      factors.ray_count += row.rays;
    }
    factors.sky_illuminance.insert(factors.sky_illuminance.end(), band.sky_illuminance.begin(),
                                   band.sky_illuminance.end());
    base::release(band.sky_illuminance);
    for (std::size_t o = 0; o < band.back_hits.size(); ++o) {
      factors.back_hits[o] += band.back_hits[o];
    }
  }
  if (divided) factors.shares = base::Shares(cost, patches_a_sum(cost.size()));
  const auto [begin, end] = factors.shares.own(factors.count());
  std::size_t i = 0;
  for (const Band& band : bands) {
    for (const Row& row : band.rows) {
      const bool is_here = i >= begin && i < end;
      factors.row_start[i + 1] = factors.row_start[i] + (is_here ? row.entries : 0);
      ++i;
    }
  }
  factors.column.reserve(factors.row_start[i]);  // allocated lazily
  factors.hits.reserve(factors.row_start[i]);
}

// Rounds in which the bands' entries move to the matrix. The memory of each round is then free,
// which limits the duplicated data, and the data in transit between ranks.
constexpr std::size_t rounds = 16;

// Moves the bands' entries to the matrix and empties the bands.
void join_entries(std::vector<Band>& bands, FormFactors& factors) {
  for (std::size_t round = 0, k = 0; round < rounds; ++round) {
    for (; k < bands.size() * (round + 1) / rounds; ++k) {
      Band& band = bands[k];
      factors.column.insert(factors.column.end(), band.column.begin(), band.column.end());
      factors.hits.insert(factors.hits.end(), band.hits.begin(), band.hits.end());
      base::release(band.column);
      base::release(band.hits);
    }
    base::give_back_freed_memory(factors.entry_bytes());
  }
}

// As join_entries, if each rank has the bands that it cast: moves every row to its rank.
void deal_entries(std::vector<Band>& bands, FormFactors& factors) {
  base::Ranks& all = *base::ranks();
  std::size_t first = 0;  // row of the band
  for (std::size_t round = 0, k = 0; round < rounds; ++round) {
    std::vector<base::Parcel> sent(static_cast<std::size_t>(all.count()));
    for (; k < bands.size() * (round + 1) / rounds; first += bands[k++].rows.size()) {
      Band& band = bands[k];
      std::size_t e = 0;
      for (std::size_t r = 0; r < band.rows.size() && e < band.column.size(); ++r) {
        std::size_t row = first + r;
        base::Parcel& parcel = sent[static_cast<std::size_t>(factors.shares.holder(row))];
        parcel.pass(row);
        parcel.pass_range(&band.column[e], band.rows[r].entries);
        parcel.pass_range(&band.hits[e], band.rows[r].entries);
        e += band.rows[r].entries;
      }
      base::release(band.column);
      base::release(band.hits);
    }
    factors.column.resize(factors.row_start[first]);
    factors.hits.resize(factors.row_start[first]);
    std::vector<std::string> to;
    for (base::Parcel& parcel : sent) to.push_back(parcel.take_bytes());
    for (std::string& bytes : base::swap(all, std::move(to))) {
      base::Parcel got(std::move(bytes));
      while (!got.at_end()) {
        std::size_t row = 0;
        got.pass(row);
        const std::uint64_t e = factors.row_start[row];
        const std::size_t entries = factors.row_start[row + 1] - e;
        got.pass_range(factors.column.data() + e, entries);
        got.pass_range(factors.hits.data() + e, entries);
      }
    }
    base::give_back_freed_memory(factors.entry_bytes());
  }
}

// Sets the shares of sky and black backs, and the row scale that closes the row exactly.
void close_row(FormFactors& factors, std::size_t i, const Row& row) {
  // Equal to the number of rays except for the rounding of mirrors' weights.
  const double all = row.landed + row.sky + row.black;
  if (all <= 0.0) {  // completely covered
    factors.black[i] = factors.lost[i] = 1.0;
    return;
  }
  factors.row_scale[i] = 1.0 / all;
  factors.sky[i] = factors.escape[i] = row.sky / all;
  factors.black[i] = factors.lost[i] = row.black / all;
}

}  // namespace

FormFactors cast_form_factors(const scenes::Scene& scene, const scenes::RayQuery& query,
                              const Patches& patches, const FormFactorOptions& options,
                              const SkyRadiance& sky) {
  std::vector<std::uint32_t> rows(patches.count());
  std::iota(rows.begin(), rows.end(), 0U);
  FormFactors factors = cast_rows(scene, query, patches, rows, options, sky);
  if (!factors.open.share.empty()) lose_hits_on_covered(factors);
  return factors;
}

FormFactors cast_rows(const scenes::Scene& scene, const scenes::RayQuery& query,
                      const Patches& patches, std::span<const std::uint32_t> rows,
                      const FormFactorOptions& options, const SkyRadiance& sky) {
  const std::size_t count = rows.size();
  FormFactors factors;
  factors.rays_per_patch = static_cast<int>(
      std::bit_ceil(std::max(static_cast<std::uint32_t>(std::max(1, options.rays_per_patch)),
                             static_cast<std::uint32_t>(scenes::RayPacket::width))));
  factors.kept = kept_shares(scene, patches);
  for (std::uint32_t i = 0; !query.specular_paths().empty() && i < patches.count(); ++i) {
    factors.kept_direct.push_back(query.specular_paths().kept(
        patches.facets[patches.facet[i]].triangle, patches.is_back[i] == 0));
  }
  factors.sky.assign(count, 0.0);
  factors.black.assign(count, 0.0);
  factors.escape.assign(count, 0.0);
  factors.lost.assign(count, 0.0);
  factors.row_scale.assign(count, 0.0);
  factors.column_scale.assign(patches.count(), 1.0);

  factors.row_start.assign(count + 1, 0);
  factors.back_hits.assign(scene.objects.size(), 0.0);

  std::vector<std::uint32_t> runs;
  if (options.know_objects) runs = object_runs(scene, patches, factors.rays_per_patch);
  const std::vector<std::size_t> band_start = cut_in_bands(patches, rows, runs);
  std::vector<Band> bands(band_start.size() - 1);
  const RowCaster caster(scene, query, patches, factors.kept, options,
                         static_cast<std::uint32_t>(factors.rays_per_patch), runs, sky);
  const auto cast = [&](std::size_t band) {
    thread_local HitCounter counter(0);
    if (counter.patches() < patches.count()) counter = HitCounter(patches.count());
    bands[band].back_hits.assign(scene.objects.size(), 0.0);
    for (std::size_t i = band_start[band]; i < band_start[band + 1]; ++i) {
      Band& found = bands[band];
      caster.cast(rows[i], counter, found);
      for (std::size_t e = found.column.size() - found.rows.back().entries; e < found.column.size();
           ++e) {
        found.rows.back().landed += double(found.hits[e]) * factors.kept[found.column[e]];
      }
    }
    bands[band].column.shrink_to_fit();
    bands[band].hits.shrink_to_fit();
  };
  base::share_loop(bands.size(), cast, [&](std::size_t band, base::Parcel& parcel) {
    Band& found = bands[band];
    parcel.pass(found.rows);
    parcel.pass(found.back_hits);
    parcel.pass(found.sky_illuminance);
  });
  join_rows(bands, factors);
  factors.shares.divided() ? deal_entries(bands, factors) : join_entries(bands, factors);
  std::size_t i = 0;
  bool any_covered = false;
  for (const Band& band : bands) {
    for (const Row& row : band.rows) {
      any_covered = any_covered || row.open < row.sent;
      close_row(factors, i++, row);
    }
  }
  if (!any_covered) return factors;
  factors.open.bodies = caster.bodies();
  for (const Band& band : bands) {
    for (const Row& row : band.rows) {
      factors.open.share.push_back(double(row.open) / row.sent);
    }
  }
  return factors;
}

}  // namespace earthshine::radiosity
