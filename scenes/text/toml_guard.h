// SPDX-License-Identifier: Apache-2.0
// What toml++ must not be given: some characters outside strings end in undefined behaviour, and
// deeply dotted keys in a stack overflow (both measured on 3.3 and 3.4).
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace earthshine::scenes {

inline constexpr std::size_t max_toml_bytes = std::size_t{1} << 20;
inline constexpr std::size_t max_toml_line_bytes = std::size_t{8} << 10;
inline constexpr int max_toml_dots = 16;  // in one key

// Throws base::Error (Input) unless the text is at most 1 MiB of UTF-8 in lines of at most 8 KiB,
// free of NUL bytes, ASCII outside strings and comments, and its keys have at most 16 dots.
void guard_toml(std::string_view text, const std::string& file);

}  // namespace earthshine::scenes
