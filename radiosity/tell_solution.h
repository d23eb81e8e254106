// SPDX-License-Identifier: Apache-2.0
// A solution from the rank that made it to those that read it.
#pragma once

#include "base/ranks/shares.h"
#include "radiosity/solution.h"

namespace earthshine::radiosity {

// Of ranks that divide the form factors the first has made the four values of each patch, and what
// the report says of direct light, of the linear solve and of where light went: gives them to the
// others, who have the patches and the rest of the report.
void tell_solution(const base::Shares& shares, Solution& solution);

}  // namespace earthshine::radiosity
