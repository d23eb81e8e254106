// SPDX-License-Identifier: Apache-2.0
// Every reader of files that come from elsewhere, as a function that a fuzzer can call.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

namespace earthshine::fuzz {

struct Reader {
  std::string_view name;    // of its corpus, tests/fuzz/corpus/NAME, and for ./dev fuzz NAME
  std::string_view ending;  // of the file that it reads
  void (*read)(const std::filesystem::path& file);
};

[[nodiscard]] std::span<const Reader> readers();

// Writes the bytes as the only file of a folder and calls the reader. A reader may refuse them with
// base::Error; any other exception is a fault. At most 1 GiB of memory may be requested.
void read_bytes(const Reader& reader, std::string_view bytes);

}  // namespace earthshine::fuzz
