// SPDX-License-Identifier: Apache-2.0
// Broadcasts a solution from the rank that computed it.
#pragma once

#include "base/ranks/shares.h"
#include "radiosity/solution.h"

namespace earthshine::radiosity {

// Of ranks that divide the form factors only the first one has the report on direct light and the
// ledger: broadcasts them.
void broadcast_report(const base::Shares& shares, SolveReport& report);

// Also broadcasts the four values of each patch, if only the first rank has them. The others have
// the patches and the rest of the report.
void broadcast_solution(const base::Shares& shares, Solution& solution);

}  // namespace earthshine::radiosity
