// SPDX-License-Identifier: Apache-2.0
// Which build of the program this is.
#pragma once

#include <string>

namespace earthshine::app {

// The digest that the linker took of all code and constants (the ELF note GNU build-id), as hex
// digits: another compiler, option or line of source gives another. Throws base::Error (Work) in a
// program that was linked without.
[[nodiscard]] const std::string& build_id();

}  // namespace earthshine::app
