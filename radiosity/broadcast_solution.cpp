// SPDX-License-Identifier: Apache-2.0
#include "radiosity/broadcast_solution.h"

#include <string>
#include <vector>

namespace earthshine::radiosity {
namespace {

void pass(base::Parcel& parcel, GroupLedger& g) {
  parcel.pass_all(g.name, g.given_lm, g.escaped_at_once_lm, g.lost_at_once_lm, g.emitted_lm,
                  g.landed_lm, g.absorbed_lm, g.escaped_lm, g.imbalance);
}

void pass(base::Parcel& parcel, SourceFlux& s) {
  parcel.pass_all(s.name, s.group, s.emitted_lm, s.escaped_share, s.back_share, s.share_std_error,
                  s.scale, s.landed_lm);
}

void pass(base::Parcel& parcel, ObjectLight& o) {
  parcel.pass_all(o.name, o.area_m2, o.illuminance_lx, o.radiosity_lm_m2, o.back_share);
}

template <class Line>
void pass(base::Parcel& parcel, std::vector<Line>& lines) {
  std::size_t size = lines.size();
  parcel.pass(size);
  lines.resize(size);
  for (Line& line : lines) pass(parcel, line);
}

}  // namespace

void broadcast_report(const base::Shares& shares, SolveReport& report) {
  shares.broadcast([&report](base::Parcel& parcel) {
    parcel.pass_all(report.shadow_rays, report.sources_cost, report.iterations, report.residual,
                    report.solver_error);
    pass(parcel, report.groups);
    pass(parcel, report.sources);
    pass(parcel, report.objects);
  });
}

void broadcast_solution(const base::Shares& shares, Solution& solution) {
  for (std::vector<float>* const values : {&solution.radiosity, &solution.indirect_radiosity,
                                           &solution.direct_lx, &solution.indirect_lx}) {
    values->resize(solution.patches.count() * solution.columns);
    shares.broadcast(values->data(), values->size());
  }
  broadcast_report(shares, solution.report);
}

}  // namespace earthshine::radiosity
