// SPDX-License-Identifier: Apache-2.0
// Entries of a visibility study's study.json (docs/visibility.md lists the keys).
#pragma once

#include <string>

#include "app/command.h"
#include "studies/orbit/condition.h"

namespace earthshine::app {

// One entry per target, without its condition.
[[nodiscard]] Json outcome_json(const studies::BasisView& view, const studies::Outcome& outcome);

// One flat row, for CSV.
[[nodiscard]] Json flat_row(const Json& condition, const Json& result);

// A sentence for each camera and target of which a black back is seen: that is not the target as it
// will look.
[[nodiscard]] std::vector<std::string> black_back_notes(const Json& results);

}  // namespace earthshine::app
