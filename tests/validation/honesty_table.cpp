// SPDX-License-Identifier: Apache-2.0
// Accuracy of standard errors: mean square of error over standard error, over seeds.
#include <fmt/format.h>

#include <cmath>

#include "tests/support/case_library.h"
#include "tests/support/cube_errors.h"
#include "tests/validation/entry_errors.h"
#include "tests/validation/tables.h"

namespace earthshine::validation {
namespace {

struct Tally {
  double square = 0.0, largest = 0.0, count = 0.0;

  void add(double normalised) {
    square += normalised * normalised;
    largest = std::max(largest, std::abs(normalised));
    count += 1.0;
  }
};

void row(Verdict& verdict, const std::string& what, const Tally& t, double independent,
         double allowed_for_the_law) {
  const double spread = 4.0 * std::sqrt(2.0 / independent) + allowed_for_the_law;
  const double mean = t.square / t.count;
  fmt::print("| {} | {} | {:.3f} | 1 ± {:.2f} | {:.2f} |\n", what, std::lround(t.count), mean,
             spread, t.largest);
  verdict.check(std::abs(mean - 1.0) <= spread,
                fmt::format("{}: mean square of normalised errors {:.3f}", what, mean));
}

void object_rows(const Options& options, Verdict& verdict) {
  const std::vector<tests::CaseRecord> library =
      tests::read_case_library(EARTHSHINE_SOURCE_DIR "/tests/data/view-factors.json");
  const int seeds = options.quick ? 50 : 200;
  for (const char* name : {"parallel_unit_squares_h0.5", "inclined_phi45_a1_b1_c1",
                           "occluded_unit_squares_h1_blocker0.5", "coaxial_disks_r1_r1_h1",
                           "cube_n4_par_0_0_to_0_0", "infinite_perp_h2_w1"}) {
    for (const tests::CaseRecord& record : library) {
      if (record.name != name) continue;
      tests::BuiltCase made = tests::build_case(record);
      tests::Case& c = *made.built;
      c.rays = std::min(c.rays, 256);
      Tally t;
      for (int seed = 1; seed <= seeds; ++seed) {
        const tests::CaseResult found =
            tests::run_case(c, tests::object_factors_by_rays, std::uint64_t(seed));
        t.add(found.error(c) / found.std_error);
      }
      // Every standard error has at least 50 degrees of freedom, which adds at most 4 %.
      row(verdict, fmt::format("object to object, `{}`, {} rays", name, c.rays), t, t.count, 0.04);
    }
  }
}

void entry_rows(const Options& options, Verdict& verdict) {
  const tests::ExactCube cube = tests::grey_cube(8);
  const scenes::RayQuery query(cube.builder.scene);
  const radiosity::Patches patches = radiosity::subdivide(cube.builder.scene, 1.0);
  for (const int rays : {256, 1024, 4096}) {
    const radiosity::RayErrorLaw law =
        radiosity::measure_error_law(cube.builder.scene, query, patches, {rays, 99});
    Tally entries, rows;
    const int seeds = options.quick ? 2 : 8;
    for (int seed = 1; seed <= seeds; ++seed) {
      const radiosity::FormFactors f = tests::cast_cube(cube, rays, std::uint64_t(seed));
      std::vector<double> found(f.count());
      for (std::size_t i = 0; i < f.count(); ++i) {
        std::fill(found.begin(), found.end(), 0.0);
        for (std::uint64_t e = f.row_start[i]; e < f.row_start[i + 1]; ++e) {
          found[f.column[e]] = f.row_scale[i] * double(f.hits[e]);
        }
        double square = 0.0;
        for (std::size_t j = 0; j < f.count(); ++j) {
          const double exact = cube.form_factor(i, j), d = found[j] - exact;
          square += d * d;
          if (exact * rays >= 4.0) entries.add(d / std::sqrt(law.variance(exact * rays)));
        }
        rows.add(std::sqrt(square) / radiosity::row_std_error(law, f, i));
      }
    }
    // The law is accurate to a few per cent; entries of a row are correlated.
    row(verdict, fmt::format("entries of 4 hits or more, cube 6 x 8 x 8, {} rays", rays), entries,
        entries.count, 0.1);
    row(verdict, fmt::format("rows (root of the summed squares), {} rays", rays), rows, rows.count,
        0.1);
  }
}

}  // namespace

void honesty_table(const Options& options, Verdict& verdict) {
  fmt::print(
      "| (computed - exact) / standard error | number | mean square | expected | largest |\n");
  fmt::print("| --- | --- | --- | --- | --- |\n");
  object_rows(options, verdict);
  entry_rows(options, verdict);
}

}  // namespace earthshine::validation
