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

// Gives the bytes to the reader as a file of their own in a folder where nothing else is. A reader
// may refuse them with base::Error; whatever else leaves here is a fault. At most 1 GiB of memory
// may be asked for.
void read_bytes(const Reader& reader, std::string_view bytes);

}  // namespace earthshine::fuzz
