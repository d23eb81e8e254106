// SPDX-License-Identifier: Apache-2.0
// Thin gaps, distant pairs, tiny and huge patches, shared edges at sharp and flat angles.
#include <fmt/format.h>

#include <cmath>

#include "tests/support/case_library.h"
#include "tests/support/exact_cube.h"
#include "tests/validation/tables.h"

namespace earthshine::validation {
namespace {

// Unit squares with a common edge at an angle (Howell C-16), by Gauss's rule of 3 points on 4000
// intervals on each side of the kink at p = pi / 4.
double inclined_squares(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  const auto integrand = [c](double p) {
    const double g = std::sqrt(1.0 - std::sin(2.0 * p) * c);
    const double r = std::min(1.0 / std::cos(p), 1.0 / std::sin(p));
    return std::sin(p) * std::cos(p) / (g * g * g) *
           (r * std::atan(1.0 / (g * r)) + std::log1p(g * g * r * r) / (2.0 * g));
  };
  constexpr int intervals = 8000;
  const double width = 0.5 * base::pi / intervals, off = 0.5 * std::sqrt(0.6);
  double sum = 0.0;
  for (int k = 0; k < intervals; ++k) {
    const double middle = (k + 0.5) * width;
    sum += width / 18.0 *
           (5.0 * integrand(middle - off * width) + 8.0 * integrand(middle) +
            5.0 * integrand(middle + off * width));
  }
  return s * s / base::pi * sum;
}

void row(Verdict& verdict, const std::string& what, tests::Case& c, double exact,
         const Options& options) {
  c.record.name = what;
  c.record.value = exact;
  const tests::CaseResult found = tests::run_case(c, tests::object_factors_by_rays, options.seed);
  const double by_exact = tests::run_case(c, tests::object_factors_exact, options.seed).error(c);
  fmt::print("| {} | {:.10g} | {:.10g} | {:.1e} | {:+.2f} | {:+.1e} |\n", what, exact,
             found.computed, found.std_error, found.error(c) / found.std_error, by_exact);
  verdict.check(std::abs(by_exact) <= 1e-6,
                fmt::format("{}: {:.3e} off by the exact method", what, by_exact));
  // Relative to the value, because it may be tiny: an absolute 1e-8 would pass everything then.
  verdict.check(
      std::abs(found.error(c)) <= 4.0 * found.std_error + 1e-8 * exact,
      fmt::format("{}: {:.3e} off, standard error {:.1e}", what, found.error(c), found.std_error));
}

void hinged(double degrees, const Options& options, Verdict& verdict) {
  tests::Case c;
  const double angle = base::radians(degrees);
  const std::uint32_t m = c.made.material(0.5);
  c.from = c.made.object("floor", m);
  c.made.grid({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4, 4);
  c.to = c.made.object("flap", m);
  c.made.grid({0, 0, 0}, {0, 1, 0}, {std::cos(angle), 0, std::sin(angle)}, 4, 4);
  c.rays = 16384;
  row(verdict, fmt::format("unit squares with a common edge at {}°", degrees), c,
      inclined_squares(angle), options);
}

void facing(const std::string& what, double first, double second, double h, int rays,
            const Options& options, Verdict& verdict) {
  tests::Case c;
  const std::uint32_t m = c.made.material(0.5);
  const double a = 0.5 * first, b = 0.5 * second;
  c.from = c.made.object("first", m);
  c.made.level(-a, a, -a, a, 0, true, 4, 4);
  c.to = c.made.object("second", m);
  c.made.level(-b, b, -b, b, h, false, 4, 4);
  c.rays = rays;
  // The closed form suffers from cancellation if one square is tiny. There the factor from the
  // point under its centre is exact to the square of their ratio.
  double exact = 0.0;
  const double ratio = std::min(first, second) / std::max(first, second);
  if (ratio < 0.1) {
    const double x = std::max(a, b) / h, root = std::sqrt(1.0 + x * x);
    const double from_small = 4.0 / base::pi * (x / root) * std::atan(x / root);
    exact = first <= second ? from_small : from_small * second * second / (first * first);
  } else {
    exact = tests::facing_rectangles({-a, a}, {-a, a}, {-b, b}, {-b, b}, h);
  }
  row(verdict, what, c, exact, options);
}

}  // namespace

void extreme_table(const Options& options, Verdict& verdict) {
  fmt::print(
      "| geometry | exact | computed | standard error | error in standard errors | exact method's "
      "error |\n| --- | --- | --- | --- | --- | --- |\n");
  for (const double degrees : {5.0, 90.0, 175.0}) hinged(degrees, options, verdict);
  facing("plates of 1 m, 1 cm apart", 1.0, 1.0, 0.01, 16384, options, verdict);
  facing("plates of 1 m, 2 mm apart", 1.0, 1.0, 2e-3, 16384, options, verdict);
  facing("plates of 20 m, 100 m apart", 20.0, 20.0, 100.0, 65536, options, verdict);
  facing("plates of 1 m, 100 m apart", 1.0, 1.0, 100.0, 1 << 19, options, verdict);
  facing("1 mm to 10 m, 1 m apart", 1e-3, 10.0, 1.0, 16384, options, verdict);
  facing("10 m to 1 mm, 1 m apart", 10.0, 1e-3, 1.0, 16384, options, verdict);
}

}  // namespace earthshine::validation
