// SPDX-License-Identifier: Apache-2.0
// The pages of the console, of its live preview and of `view` without their data, from console/ by
// the build: no library, no Node.js.
#pragma once

#include <string_view>

namespace earthshine::app {

[[nodiscard]] std::string_view console_style();
[[nodiscard]] std::string_view console_body();
[[nodiscard]] std::string_view console_script();
// "sha256-…" of the script, as a content security policy names it.
[[nodiscard]] std::string_view console_script_hash();

// Beside the console's style.
[[nodiscard]] std::string_view view_style();
[[nodiscard]] std::string_view view_body();
[[nodiscard]] std::string_view view_script();
[[nodiscard]] std::string_view view_script_hash();
// Of solutions.
[[nodiscard]] std::string_view solid_style();
[[nodiscard]] std::string_view solid_body();
[[nodiscard]] std::string_view solid_script();
[[nodiscard]] std::string_view solid_script_hash();

// Of `console --serve`, also beside the console's style.
[[nodiscard]] std::string_view live_style();
[[nodiscard]] std::string_view live_body();
[[nodiscard]] std::string_view live_script();
[[nodiscard]] std::string_view live_script_hash();

}  // namespace earthshine::app
