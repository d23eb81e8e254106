// SPDX-License-Identifier: Apache-2.0
// Tables of the validation program. Each prints Markdown to standard output and checks its results
// against its gates.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace earthshine::validation {

struct Options {
  bool quick = false;  // fewer seeds and rays, under a minute
  bool cost = false;   // only the cost tables: minutes, and gigabytes
  std::uint64_t seed = 1;
  std::string only;  // tables whose heading has this prefix, else cases of the library whose name
                     // has it
};

struct Verdict {
  std::size_t checks = 0;
  std::vector<std::string> failures;  // one line each

  void check(bool passed, const std::string& what) {
    ++checks;
    if (!passed) failures.push_back(what);
  }
};

void case_table(const Options& options, Verdict& verdict);
void cie_table(const Options& options, Verdict& verdict);
void cube_table(const Options& options, Verdict& verdict);
void leak_table(const Options& options, Verdict& verdict);
void honesty_table(const Options& options, Verdict& verdict);
void extreme_table(const Options& options, Verdict& verdict);
void furnace_table(const Options& options, Verdict& verdict);
void balancing_table(const Options& options, Verdict& verdict);
void energy_table(const Options& options, Verdict& verdict);
void cost_table();

}  // namespace earthshine::validation
