// SPDX-License-Identifier: Apache-2.0
// Text from files and calls made fit for a terminal. The program writes everything that a person
// reads through this, so that no name can move the cursor, turn the direction of writing or hide.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace earthshine::base {

// Length in bytes of the UTF-8 character at the start of `text`; 0 if it is not one (overlong
// forms, surrogates and values beyond U+10FFFF included).
[[nodiscard]] std::size_t utf8_length(std::string_view text);

// Control characters below U+0020 and bytes that are not UTF-8 become \xNN; what else a terminal
// obeys or does not show (DEL, U+0080 to U+009F, marks of direction, separators of lines,
// characters without width) becomes \uNNNN, which in JSON means the same character. `kept`: control
// characters that stay.
[[nodiscard]] std::string escaped(std::string_view text, std::string_view kept = {});

}  // namespace earthshine::base
