// SPDX-License-Identifier: Apache-2.0
// The closed-form library by rays, with a fraction of the rays of `./dev validate`.
#include <gtest/gtest.h>

#include "tests/support/case_library.h"

namespace earthshine {
namespace {

const std::vector<tests::CaseRecord>& library() {
  static const std::vector<tests::CaseRecord> records =
      tests::read_case_library(EARTHSHINE_SOURCE_DIR "/tests/data/view-factors.json");
  return records;
}

TEST(CaseLibrary, EveryCaseHasASceneOrAReason) {
  EXPECT_EQ(library().size(), 103U);
  std::size_t refused = 0;
  for (const tests::CaseRecord& record : library()) {
    const tests::BuiltCase made = tests::build_case(record);
    if (made.built) {
      EXPECT_FALSE(made.built->made.scene.triangles.empty()) << record.name;
      continue;
    }
    ++refused;
    // Love's equation has a kernel that no diffuse surfaces have.
    EXPECT_EQ(record.name.rfind("love_equation", 0), 0U) << record.name << ": " << made.refusal;
  }
  EXPECT_EQ(refused, 2U);
}

TEST(CaseLibrary, FormFactorsOfSmallScenesAreWithinFourStandardErrors) {
  std::size_t run = 0;
  for (const tests::CaseRecord& record : library()) {
    tests::BuiltCase made = tests::build_case(record);
    if (!made.built || made.built->kind != tests::CaseKind::Factor) continue;
    if (made.built->made.scene.triangles.size() > 2100) continue;
    made.built->rays = std::min(made.built->rays, 1024);
    const tests::CaseResult found = tests::run_case(*made.built, tests::object_factors_by_rays, 1);
    ++run;
    EXPECT_TRUE(found.agrees(*made.built)) << record.name << ": " << found.computed << " +- "
                                           << found.std_error << ", exact " << record.value;
    // A standard error as large as the value would pass everything.
    EXPECT_LE(found.std_error, std::max(0.05 * record.value, 4e-4)) << record.name;
  }
  EXPECT_GE(run, 40U);
}

TEST(CaseLibrary, RadiositiesOfAFewPatchesAreWithinFourStandardErrors) {
  std::size_t run = 0;
  for (const tests::CaseRecord& record : library()) {
    tests::BuiltCase made = tests::build_case(record);
    if (!made.built || made.built->kind != tests::CaseKind::Radiosity) continue;
    if (made.built->made.scene.triangles.size() > 200) continue;
    made.built->rays = std::min(made.built->rays, 1024);
    const tests::CaseResult found = tests::run_case(*made.built, tests::object_factors_by_rays, 1);
    ++run;
    EXPECT_TRUE(found.agrees(*made.built)) << record.name << ": " << found.computed << " +- "
                                           << found.std_error << ", exact " << record.value;
    EXPECT_LE(found.std_error, 2e-3 * record.value) << record.name;
  }
  EXPECT_GE(run, 10U);
}

}  // namespace
}  // namespace earthshine
