// SPDX-License-Identifier: Apache-2.0
// Prints the tables of docs/validation.md. `./dev validate` runs it.
#include <fmt/format.h>

#include <cstring>

#include "tests/validation/tables.h"

int main(int count, char** words) {
  earthshine::validation::Options options;
  for (int k = 1; k < count; ++k) {
    if (std::strcmp(words[k], "--quick") == 0) {
      options.quick = true;
    } else if (std::strcmp(words[k], "--slow") == 0) {
      options.slow = true;
    } else if (std::strcmp(words[k], "--only") == 0 && k + 1 < count) {
      options.only = words[++k];
    } else {
      fmt::print(stderr, "usage: earthshine_validate [--quick | --slow] [--only CASE]\n");
      return 2;
    }
  }
  earthshine::validation::Verdict verdict;
  earthshine::validation::case_table(options, verdict);
  fmt::print("\n{} checks, {} failed.\n", verdict.checks, verdict.failures.size());
  for (const std::string& line : verdict.failures) fmt::print(stderr, "failed: {}\n", line);
  return verdict.failures.empty() ? 0 : 1;
}
