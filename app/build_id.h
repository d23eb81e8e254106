// SPDX-License-Identifier: Apache-2.0
// Identifies the build of the program.
#pragma once

#include <string>

namespace earthshine::app {

// The linker's digest of all code and constants (the ELF note GNU build-id), as hex digits: another
// compiler, option or source gives another id. Throws base::Error (Work) if the program was linked
// without it.
[[nodiscard]] const std::string& build_id();

}  // namespace earthshine::app
