// SPDX-License-Identifier: Apache-2.0
// What `inspect` prints: tables of objects, surfaces, materials and lights.
#pragma once

#include <string>

#include "app/command.h"
#include "app/json.h"
#include "scenes/scene.h"

namespace earthshine::app {

// report: as `inspect --json` has it.
[[nodiscard]] std::string inspect_text(const Json& report);

// What follows from a scene's [orbit], for reports.

// null without [orbit], and of one with a trajectory; else altitude_m, period_s, beta_deg, position_deg, time_s (since orbit
// noon), latitude_deg, attitude and attitude_table (one of them null), penumbra and umbra (each
// null, or begin_deg, end_deg, begin_s, end_s).
[[nodiscard]] Json orbit_facts(const scenes::Scene& scene);

// One line of them.
[[nodiscard]] std::string orbit_line(const Json& facts);

// What follows from its trajectory and [time]; null without. Moments are UTC.
[[nodiscard]] Json mission_facts(const scenes::Scene& scene);
[[nodiscard]] std::string mission_lines(const Json& facts);

}  // namespace earthshine::app
