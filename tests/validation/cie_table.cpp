// SPDX-License-Identifier: Apache-2.0
// CIE 171:2006: illuminances with default settings and a wanted error of 0.5 %.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "raytrace/solve_control/reach_surfaces.h"
#include "scenes/effects/quality.h"
#include "tests/support/scene_builder.h"
#include "tests/validation/cie_cases.h"
#include "tests/validation/tables.h"

namespace earthshine::validation {
namespace {

constexpr double wanted_error = 0.005;

// As `solve --error`: one solve if no surface reflects, else solves until the error is reached.
radiosity::SolveReport solve(scenes::Scene scene, std::uint64_t seed) {
  scene.quality.error = wanted_error;
  const tests::Prepared made(scene);
  if (!made.effects.solution) {
    return made.solve(radiosity::solve_options(scenes::resolve_quality(scene), seed)).report;
  }
  raytrace::Wanted wanted;
  wanted.error = wanted_error;
  return raytrace::reach_surfaces(made, wanted, seed, {}).solution.report;
}

// Error relative to the right value or, if this is 0, to the largest value of the case.
double off(double found, double right, double largest) {
  return (found - right) / (right != 0.0 ? right : largest);
}

}  // namespace

void cie_table(const Options& options, Verdict& verdict) {
  fmt::print(
      "| case | point | reference | closed form | found | off the reference, % | off the "
      "closed form, % |\n");
  fmt::print("| --- | --- | --- | --- | --- | --- | --- |\n");
  double worst = 0.0;
  std::set<std::string> done;
  for (CieCase& c : cie_cases()) {
    // The cubes take most of the time.
    if (options.quick && c.name == "5.8") continue;
    const radiosity::SolveReport report = solve(std::move(c.scene), options.seed);
    double largest = 0.0;
    for (const CiePoint& p : c.points) largest = std::max(largest, p.reference);
    for (std::size_t k = 0; k < c.points.size(); ++k) {
      const CiePoint& p = c.points[k];
      if (!done.insert(c.name + p.where).second) continue;
      const double found = c.found(report, k);
      const double off_reference = off(found, p.reference, largest);
      const double off_closed_form = off(found, p.closed_form, largest);
      fmt::print("| {} | {} | {:.7g} {} | {:.5g} | {:.5g} | {:+.3f} | {:+.3f} |\n", c.name, p.where,
                 p.reference, c.unit, p.closed_form, found, 100.0 * off_reference,
                 100.0 * off_closed_form);
      worst = std::max(worst, std::abs(off_reference));
      verdict.check(std::abs(off_reference) <= wanted_error,
                    fmt::format("CIE 171 {}, {}: {:.3g} % off the reference", c.name, p.where,
                                100.0 * off_reference));
      verdict.check(std::abs(off_closed_form) <= wanted_error,
                    fmt::format("CIE 171 {}, {}: {:.3g} % off the closed form", c.name, p.where,
                                100.0 * off_closed_form));
    }
  }
  fmt::print(
      "\nThe largest is {:.2f} %; asked for were {:.1f} %. A program passes within 5 % at each "
      "point and 10 % in all; the largest errors that were published of Cycles are 0.28 to 4.9 % "
      "by case, and 32 % in case 5.8 at ρ 0.95 where its default limit of transparent bounces is "
      "left in place.\n",
      100.0 * worst, 100.0 * wanted_error);
}

}  // namespace earthshine::validation
