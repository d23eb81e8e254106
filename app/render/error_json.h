// SPDX-License-Identifier: Apache-2.0
// The error of a picture, or of a solution alone, for output.
#pragma once

#include <optional>
#include <string>

#include "app/command.h"
#include "app/render/draw.h"
#include "base/files/exr_file.h"
#include "raytrace/error_budget.h"
#include "raytrace/surfaces/surface_error.h"

namespace earthshine::app {

// {"estimate", "bound_95", "wanted", "limit", "steps", "parts": {name: {"estimate", "bound_95"}},
// "not_captured", "targets"}; estimates are null if nothing is visible that could be wrong.
[[nodiscard]] Json error_json(const Drawn& drawn, std::optional<double> wanted);

[[nodiscard]] Json error_json(const Solved& light, std::optional<double> wanted);

void add_errors(base::ExrHeader& header, const Drawn& drawn);

// One line: "error 1.8 % (below 2.4 %): patches 0.6, form factors 0.4, ..."
[[nodiscard]] std::string error_text(const Drawn& drawn, std::optional<double> wanted);
[[nodiscard]] std::string error_text(const Solved& light, std::optional<double> wanted);

// Predicted further seconds until the wanted error, after `seconds`: time is inversely proportional
// to the squared error, for patches and rays. 0: none, or more time would not help.
[[nodiscard]] double seconds_to_go(const Solved& light, std::optional<double> wanted,
                                   double seconds);

// Throws StoppedShort if a limit prevented the error that the call wants.
void check_reached(const SceneInput& call, raytrace::Limit limit, double wanted);

}  // namespace earthshine::app
