// SPDX-License-Identifier: Apache-2.0
// Text of `inspect`: tables of objects, surfaces, materials and lights.
#pragma once

#include <string>

#include "app/command.h"
#include "app/json.h"
#include "scenes/scene.h"

namespace earthshine::app {

// report: of `inspect --json`.
[[nodiscard]] std::string inspect_text(const Json& report);

// Data derived from a scene's [orbit], for reports.

// null without [orbit], and for one with a trajectory. Otherwise altitude_m, period_s, beta_deg,
// position_deg, time_s (since orbit noon), latitude_deg, attitude and attitude_table (one of them
// null), penumbra and umbra (each null, or begin_deg, end_deg, begin_s, end_s).
[[nodiscard]] Json orbit_facts(const scenes::Scene& scene);

// A line of text.
[[nodiscard]] std::string orbit_line(const Json& facts);

// Data derived from a trajectory and [time]; null without. Times are UTC.
[[nodiscard]] Json mission_facts(const scenes::Scene& scene);
[[nodiscard]] std::string mission_lines(const Json& facts);

}  // namespace earthshine::app
