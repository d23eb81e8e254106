// SPDX-License-Identifier: Apache-2.0
// A picture's error budget as the commands show it.
#pragma once

#include <optional>
#include <string>

#include "app/command.h"
#include "base/exr_file.h"
#include "studies/error_budget.h"
#include "studies/surface_error.h"

namespace earthshine::app {

// {"estimate", "bound_95", "wanted", "parts": {name: {"estimate", "bound_95"}}, "not_captured",
// "targets"}; estimates are null where nothing is seen that could be wrong.
[[nodiscard]] Json error_json(const studies::ErrorBudget& budget, std::optional<double> wanted);

[[nodiscard]] Json error_json(const studies::SurfaceError& error, std::optional<double> wanted);

void add_errors(base::ExrHeader& header, const studies::ErrorBudget& budget);

// One line: "error 1.8 % (below 2.4 %): patches 0.6, form factors 0.4, ..."
[[nodiscard]] std::string error_text(const studies::ErrorBudget& budget);
[[nodiscard]] std::string error_text(const studies::SurfaceError& error);

}  // namespace earthshine::app
