// SPDX-License-Identifier: Apache-2.0
// What report/ puts into the program at build time. All but the style are empty where there was no
// Node.js to bundle the script.
#pragma once

#include <string_view>

namespace earthshine::app {

[[nodiscard]] std::string_view report_style();
[[nodiscard]] std::string_view report_script();
// "sha256-…" of the script, as a content security policy names it.
[[nodiscard]] std::string_view report_script_hash();
// The libraries in the script and their licences, plain text.
[[nodiscard]] std::string_view report_licences();

}  // namespace earthshine::app
