// SPDX-License-Identifier: Apache-2.0
#include "tests/validation/entry_errors.h"

#include <algorithm>
#include <cmath>

namespace earthshine::radiosity {
namespace {

constexpr std::uint32_t replicates = 8;
constexpr std::size_t classes = 32;

// Class k has mean hits in [2^(k-4), 2^(k-3)).
std::size_t class_of(double hits) {
  const double k = std::floor(std::log2(hits)) + 4.0;
  return static_cast<std::size_t>(std::clamp(k, 0.0, double(classes - 1)));
}

struct Class {
  double spread = 0.0, binomial = 0.0, hits = 0.0, entries = 0.0;
};

}  // namespace

double RayErrorLaw::variance(double found) const {
  const double n = std::clamp(found, 1.0, double(rays_per_patch) - 1.0);
  double g = 1.0;
  if (!hits.empty()) {
    const auto above = std::upper_bound(hits.begin(), hits.end(), n);
    if (above == hits.begin()) {
      g = gain.front();
    } else if (above == hits.end()) {
      g = gain.back();
    } else {
      const auto k = static_cast<std::size_t>(above - hits.begin());
      const double t = std::log(n / hits[k - 1]) / std::log(hits[k] / hits[k - 1]);
      g = gain[k - 1] + t * (gain[k] - gain[k - 1]);
    }
  }
  const double share = n / rays_per_patch;
  return g * share * (1.0 - share) / rays_per_patch;
}

RayErrorLaw measure_error_law(const scenes::Scene& scene, const scenes::RayQuery& query,
                              const Patches& patches, const FormFactorOptions& options,
                              std::size_t pilots) {
  std::vector<std::uint32_t> rows;
  const std::size_t step =
      std::max<std::size_t>(1, patches.count() / std::max<std::size_t>(1, pilots));
  for (std::size_t i = step / 2; i < patches.count(); i += step) {
    rows.push_back(static_cast<std::uint32_t>(i));
  }
  RayErrorLaw law;
  std::vector<FormFactors> cast;
  for (std::uint32_t r = 0; r < replicates; ++r) {
    FormFactorOptions of = options;
    of.replicate = options.replicate + 1 + r;
    cast.push_back(cast_rows(scene, query, patches, rows, of));
  }
  law.rays_per_patch = cast.front().rays_per_patch;
  std::vector<Class> found(classes);
  std::vector<double> sum(patches.count(), 0.0), squares(patches.count(), 0.0);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    std::vector<std::uint32_t> met;
    for (const FormFactors& f : cast) {
      for (std::uint64_t e = f.row_start[row]; e < f.row_start[row + 1]; ++e) {
        const double n = double(f.hits[e]);
        if (sum[f.column[e]] == 0.0) met.push_back(f.column[e]);
        sum[f.column[e]] += n;
        squares[f.column[e]] += n * n;
      }
    }
    for (const std::uint32_t j : met) {
      const double mean = sum[j] / replicates;
      Class& c = found[class_of(mean)];
      c.spread += (squares[j] - sum[j] * mean) / (replicates - 1);
      c.binomial += mean * (1.0 - mean / law.rays_per_patch);
      c.hits += mean;
      c.entries += 1.0;
      sum[j] = squares[j] = 0.0;
    }
  }
  for (const Class& c : found) {
    // Classes of few entries are inaccurate: 20 entries of 7 degrees of freedom give 12 %.
    if (c.entries < 20.0 || c.binomial <= 0.0) continue;
    law.hits.push_back(c.hits / c.entries);
    law.gain.push_back(c.spread / c.binomial);
  }
  return law;
}

double entry_std_error(const RayErrorLaw& law, const FormFactors& f, std::size_t row,
                       std::uint64_t entry) {
  const double scale = f.row_scale[row] * f.column_scale[f.column[entry]] * f.rays_per_patch;
  return scale * std::sqrt(law.variance(double(f.hits[entry])));
}

double row_std_error(const RayErrorLaw& law, const FormFactors& f, std::size_t row) {
  // The mean of a count over scramblings is its expectation, zeros included, so that the sum over
  // the entries with hits estimates the sum over all.
  double variance = 0.0;
  for (std::uint64_t e = f.row_start[row]; e < f.row_start[row + 1]; ++e) {
    const double error = entry_std_error(law, f, row, e);
    variance += error * error;
  }
  return std::sqrt(variance);
}

}  // namespace earthshine::radiosity
