// SPDX-License-Identifier: Apache-2.0
// Column sums of the form factors.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "base/ranks/ranks.h"
#include "radiosity/factors/form_factors.h"

namespace earthshine::radiosity {

// Per column j: sum_i weight(i) F_ij. Rows are divided into bands with separate sums, which are
// added in order: the result is bit-identical for any number of threads and ranks. If several ranks
// have rows of a band, each continues the sums of the previous one.
template <class Weight>
class ColumnSums {
 public:
  ColumnSums(const FormFactors& f, Weight weight)
      : f_(f), weight_(weight), count_(f.count()), own_(f.shares.own(count_)) {
    last_ = bands_;
    while (first_ < last_ && begin(first_ + 1) <= own_.begin) ++first_;
    while (first_ < last_ && (begin(last_ - 1) >= own_.end || own_.begin == own_.end)) --last_;
    if (first_ == last_) return;
    is_begun_ = begin(first_) < own_.begin;
    goes_on_ = begin(last_) > own_.end;
  }

  // For the patches whose rows are on this rank.
  [[nodiscard]] std::vector<double> find() {
    partial_.assign((last_ - first_) * count_, 0.0);
    // The last band first: another rank may be waiting for it.
    base::parallel_chunks(last_ - first_, 1, [&](std::size_t k, std::size_t) {
      if (const std::size_t band = last_ - 1 - k; band > first_ || !is_begun_) add_rows(band);
    });
    if (is_begun_) {
      base::Parcel begun(base::ranks()->receive(f_.shares.holder(own_.begin - 1)));
      begun.pass_range(sums_of(first_), count_);
      add_rows(first_);
    }
    return f_.shares.divided() ? total_of_ranks() : total_here();
  }

 private:
  [[nodiscard]] std::size_t begin(std::size_t band) const { return band * count_ / bands_; }
  [[nodiscard]] double* sums_of(std::size_t band) { return &partial_[(band - first_) * count_]; }

  void add_rows(std::size_t band) {
    double* const sums = sums_of(band);
    const std::size_t end = std::min(begin(band + 1), own_.end);
    for (std::size_t i = std::max(begin(band), own_.begin); i < end; ++i) {
      const double w = weight_(i) * f_.row_scale[i];
      if (w == 0.0) continue;
      for (std::uint64_t e = f_.row_start[i]; e < f_.row_start[i + 1]; ++e) {
        sums[f_.column[e]] += w * double(f_.hits[e]);
      }
    }
    if (!goes_on_ || band + 1 < last_) return;
    base::Parcel begun;
    begun.reserve(count_ * sizeof(double));
    begun.pass_range(sums, count_);
    base::ranks()->send(begun.take_bytes(), f_.shares.holder(own_.end));
  }

  [[nodiscard]] std::vector<double> total_here() {
    std::vector<double> total(count_);
    base::parallel_chunks(count_, 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t j = begin; j < end; ++j) {
        double sum = 0.0;
        for (std::size_t k = j; k < partial_.size(); k += count_) sum += partial_[k];
        total[j] = f_.column_scale[j] * sum;
      }
    });
    return total;
  }

  // Each rank adds the columns of its patches over the bands that ended on every rank, in the order
  // of ranks.
  [[nodiscard]] std::vector<double> total_of_ranks() {
    base::Ranks& all = *base::ranks();
    const auto ranks = static_cast<std::size_t>(all.count()),
               rank = static_cast<std::size_t>(all.number());
    const std::size_t ended = last_ - first_ - (goes_on_ ? 1 : 0);
    std::vector<std::string> to(ranks);
    for (std::size_t r = 0; r < ranks; ++r) {
      if (r == rank) continue;
      const auto [begin, end] = f_.shares.of(r);
      base::Parcel sent;
      sent.reserve(ended * (end - begin) * sizeof(double));
      for (std::size_t band = first_; band < first_ + ended; ++band) {
        sent.pass_range(sums_of(band) + begin, end - begin);
      }
      to[r] = sent.take_bytes();
    }
    std::vector<std::string> got = base::swap(all, std::move(to));
    std::vector<double> mine(own_.end - own_.begin);
    for (std::size_t r = 0; r < ranks; ++r) {
      base::Parcel theirs(std::move(got[r]));
      while (!theirs.at_end()) add_band(mine, theirs);
      for (std::size_t band = first_; r == rank && band < first_ + ended; ++band) {
        const double* const sums = sums_of(band) + own_.begin;
        for (std::size_t k = 0; k < mine.size(); ++k) mine[k] += sums[k];
      }
    }
    for (std::size_t k = 0; k < mine.size(); ++k) mine[k] *= f_.column_scale[own_.begin + k];
    return mine;
  }

  static void add_band(std::span<double> total, base::Parcel& sums) {
    std::array<double, 1024> some;  // fits in the cache
    for (std::size_t k = 0; k < total.size(); k += some.size()) {
      const std::size_t count = std::min(some.size(), total.size() - k);
      sums.pass_range(some.data(), count);
      for (std::size_t n = 0; n < count; ++n) total[k + n] += some[n];
    }
  }

  const FormFactors& f_;
  Weight weight_;
  std::size_t count_;
  base::Shares::Range own_;
  // Every band stores a sum per column: with short rows, bands need more memory than entries.
  std::size_t bands_ = std::clamp<std::size_t>(std::size_t(f_.rays_per_patch) / 4, 8, 16);
  std::size_t first_ = 0, last_ = 0;         // bands with rows here: [first_, last_)
  bool is_begun_ = false, goes_on_ = false;  // another rank begins the first, ends the last band
  std::vector<double> partial_;              // of each band
};

template <class Weight>
[[nodiscard]] std::vector<double> weighted_column_sums(const FormFactors& f, Weight weight) {
  return ColumnSums<Weight>(f, weight).find();
}

}  // namespace earthshine::radiosity
