// SPDX-License-Identifier: Apache-2.0
#include "scenes/effects/quality.h"

#include <gtest/gtest.h>

namespace earthshine::scenes {
namespace {

// A box of 3 x 4 x 12 m: its diagonal is 13 m.
Scene box() {
  Scene scene;
  scene.vertices = {{0, 0, 0}, {3, 4, 12}};
  return scene;
}

TEST(Quality, PatchesAreRefinedWhenNothingIsSet) {
  const QualityKnobs knobs = resolve_quality(box());
  EXPECT_TRUE(knobs.refine);
  EXPECT_DOUBLE_EQ(knobs.patch_edge_m, 13.0 / 48.0);
  EXPECT_DOUBLE_EQ(knobs.start_edge_m, 13.0 / 8.0);
  EXPECT_EQ(knobs.max_patches, 0);
  EXPECT_DOUBLE_EQ(knobs.refine_error, 1.5 * 0.02);
}

TEST(Quality, AWantedErrorSetsWhereRefinementEnds) {
  Scene scene = box();
  scene.quality.error = 0.1;
  EXPECT_TRUE(resolve_quality(scene).refine);
  EXPECT_DOUBLE_EQ(resolve_quality(scene).refine_error, 0.15);
}

TEST(Quality, PatchEdgeAloneStillMeansPatchesThatAreAllAlike) {
  Scene scene = box();
  scene.quality.patch_edge_m = 0.5;
  EXPECT_FALSE(resolve_quality(scene).refine);
  EXPECT_EQ(resolve_quality(scene).patch_edge_m, 0.5);
}

TEST(Quality, PatchEdgeBoundsTheCellsThatARefinementStartsFrom) {
  Scene scene = box();
  scene.quality.patch_edge_m = 0.5;
  scene.quality.refine = true;
  EXPECT_TRUE(resolve_quality(scene).refine);
  EXPECT_EQ(resolve_quality(scene).start_edge_m, 0.5);
}

TEST(Quality, ABudgetAloneIsSpentWhollyAndTurnsRefinementOn) {
  Scene scene = box();
  scene.quality.patch_edge_m = 0.5;
  scene.quality.max_patches = 5000;
  const QualityKnobs knobs = resolve_quality(scene);
  EXPECT_TRUE(knobs.refine);
  EXPECT_EQ(knobs.max_patches, 5000);
  EXPECT_EQ(knobs.refine_error, 0.0);
  scene.quality.error = 0.02;
  EXPECT_DOUBLE_EQ(resolve_quality(scene).refine_error, 0.03);
}

TEST(Quality, RefineFalseKeepsThePatchesAlike) {
  Scene scene = box();
  scene.quality.refine = false;
  EXPECT_FALSE(resolve_quality(scene).refine);
}

}  // namespace
}  // namespace earthshine::scenes
