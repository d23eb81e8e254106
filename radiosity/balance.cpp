// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "radiosity/form_factors.h"

namespace earthshine::radiosity {
namespace {

constexpr int most_sweeps = 500;
constexpr double enough = 1e-13;
constexpr double largest_scale = 1e6;

// sum_i A_i a_i row_scale_i n_ij, for every j. Rows are split in a fixed number of bands with sums
// of their own, added in order: the same bits on any number of threads.
std::vector<double> column_sums(const FormFactors& f, std::span<const double> area_m2) {
  constexpr std::size_t bands = 8;
  const std::size_t count = f.count();
  std::vector<double> partial(bands * count, 0.0);
  base::parallel_chunks(bands, 1, [&](std::size_t band, std::size_t) {
    double* sums = &partial[band * count];
    for (std::size_t i = band * count / bands; i < (band + 1) * count / bands; ++i) {
      const double weight = area_m2[i] * f.kept[i] * f.row_scale[i];
      if (weight == 0.0) continue;
      for (std::uint64_t e = f.row_start[i]; e < f.row_start[i + 1]; ++e) {
        sums[f.column[e]] += weight * double(f.hits[e]);
      }
    }
  });
  for (std::size_t band = 1; band < bands; ++band) {
    for (std::size_t j = 0; j < count; ++j) partial[j] += partial[band * count + j];
  }
  partial.resize(count);
  return partial;
}

// A patch that no ray reached has an empty column, which no scaling can fill. Reciprocity gives its
// entries: n_ij = n_ji A_j / A_i for the patches i that it saw itself.
std::size_t fill_empty_columns(FormFactors& f, std::span<const double> area_m2) {
  const std::size_t count = f.count();
  std::vector<bool> reached(count, false);
  for (std::size_t e = 0; e < f.column.size(); ++e) {
    if (f.hits[e] > 0.0F) reached[f.column[e]] = true;
  }
  std::vector<std::vector<std::pair<std::uint32_t, float>>> borrowed(count);
  std::size_t patches = 0;
  for (std::size_t j = 0; j < count; ++j) {
    if (reached[j] || f.row_start[j] == f.row_start[j + 1]) continue;
    ++patches;
    for (std::uint64_t e = f.row_start[j]; e < f.row_start[j + 1]; ++e) {
      const std::uint32_t i = f.column[e];
      const double hits = double(f.hits[e]) * area_m2[j] / area_m2[i];
      borrowed[i].emplace_back(static_cast<std::uint32_t>(j), static_cast<float>(hits));
    }
  }
  if (patches == 0) return 0;

  FormFactors old;
  old.row_start.swap(f.row_start);
  old.column.swap(f.column);
  old.hits.swap(f.hits);
  f.row_start.assign(count + 1, 0);
  for (std::size_t i = 0; i < count; ++i) {
    std::uint64_t e = old.row_start[i];
    auto extra = borrowed[i].begin();  // ascending, since j ran upward
    while (e < old.row_start[i + 1] || extra != borrowed[i].end()) {
      const bool take_extra =
          e == old.row_start[i + 1] || (extra != borrowed[i].end() && extra->first < old.column[e]);
      f.column.push_back(take_extra ? extra->first : old.column[e]);
      f.hits.push_back(take_extra ? extra->second : old.hits[e]);
      if (take_extra) {
        ++extra;
      } else {
        ++e;
      }
    }
    f.row_start[i + 1] = f.column.size();
  }
  return patches;
}

// The scaling's state beside the factors' own vectors: row_scale starts at 1 / N, hence the two
// relative scales.
struct Scaling {
  std::vector<double> row;   // relative to the raw rows
  std::vector<double> seen;  // raw F_i,sky + F_i,black
};

// Patches that exchange light, directly or by way of others, by the lowest patch of their group.
// Scaling a group's rows up and its columns down by one factor changes nothing but its shares of
// sky and black backs: a group that is nearly closed would creep toward the right factor by its
// small open share per sweep.
std::vector<std::uint32_t> exchange_groups(const FormFactors& f) {
  std::vector<std::uint32_t> parent(f.count());
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (std::uint32_t i = 0; i < f.count(); ++i) {
    for (std::uint64_t e = f.row_start[i]; e < f.row_start[i + 1]; ++e) {
      if (f.hits[e] <= 0.0F) continue;
      const std::uint32_t a = root(i), b = root(f.column[e]);
      parent[std::max(a, b)] = std::min(a, b);
    }
  }
  for (std::uint32_t i = 0; i < f.count(); ++i) parent[i] = root(i);
  return parent;
}

// What leaves a group is the same by its rows and by its columns once both are right (sum the two
// laws with weights A a); half the step in between is taken at once.
void share_out(FormFactors& f, std::span<const double> area_m2, const Scaling& scaling,
               const std::vector<std::uint32_t>& group) {
  std::vector<double> by_rows(f.count(), 0.0), by_columns(f.count(), 0.0);
  for (std::size_t i = 0; i < f.count(); ++i) {
    const double open = area_m2[i] * f.kept[i] * scaling.seen[i];
    by_rows[group[i]] += open * scaling.row[i];
    by_columns[group[i]] += open * f.column_scale[i];
  }
  for (std::size_t i = 0; i < f.count(); ++i) {
    const double rows = by_rows[group[i]], columns = by_columns[group[i]];
    if (rows > 0.0 && columns > 0.0) f.column_scale[i] *= std::sqrt(rows / columns);
  }
}

void rescale_rows(FormFactors& f, const std::vector<double>& raw_row_scale, Scaling& scaling) {
  base::parallel_chunks(f.count(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      double landed = 0.0;
      for (std::uint64_t e = f.row_start[i]; e < f.row_start[i + 1]; ++e) {
        const std::uint32_t j = f.column[e];
        landed += double(f.hits[e]) * f.kept[j] * f.column_scale[j];
      }
      const double sum = landed * raw_row_scale[i] + scaling.seen[i];
      scaling.row[i] = sum > 0.0 ? 1.0 / sum : 1.0;
      f.row_scale[i] = raw_row_scale[i] * scaling.row[i];
    }
  });
}

}  // namespace

BalanceReport balance(FormFactors& factors, std::span<const double> area_m2) {
  BalanceReport report;
  const std::size_t count = factors.count();
  const double total = std::accumulate(area_m2.begin(), area_m2.end(), 0.0);
  Scaling scaling{std::vector<double>(count, 1.0), std::vector<double>(count)};
  for (std::size_t i = 0; i < count; ++i) scaling.seen[i] = factors.sky[i] + factors.black[i];
  const auto column_sum = [&](const std::vector<double>& sums, std::size_t j) {
    return sums[j] + area_m2[j] * scaling.seen[j];
  };
  const auto defect = [&](const std::vector<double>& sums) {
    double sum = 0.0;
    for (std::size_t j = 0; j < count; ++j) {
      sum += std::abs(factors.column_scale[j] * column_sum(sums, j) - area_m2[j]);
    }
    return total > 0.0 ? sum / total : 0.0;
  };
  report.before = defect(column_sums(factors, area_m2));
  report.borrowed = fill_empty_columns(factors, area_m2);
  const std::vector<double> raw_row_scale = factors.row_scale;
  rescale_rows(factors, raw_row_scale, scaling);
  std::vector<double> sums = column_sums(factors, area_m2);
  report.after = defect(sums);
  const std::vector<std::uint32_t> group = exchange_groups(factors);
  for (; report.sweeps < most_sweeps && report.after > enough; ++report.sweeps) {
    for (std::size_t j = 0; j < count; ++j) {
      const double sum = column_sum(sums, j);
      // The bound stops a column that too few rays reached to ever fill from running off to
      // infinity.
      if (sum > 0.0) factors.column_scale[j] = std::min(area_m2[j] / sum, largest_scale);
    }
    share_out(factors, area_m2, scaling, group);
    rescale_rows(factors, raw_row_scale, scaling);
    sums = column_sums(factors, area_m2);
    const double previous = report.after;
    report.after = defect(sums);
    // Rounding is reached, or the pattern of hits allows no better.
    if (report.after > 0.999 * previous && report.sweeps > 50) break;
  }
  report.balanced = report.after <= 1e-12;
  for (std::size_t i = 0; i < count; ++i) {
    factors.sky[i] *= scaling.row[i];
    factors.black[i] *= scaling.row[i];
    factors.sky_illuminance[i] *= scaling.row[i];
    factors.escape[i] *= factors.column_scale[i];
    factors.lost[i] *= factors.column_scale[i];
  }
  return report;
}

}  // namespace earthshine::radiosity
