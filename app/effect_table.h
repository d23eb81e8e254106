// SPDX-License-Identifier: Apache-2.0
// The table of effects that `plan` prints and `render --report` writes.
#pragma once

#include <string>
#include <vector>

#include "app/command.h"
#include "app/render_call.h"

namespace earthshine::app {

// {"effect", "runs", "why"} per effect, the stages of the CCTV cameras among them as "cctv: glare".
[[nodiscard]] Json effect_rows(const LoadedScene& loaded, const RenderCall& call,
                               const scenes::Asked& asked);

// As columns; cells that a row has no value for stay empty.
[[nodiscard]] std::string effect_text(const Json& rows);

}  // namespace earthshine::app
