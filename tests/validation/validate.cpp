// SPDX-License-Identifier: Apache-2.0
// Prints the tables of docs/data/validation.md. `./dev validate` runs it.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <string_view>

#include "tests/validation/tables.h"

namespace {

using earthshine::validation::Options;
using earthshine::validation::Verdict;

struct Table {
  const char* heading;
  void (*print)(const Options&, Verdict&);
};

using namespace earthshine::validation;
constexpr Table tables[] = {{"The library of closed forms", case_table},
                            {"Near, far, tiny, sharp", extreme_table},
                            {"Are the standard errors honest?", honesty_table},
                            {"CIE 171:2006", cie_table},
                            {"The closed cube", cube_table},
                            {"Leaks", leak_table},
                            {"Furnaces", furnace_table},
                            {"Energy of the scenes that ship", energy_table},
                            {"What balancing costs in open scenes", balancing_table}};

}  // namespace

int main(int count, char** words) {
  Options options;
  for (int k = 1; k < count; ++k) {
    if (std::strcmp(words[k], "--quick") == 0) {
      options.quick = true;
    } else if (std::strcmp(words[k], "--cost") == 0) {
      options.cost = true;
    } else if (std::strcmp(words[k], "--only") == 0 && k + 1 < count) {
      options.only = words[++k];
    } else {
      fmt::print(stderr, "usage: earthshine_validate [--quick | --cost | --only CASE|TABLE]\n");
      return 2;
    }
  }
  Verdict verdict;
  if (options.cost) {
    cost_table();
    return 0;
  }
  const bool names_tables = !options.only.empty() &&
                            std::any_of(std::begin(tables), std::end(tables), [&](const Table& t) {
                              return std::string_view(t.heading).starts_with(options.only);
                            });
  for (const Table& table : tables) {
    const bool wanted = names_tables ? std::string_view(table.heading).starts_with(options.only)
                                     : options.only.empty() || table.print == case_table;
    if (!wanted) continue;
    fmt::print("\n### {}\n\n", table.heading);
    table.print(options, verdict);
    std::fflush(stdout);
  }
  fmt::print("\n{} checks, {} failed.\n", verdict.checks, verdict.failures.size());
  for (const std::string& line : verdict.failures) fmt::print("- failed: {}\n", line);
  for (const std::string& line : verdict.failures) fmt::print(stderr, "failed: {}\n", line);
  return verdict.failures.empty() ? 0 : 1;
}
