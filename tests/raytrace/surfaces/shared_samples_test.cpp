// SPDX-License-Identifier: Apache-2.0
// Sharing of samples between patches, and the selection of patches to divide.
#include "raytrace/surfaces/shared_samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "radiosity/fill_solution.h"
#include "raytrace/surfaces/surface_refiner.h"
#include "tests/studies/room.h"

namespace earthshine::raytrace {
namespace {

// A dark room of 6 x 16 patches; each wall is a coarse patch.
class Walls {
 public:
  Walls() {
    tests::SceneBuilder builder;
    const std::uint32_t m = builder.material(tests::grey(0.5, 0.0));
    builder.room({m, m, m, m, m, m});
    scene_ = builder.scene;
    light.solution.patches = radiosity::subdivide(scene_, 0.25);
    light.solution.columns = 3;
    light.gathered.assign(3 * count(), 0.0F);
    which.resize(count());
    std::iota(which.begin(), which.end(), 0U);
    for (const std::uint32_t i : which) coarse_.push_back(i / 16);
    effort_.assign(count(), {2, 8});
    samples.residual.resize(count());
  }
  [[nodiscard]] std::size_t count() const { return light.solution.patches.count(); }
  void find(std::uint32_t patch, double first_half_lx, double other_half_lx) {
    PatchResidual& r = samples.residual[patch];
    r.taken = 2;
    r.gathered = {static_cast<float>(first_half_lx), static_cast<float>(other_half_lx)};
  }
  // A mean of variance 1.
  void find(std::uint32_t patch, double lx, std::mt19937& random) {
    std::normal_distribution<double> half(lx, std::sqrt(2.0));
    const double first = half(random);
    find(patch, first, half(random));
  }
  [[nodiscard]] SharedSamples sharing() const {
    return {light, radiosity::PatchAlbedos(scene_), samples, which, effort_, coarse_};
  }
  [[nodiscard]] std::vector<double> shared() const {
    return sharing().share(1, [&](std::uint32_t i, std::size_t) {
      const auto& halves = samples.residual[i].gathered;
      return 0.5 * (double(halves[0]) + double(halves[1]));
    });
  }
  SurfaceLight light;
  SurfaceSamples samples;
  std::vector<std::uint32_t> which;

 private:
  scenes::Scene scene_;
  std::vector<std::uint32_t> coarse_;
  std::vector<SampleBudget> effort_;
};

// Noise of variance 1 shared by all 16 patches of a wall has a mean square of 1/16. A patch whose
// own difference exceeds twice its standard deviation by chance keeps part of it, and so do walls
// whose patches differ by chance: in all less than twice as much more. A wall's mean square has a
// relative standard error of sqrt(2), 192 walls together sqrt(2 / 192).
TEST(SharedSamples, NoiseIsThatOfTheRaysOfAllPatches) {
  Walls walls;
  std::mt19937 random(1);
  double square = 0.0;
  constexpr int rooms = 32;
  for (int k = 0; k < rooms; ++k) {
    for (const std::uint32_t i : walls.which) walls.find(i, 0.0, random);
    for (const double value : walls.shared()) square += value * value;
  }
  square /= static_cast<double>(rooms * walls.count());
  EXPECT_LT(square, 3.0 / 16.0 * (1.0 + 4.0 * std::sqrt(2.0 / (6.0 * rooms))));
  EXPECT_GT(walls.sharing().rays(0), 32.0);  // its own: 8 of each half at 2 points
}

// Halves that agree have no noise: each patch keeps its own value.
TEST(SharedSamples, WhatBothHalvesFindIsKept) {
  Walls walls;
  for (const std::uint32_t i : walls.which) walls.find(i, i, i);
  const std::vector<double> shared = walls.shared();
  for (const std::uint32_t i : walls.which) EXPECT_NEAR(shared[i], i, 1e-9);
  EXPECT_NEAR(walls.sharing().rays(5), 32.0, 1e-9);
}

// One patch has 5 lx, all have noise of variance 1. Its difference from the wall's mean is
// d = 15/16 of 5; d^2 minus four times its noise gives s = 18, and it keeps s / (s + 1) of d, 4.75
// in all. With the common s = d^2 / 16 of the wall's patches it would keep 3. The mean of 64 rooms
// has a standard error of 1/8, and one room in ten keeps less by chance.
TEST(SharedSamples, ABrightPatchAmongDarkOnesStaysBright) {
  Walls walls;
  std::mt19937 random(2);
  constexpr int rooms = 64;
  double bright = 0.0;
  for (int k = 0; k < rooms; ++k) {
    for (const std::uint32_t i : walls.which) walls.find(i, i == 20 ? 5.0 : 0.0, random);
    bright += walls.shared()[20] / rooms;
  }
  EXPECT_GT(bright, 0.9 * 4.75 - 4.0 / 8.0);
  EXPECT_LT(bright, 5.0 + 4.0 / 8.0);
}

// The light of a patch, from 1000 rays, is 0; 32 rays of noise 1 give 10 lx. The light's error
// equals noise of 100, or 32 * 1 / 100 rays. Within the noise all rays count.
TEST(SharedSamples, RaysOfALightThatHasChangedCountNoMore) {
  Walls walls;
  std::mt19937 random(3);
  for (const std::uint32_t i : walls.which) walls.find(i, 0.0, random);
  walls.find(20, 9.0, 11.0);
  walls.find(21, -1.0, 1.0);
  const SharedSamples sharing = walls.sharing();
  EXPECT_LT(sharing.still_counting(20, 1000.0), 32.0 * 2.0 / 99.0);
  EXPECT_GT(sharing.still_counting(20, 1000.0), 32.0 * 0.9 / 99.0);
  EXPECT_EQ(sharing.still_counting(21, 1000.0), 1000.0);
  EXPECT_EQ(sharing.still_counting(20, 0.1), 0.1);  // no more than there are
}

// A patch with more than half of the error is divided alone; all are divided if all of it must go.
TEST(SurfaceCuts, ThePatchesThatHoldTheShareAskedForAreCutAndNoOther) {
  Walls walls;
  const radiosity::Patches& patches = walls.light.solution.patches;
  SurfaceRefiner choice(patches);
  for (const std::uint32_t i : walls.which) {
    PatchResidual& r = walls.samples.residual[i];
    r.taken = 4;
    r.square = i == 20 ? 100.0F : 0.1F;
  }
  choice.see(patches, walls.samples, walls.which);
  const auto number = [&](double share) {
    const std::vector<radiosity::Cut> cuts = choice.worst(patches, {0.0, share, 100000});
    return std::count_if(cuts.begin(), cuts.end(),
                         [](radiosity::Cut cut) { return cut != radiosity::Cut::None; });
  };
  EXPECT_EQ(number(0.5), 1);
  EXPECT_EQ(number(1.0), 96);
}

// Neighbours that a division requires count, too: no more patches than allowed, and one less only
// if the last one does not fit.
TEST(SurfaceCuts, NoMorePatchesThanAllowed) {
  Walls walls;
  const radiosity::Patches& patches = walls.light.solution.patches;
  radiosity::Refiner refiner(patches);
  for (std::uint32_t i = 0; i < patches.count(); ++i) refiner.of(i) = {1.0 + double(i), 0.0, 0.0};
  EXPECT_TRUE(refiner.worst(patches, {0.0, 1.0, patches.count()}).empty());
  for (const std::size_t most : {std::size_t{97}, std::size_t{123}, std::size_t{500}}) {
    const auto cuts = refiner.worst(patches, {0.0, 1.0, most});
    const std::size_t count =
        cuts.empty() ? patches.count() : radiosity::split(patches, cuts).patches.count();
    EXPECT_LE(count, most);
    EXPECT_GE(count, std::min<std::size_t>(most, 192) - 1);
  }
}

// A patch with only a sliver outside a body may have a single sampled point.
TEST(SurfaceCuts, APatchOfWhichOnePointIsOpenIsCutByIt) {
  Walls walls;
  const radiosity::Patches& patches = walls.light.solution.patches;
  SurfaceRefiner choice(patches);
  PatchResidual& r = walls.samples.residual[20];
  r.taken = 1;
  r.open = 0.05F;
  r.square = r.square_error = 100.0F;
  choice.see(patches, walls.samples, walls.which);
  EXPECT_NE(choice.worst(patches, {0.0, 1.0, 100000}).at(20), radiosity::Cut::None);
  EXPECT_DOUBLE_EQ(choice.total(), double(0.05F) * 100.0 / double(patches.count()));
}

// A half has half of its parent's error by area. Two points that find nothing may have missed it: a
// third remains expected, and half of the parent's rays count.
TEST(SurfaceCuts, WhatIsExpectedOfAPieceCountsAsAPoint) {
  Walls walls;
  const radiosity::Patches& patches = walls.light.solution.patches;
  SurfaceRefiner choice(patches);
  walls.samples.residual[20].taken = 2;
  walls.samples.residual[20].square = 96.0F;
  const std::vector<double> noise(patches.count(), 24.0);
  choice.see(patches, walls.samples, walls.which, noise);
  EXPECT_DOUBLE_EQ(choice.total(), 72.0 / 96.0);
  EXPECT_FLOAT_EQ(choice.kept_rays()[20], 24.0F / 96.0F);
  EXPECT_FLOAT_EQ(choice.kept_rays()[21], 0.5F);
  const radiosity::Split made =
      radiosity::split(patches, choice.worst(patches, {0.0, 1.0, 100000}));
  const std::vector<std::uint32_t> fresh = choice.follow(made.patches, made.parent);
  ASSERT_EQ(fresh.size(), 2U);
  EXPECT_DOUBLE_EQ(choice.of(fresh[0]).error, 0.25 * 72.0 / 96.0);
  walls.samples.residual.assign(made.patches.count(), {});
  for (const std::uint32_t i : fresh) walls.samples.residual[i].taken = 2;
  choice.see(made.patches, walls.samples, fresh);
  EXPECT_DOUBLE_EQ(choice.of(fresh[0]).error, 0.25 * 72.0 / 96.0 / 3.0);
}

}  // namespace
}  // namespace earthshine::raytrace
