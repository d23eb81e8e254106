// SPDX-License-Identifier: Apache-2.0
#include "radiosity/factors/filled_hits.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "radiosity/factors/column_sums.h"

namespace earthshine::radiosity {
namespace {

// Per row: columns, ascending, and hits to add there.
using NewHits = std::vector<std::vector<std::pair<std::uint32_t, float>>>;

void add_hits(FormFactors& f, const NewHits& fresh) {
  const std::size_t count = f.count();
  FormFactors old;
  old.row_start.swap(f.row_start);
  old.column.swap(f.column);
  old.hits.swap(f.hits);
  f.row_start.assign(count + 1, 0);
  for (std::size_t i = 0; i < count; ++i) {
    std::uint64_t e = old.row_start[i];
    auto extra = fresh[i].begin();
    while (e < old.row_start[i + 1] || extra != fresh[i].end()) {
      const bool has_old = e < old.row_start[i + 1], has_extra = extra != fresh[i].end();
      const bool take_old = has_old && (!has_extra || old.column[e] <= extra->first);
      const bool take_extra = has_extra && (!has_old || extra->first <= old.column[e]);
      f.column.push_back(take_old ? old.column[e] : extra->first);
      f.hits.push_back((take_old ? old.hits[e] : 0.0F) + (take_extra ? extra->second : 0.0F));
      if (take_old) ++e;
      if (take_extra) ++extra;
    }
    f.row_start[i + 1] = f.column.size();
  }
}

bool met(const FormFactors& f, std::uint32_t from, std::uint32_t to) {
  const auto begin = f.column.begin() + static_cast<std::ptrdiff_t>(f.row_start[from]);
  const auto end = f.column.begin() + static_cast<std::ptrdiff_t>(f.row_start[from + 1]);
  const auto at = std::lower_bound(begin, end, to);
  return at != end && *at == to && f.hits[static_cast<std::size_t>(at - f.column.begin())] > 0.0F;
}

}  // namespace

std::size_t borrow_starved_columns(FormFactors& f, std::span<const double> area_m2) {
  constexpr double starved = 0.01;  // share of what a column should hold by its own row
  const std::size_t count = f.count();
  const std::vector<double> sums =
      weighted_column_sums(f, [&](std::size_t i) { return area_m2[i] * f.kept[i]; });
  const auto reached = [&](std::size_t j) {
    return sums[j] >= starved * area_m2[j] * (1.0 - f.sky[j] - f.black[j]);
  };
  NewHits borrowed(count);
  std::size_t patches = 0;
  for (std::size_t j = 0; j < count; ++j) {
    if (reached(j) || f.row_start[j] == f.row_start[j + 1]) continue;
    ++patches;
    for (std::uint64_t e = f.row_start[j]; e < f.row_start[j + 1]; ++e) {
      const std::uint32_t i = f.column[e];
      if (area_m2[i] <= 0.0) continue;
      const double hits =
          double(f.hits[e]) * (area_m2[j] * f.row_scale[j]) / (area_m2[i] * f.row_scale[i]);
      borrowed[i].emplace_back(static_cast<std::uint32_t>(j), static_cast<float>(hits));
    }
  }
  if (patches > 0) add_hits(f, borrowed);
  return patches;
}

bool keeps_its_own(const FormFactors& f, std::span<const double> area_m2, std::size_t patch) {
  return area_m2[patch] > 0.0 && f.kept[patch] > 0.0 && f.row_scale[patch] > 0.0 &&
         f.sky[patch] + f.black[patch] <= 0.0;
}

std::size_t fill_both_ways(FormFactors& f, std::span<const double> area_m2) {
  const auto count = static_cast<std::uint32_t>(f.count());
  NewHits fresh(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    for (std::uint64_t e = f.row_start[i]; e < f.row_start[i + 1]; ++e) {
      const std::uint32_t j = f.column[e];
      const double there = f.row_scale[i] * double(f.hits[e]) * area_m2[i];
      const double back = f.row_scale[j] * area_m2[j];
      if (there <= 0.0 || back <= 0.0 || met(f, j, i)) continue;
      fresh[j].emplace_back(i, static_cast<float>(reciprocal_share * there / back));
    }
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!keeps_its_own(f, area_m2, i)) continue;
    const std::pair<std::uint32_t, float> own(i, static_cast<float>(own_share / f.row_scale[i]));
    fresh[i].insert(std::lower_bound(fresh[i].begin(), fresh[i].end(), own), own);
  }
  const std::size_t before = f.hits.size();
  add_hits(f, fresh);
  return f.hits.size() - before;
}

}  // namespace earthshine::radiosity
