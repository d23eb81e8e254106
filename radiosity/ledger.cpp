// SPDX-License-Identifier: Apache-2.0
#include "radiosity/ledger.h"

#include <algorithm>
#include <cmath>

namespace earthshine::radiosity {

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
