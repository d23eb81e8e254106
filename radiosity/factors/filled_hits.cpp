// SPDX-License-Identifier: Apache-2.0
#include "radiosity/factors/filled_hits.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "base/free_memory.h"
#include "base/ranks/ranks.h"
#include "radiosity/factors/column_sums.h"

namespace earthshine::radiosity {
namespace {

struct NewHit {
  std::uint32_t row, column;
  float hits;
};

// Hits to add, each on the rank that has its row.
class NewHits {
 public:
  // of_gaps: only where there is no hit yet.
  NewHits(FormFactors& f, bool of_gaps)
      : f_(f),
        of_gaps_(of_gaps),
        own_(f.shares.own(f.count())),
        rows_(own_.end - own_.begin),
        away_(f.shares.divided() ? static_cast<std::size_t>(base::ranks()->count()) : 0) {}

  void add(const NewHit& hit) {
    if (hit.row >= own_.begin && hit.row < own_.end) return take(hit);
    away_[static_cast<std::size_t>(f_.shares.holder(hit.row))].push_back(hit);
  }

  // Sends hits to the ranks of their rows; collective.
  void deliver() {
    if (!f_.shares.divided()) return;
    std::vector<std::string> to;
    for (std::vector<NewHit>& hits : away_) {
      base::Parcel sent;
      sent.pass(hits);
      base::release(hits);
      to.push_back(sent.take_bytes());
    }
    for (std::string& bytes : base::swap(*base::ranks(), std::move(to))) {
      base::Parcel got(std::move(bytes));
      std::vector<NewHit> hits;
      got.pass(hits);
      for (const NewHit& hit : hits) take(hit);
    }
  }

  // Adds to the diagonal, after all other hits.
  void add_own(std::uint32_t i, float hits) {
    Row& row = sorted_row(i);
    const std::pair<std::uint32_t, float> own(i, hits);
    row.insert(std::lower_bound(row.begin(), row.end(), own), own);
  }

  // Merges the new hits into the matrix.
  void join() {
    FormFactors old;
    old.row_start.assign(f_.count() + 1, 0);
    old.row_start.swap(f_.row_start);
    old.column.swap(f_.column);
    old.hits.swap(f_.hits);
    std::size_t most = old.hits.size();
    for (const Row& row : rows_) most += row.size();
    f_.column.reserve(most);
    f_.hits.reserve(most);
    for (std::size_t i = own_.begin; i < own_.end; ++i) {
      const Row& fresh = sorted_row(i);
      std::uint64_t e = old.row_start[i];
      auto extra = fresh.begin();
      while (e < old.row_start[i + 1] || extra != fresh.end()) {
        const bool has_old = e < old.row_start[i + 1], has_extra = extra != fresh.end();
        const bool take_old = has_old && (!has_extra || old.column[e] <= extra->first);
        const bool take_extra = has_extra && (!has_old || extra->first <= old.column[e]);
        f_.column.push_back(take_old ? old.column[e] : extra->first);
        f_.hits.push_back((take_old ? old.hits[e] : 0.0F) + (take_extra ? extra->second : 0.0F));
        if (take_old) ++e;
        if (take_extra) ++extra;
      }
      f_.row_start[i + 1] = f_.column.size();
    }
    std::fill(f_.row_start.begin() + static_cast<std::ptrdiff_t>(own_.end), f_.row_start.end(),
              f_.column.size());
  }

 private:
  using Row = std::vector<std::pair<std::uint32_t, float>>;  // columns and hits to add

  void take(const NewHit& hit) {
    if (of_gaps_ && met(hit.row, hit.column)) return;
    rows_[hit.row - own_.begin].emplace_back(hit.column, hit.hits);
  }

  // On one process, hits arrive in order.
  Row& sorted_row(std::size_t i) {
    Row& row = rows_[i - own_.begin];
    if (f_.shares.divided()) std::sort(row.begin(), row.end());
    return row;
  }

  [[nodiscard]] bool met(std::uint32_t from, std::uint32_t to) const {
    const auto begin = f_.column.begin() + static_cast<std::ptrdiff_t>(f_.row_start[from]);
    const auto end = f_.column.begin() + static_cast<std::ptrdiff_t>(f_.row_start[from + 1]);
    const auto at = std::lower_bound(begin, end, to);
    return at != end && *at == to &&
           f_.hits[static_cast<std::size_t>(at - f_.column.begin())] > 0.0F;
  }

  FormFactors& f_;
  bool of_gaps_;
  base::Shares::Range own_;
  std::vector<Row> rows_;                  // rows of this rank
  std::vector<std::vector<NewHit>> away_;  // per rank
};

}  // namespace

std::size_t borrow_starved_columns(FormFactors& f, std::span<const double> area_m2) {
  constexpr double starved = 0.01;  // of the column sum that its own row implies
  const std::vector<double> sums =
      weighted_column_sums(f, [&](std::size_t i) { return area_m2[i] * f.kept[i]; });
  const base::Shares::Range own = f.shares.own(f.count());
  const auto reached = [&](std::size_t j) {
    return sums[j - own.begin] >= starved * area_m2[j] * (1.0 - f.sky[j] - f.black[j]);
  };
  NewHits borrowed(f, false);
  std::size_t patches = 0;
  for (std::size_t j = own.begin; j < own.end; ++j) {
    if (reached(j) || f.row_start[j] == f.row_start[j + 1]) continue;
    ++patches;
    for (std::uint64_t e = f.row_start[j]; e < f.row_start[j + 1]; ++e) {
      const std::uint32_t i = f.column[e];
      if (area_m2[i] <= 0.0) continue;
      const double hits =
          double(f.hits[e]) * (area_m2[j] * f.row_scale[j]) / (area_m2[i] * f.row_scale[i]);
      borrowed.add({i, static_cast<std::uint32_t>(j), static_cast<float>(hits)});
    }
  }
  patches = f.shares.sum(patches);
  if (patches == 0) return 0;
  borrowed.deliver();
  borrowed.join();
  return patches;
}

bool keeps_its_own(const FormFactors& f, std::span<const double> area_m2, std::size_t patch) {
  return area_m2[patch] > 0.0 && f.kept[patch] > 0.0 && f.row_scale[patch] > 0.0 &&
         f.sky[patch] + f.black[patch] <= 0.0;
}

std::size_t fill_reciprocal(FormFactors& f, std::span<const double> area_m2) {
  // All entries pass between ranks; rounds reduce the peak memory.
  constexpr std::uint32_t rounds = 16;
  const auto own = f.shares.own(f.count());
  const auto begin = static_cast<std::uint32_t>(own.begin),
             end = static_cast<std::uint32_t>(own.end);
  NewHits fresh(f, true);
  for (std::uint32_t round = 0, i = begin; round < rounds; ++round) {
    for (; i < begin + (end - begin) * std::uint64_t{round + 1} / rounds; ++i) {
      for (std::uint64_t e = f.row_start[i]; e < f.row_start[i + 1]; ++e) {
        const std::uint32_t j = f.column[e];
        const double there = f.row_scale[i] * double(f.hits[e]) * area_m2[i];
        const double back = f.row_scale[j] * area_m2[j];
        if (there <= 0.0 || back <= 0.0) continue;
        fresh.add({j, i, static_cast<float>(reciprocal_share * there / back)});
      }
    }
    fresh.deliver();
  }
  for (std::uint32_t i = begin; i < end; ++i) {
    if (!keeps_its_own(f, area_m2, i)) continue;
    fresh.add_own(i, static_cast<float>(own_share / f.row_scale[i]));
  }
  const std::size_t before = f.hits.size();
  fresh.join();
  return f.shares.sum(f.hits.size() - before);
}

}  // namespace earthshine::radiosity
