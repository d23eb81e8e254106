// SPDX-License-Identifier: Apache-2.0
// A solution from the rank that made it to those that read it.
#pragma once

#include "base/ranks/shares.h"
#include "radiosity/solution.h"

namespace earthshine::radiosity {

// Of ranks that divide the form factors the first alone knows what the report says of direct light
// and of where it went: gives it to the others.
void tell_report(const base::Shares& shares, SolveReport& report);

// The same with the four values of each patch, where the first alone has made them. The others have
// the patches and the rest of the report.
void tell_solution(const base::Shares& shares, Solution& solution);

}  // namespace earthshine::radiosity
