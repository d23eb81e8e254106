// SPDX-License-Identifier: Apache-2.0
// libFuzzer's entry: EARTHSHINE_FUZZ names the reader. `./dev fuzz` builds and runs it.
#include <cstdint>
#include <cstdlib>

#include "tests/fuzz/readers.h"

// libFuzzer calls it. NOLINTNEXTLINE(readability-identifier-naming)
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const earthshine::fuzz::Reader* const reader = [] {
    const char* const wanted = std::getenv("EARTHSHINE_FUZZ");
    for (const earthshine::fuzz::Reader& one : earthshine::fuzz::readers()) {
      if (wanted != nullptr && one.name == wanted) return &one;
    }
    std::abort();  // `./dev fuzz` gives names of corpora alone
  }();
  earthshine::fuzz::read_bytes(*reader, {reinterpret_cast<const char*>(data), size});
  return 0;
}
