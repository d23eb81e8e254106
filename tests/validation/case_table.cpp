// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tests/support/case_library.h"
#include "tests/validation/tables.h"

namespace earthshine::validation {
namespace {

using tests::Case;
using tests::CaseKind;
using tests::CaseResult;

std::string in_std_errors(const Case& of, const CaseResult& found) {
  const double rounding = CaseResult::rounding * std::max(1.0, std::abs(of.record.value));
  if (std::abs(found.error(of)) <= rounding) return "exact";
  return fmt::format("{:+.2f}", found.error(of) / found.std_error);
}

// The exact method supports some thousand patches and no mirrors.
constexpr std::size_t most_patches = 1600;
constexpr double exact_gate = 1e-6;

std::string by_exact_method(const Case& of, const Options& options, Verdict& verdict) {
  const auto& materials = of.made.scene.materials;
  const bool mirrors = std::any_of(materials.begin(), materials.end(),
                                   [](const scenes::Material& m) { return m.passes_light_on(); });
  if (of.kind != CaseKind::Factor || mirrors || tests::patch_count(of) > most_patches) return "";
  const CaseResult found = tests::run_case(of, tests::object_factors_exact, options.seed);
  verdict.check(std::abs(found.error(of)) <= exact_gate + of.model_error,
                fmt::format("{}: {:.3e} off by the exact method", of.record.name, found.error(of)));
  return fmt::format("{:+.1e}", found.error(of));
}

}  // namespace

void case_table(const Options& options, Verdict& verdict) {
  const std::vector<tests::CaseRecord> records =
      tests::read_case_library(EARTHSHINE_SOURCE_DIR "/tests/data/view-factors.json");
  std::size_t run = 0, exact = 0, outside = 0, by_model = 0, beyond_two = 0;
  double square = 0.0;
  std::string group, refused;
  for (const tests::CaseRecord& record : records) {
    if (record.name.rfind(options.only, 0) != 0) continue;
    const tests::BuiltCase made = tests::build_case(record);
    if (!made.built) {
      refused += fmt::format("- `{}`: {}.\n", record.name, made.refusal);
      continue;
    }
    if (record.group != group) {
      group = record.group;
      fmt::print("\n{}{}\n\n", char(std::toupper(group[0])), group.substr(1));
      fmt::print(
          "| case | exact | computed | standard error | error in standard errors | scene's own "
          "error | exact method's error |\n");
      fmt::print("| --- | --- | --- | --- | --- | --- | --- |\n");
    }
    const Case& c = *made.built;
    const CaseResult found = tests::run_case(c, tests::object_factors_by_rays, options.seed);
    const std::string z = in_std_errors(c, found);
    fmt::print("| `{}` | {:.10g} | {:.10g} | {:.1e} | {} | {} | {} |\n", record.name, record.value,
               found.computed, found.std_error, z,
               c.model_error > 0.0 ? fmt::format("{:.1g}", c.model_error) : "",
               by_exact_method(c, options, verdict));
    ++run;
    verdict.check(found.agrees(c), fmt::format("{}: {:.3e} off, standard error {:.1e}", record.name,
                                               found.error(c), found.std_error));
    if (z == "exact") {
      ++exact;
      continue;
    }
    if (!found.agrees(c)) ++outside;
    if (c.model_error > 0.25 * found.std_error) {
      ++by_model;
      continue;
    }
    const double normalised = std::abs(found.error(c)) / found.std_error;
    square += normalised * normalised;
    if (normalised > 2.0) ++beyond_two;
  }
  const auto noisy = double(run - exact - by_model);
  fmt::print(
      "\n{} cases of {}; {} outside four standard errors. {} agree to rounding; {} have scenes "
      "whose "
      "own error is as large as the rays' and are judged with it. Of the other {}, {} lie beyond "
      "two "
      "standard errors ({:.1f} are to be expected), and the mean square of their errors in "
      "standard "
      "errors is {:.2f} (expected: 1 within {:.2f}).\n",
      run, records.size(), outside, exact, by_model, noisy, beyond_two, 0.0455 * noisy,
      square / noisy, 4.0 * std::sqrt(2.0 / noisy));
  if (!refused.empty()) fmt::print("\nNot computed:\n\n{}", refused);
}

}  // namespace earthshine::validation
