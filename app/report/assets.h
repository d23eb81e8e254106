// SPDX-License-Identifier: Apache-2.0
// Files of report/ that the build embeds. Without Node.js at build time all but the style are
// empty.
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
