// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <utility>

#include "studies/steer/reach_surfaces.h"
#include "tests/studies/room.h"

namespace earthshine::studies {
namespace {

SteeredSolution reached(const scenes::Scene& scene, double error) {
  const tests::Prepared prepared(scene);
  Wanted wanted;
  wanted.error = error;
  return reach_surfaces({scene, prepared.groups, prepared.effects, prepared.query}, wanted, 1, {});
}

// What was reached has no limit, however little the last solve brought, and what was not has one.
TEST(ReachSolution, OfSurfacesALimitIsNamedWhereTheErrorIsNotReachedAndThereAlone) {
  scenes::Scene held = tests::small_room().scene;
  held.quality.max_patches = 60;
  int reached_it = 0, missed_it = 0;
  for (const double error : {0.2, 0.15, 0.1, 0.07, 0.03}) {
    for (const scenes::Scene* scene : {&std::as_const(held), &tests::small_room().scene}) {
      if (error < 0.05 && scene != &held) continue;  // takes long
      const SteeredSolution solution = reached(*scene, error);
      const bool enough = solution.surface.parts.total().estimate <= error;
      EXPECT_EQ(solution.limit == Limit::None, enough) << error;
      (enough ? reached_it : missed_it) += 1;
    }
  }
  EXPECT_GT(reached_it, 2);
  EXPECT_GT(missed_it, 0);
}

}  // namespace
}  // namespace earthshine::studies
