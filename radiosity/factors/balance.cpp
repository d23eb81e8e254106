// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "base/free_memory.h"
#include "radiosity/factors/filled_hits.h"
#include "radiosity/factors/form_factors.h"
#include "radiosity/factors/scaling.h"

namespace earthshine::radiosity {
namespace {

constexpr int most_sweeps = 500;  // passes over the matrix and its transpose
constexpr int plain_sweeps = 4;

// Termination criteria.
struct Patience {
  // Of conjugate gradients: if a scaling exists, about ten passes reduce the defect to a tenth.
  int passes_a_step;
  double least_gain;  // a step that leaves a larger share of the defect is the last one
};
// The hits as cast may have no scaling: then the defect stagnates, or decreases by about e per step
// while scales diverge and remove hits that fit nowhere.
constexpr Patience with_hits{60, 0.25};
// Filled hits have a scaling: only rounding ends the iteration.
constexpr Patience with_filled{most_sweeps, 0.999};

// Iterates until the defect is at most `enough` or a criterion ends it.
void iterate(Scaling& scaling, double enough, const Patience& patience, BalanceReport& report) {
  int passes = 0;
  report.after = scaling.defect();
  while (passes < most_sweeps && report.after > enough) {
    const double previous = report.after;
    if (passes < plain_sweeps) {
      scaling.sweep();
      ++passes;
    } else {
      passes += scaling.newton_step(std::min(patience.passes_a_step, most_sweeps - passes));
    }
    report.after = scaling.defect();
    if (report.after > patience.least_gain * previous && passes > plain_sweeps) break;
  }
  report.sweeps += passes;
}

// Returns whether hits had to be added.
bool find_scales(Scaling& scaling, double enough, BalanceReport& report) {
  constexpr double rounding = 1e-12;
  scaling.start();
  iterate(scaling, enough, with_hits, report);
  const bool fills = report.after > std::max(enough, rounding);
  if (fills) {
    report.filled = scaling.fill();
    iterate(scaling, enough, with_filled, report);
  }
  report.balanced = report.after <= rounding;
  if (!report.balanced) report.worst = scaling.worst();
  return fills;
}

}  // namespace

BalanceReport balance(FormFactors& factors, std::span<const double> area_m2, double enough) {
  BalanceReport report;
  if (factors.count() == 0) {
    report.balanced = true;
    return report;
  }
  report.before = Scaling(factors, area_m2).defect();
  report.borrowed = borrow_starved_columns(factors, area_m2);
  Scaling scaling(factors, area_m2);
  if (find_scales(scaling, enough, report)) {
    report.held = scaling.held();
    if (report.balanced) report.worst = scaling.holds_most();
  }
  scaling.finish();
  base::give_back_freed_memory(factors.entry_bytes());
  return report;
}

}  // namespace earthshine::radiosity
