// SPDX-License-Identifier: Apache-2.0
// Every build reads the files that fuzzing has found: only base::Error may result.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "tests/fuzz/readers.h"

namespace earthshine::fuzz {

// What a failure names; GoogleTest looks for it. NOLINTNEXTLINE(readability-identifier-naming)
void PrintTo(const Reader& reader, std::ostream* out) { *out << reader.name; }

namespace {

class Corpus : public ::testing::TestWithParam<Reader> {};

TEST_P(Corpus, IsReadOrRefused) {
  const std::filesystem::path folder =
      std::filesystem::path(EARTHSHINE_SOURCE_DIR "/tests/fuzz/corpus") / GetParam().name;
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    SCOPED_TRACE(entry.path().string());
    std::ifstream file(entry.path(), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    ASSERT_NO_THROW(read_bytes(GetParam(), bytes));
    ++count;
  }
  EXPECT_GT(count, 0U) << folder;
}

INSTANTIATE_TEST_SUITE_P(Readers, Corpus, ::testing::ValuesIn(readers().begin(), readers().end()),
                         [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace earthshine::fuzz
