// SPDX-License-Identifier: Apache-2.0
// What `inspect` prints: tables of objects, surfaces, materials and lights.
#pragma once

#include <string>

#include "app/json.h"

namespace earthshine::app {

// report: as `inspect --json` has it.
[[nodiscard]] std::string inspect_text(const Json& report);

}  // namespace earthshine::app
