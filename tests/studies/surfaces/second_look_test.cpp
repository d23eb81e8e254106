// SPDX-License-Identifier: Apache-2.0
// What is to be cut is looked at twice, so that chance is not cut.
#include <gtest/gtest.h>

#include <numeric>

#include "radiosity/fill_solution.h"
#include "studies/steer/surface_turns.h"
#include "studies/surfaces/residual_error.h"
#include "tests/studies/room.h"

namespace earthshine::studies {
namespace {

// A plate of 1 m before the Earth, which each of its points sees alike: rays differ, light does
// not.
scenes::Scene plate_before_the_earth() {
  tests::SceneBuilder builder;
  builder.quad(builder.material(tests::grey(0.5)), {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  scenes::Earth& earth = builder.scene.earth.emplace();
  earth.direction = Vec3(0.0, 0.8, 0.6);
  earth.half_angle_deg = 60.0;
  earth.model = scenes::EarthModel::Uniform;
  earth.radiance = Rgb(1000.0);
  return builder.scene;
}

struct Plate {
  Plate() {
    radiosity::SolveOptions options;
    options.patch_edge_m = edge_m;
    options.form_factor_rays = 256;
    radiosity::FormFactors factors;
    radiosity::Solution solution = radiosity::solve_keeping(
        prepared, options, radiosity::subdivide(scene, edge_m), {}, factors);
    light.emplace(prepared, std::move(solution), std::move(factors), 256.0);
  }
  static constexpr double edge_m = 1.0 / 16.0;
  scenes::Scene scene = plate_before_the_earth();
  tests::Prepared prepared{scene};
  std::optional<LightOnSurfaces> light;
};

// The noise of a mean of products of halves falls with the root of the number of points and with
// that of rays: from 2 and 8 to 16 and 16, by sqrt(8) * 2 = 5.7. What a first look says of patches
// counts no more then but for one point of 17. So half of what a first look finds uneven is gone
// before all is looked at again, and no patch is cut; by the first look alone, those that hold the
// other half would be.
TEST(SecondLook, WhatIsUnevenByChanceIsNotCut) {
  Plate plate;
  LightOnSurfaces& light = *plate.light;
  const Wanted wanted;
  const StageListener silent;
  SurfaceTurns turns(plate.prepared, wanted, 1, light, 100000, silent);
  turns.set_mean(light.told_mean());
  std::vector<std::uint32_t> all(light.patches().count());
  std::iota(all.begin(), all.end(), 0U);
  const std::vector<Effort> effort(all.size(), Effort{2, 8});
  const SurfaceSamples samples = turns.sample(all, effort, "", SamplesOf::Light);
  CutChoice choice(light.patches());
  choice.see(light.patches(), samples, all,
             noise_of(light, ray_variance(light.patches(), samples, all, effort), samples).all());
  ASSERT_FALSE(choice.worst(light.patches(), 0.5 * choice.total(), 0.8, 100000).empty());
  std::vector<std::uint32_t> parent = all;
  EXPECT_FALSE(turns.cut_gathered(choice, 0.5 * choice.total(), 512.0, parent));
  EXPECT_EQ(light.patches().count(), all.size());
}

// Pieces are new, and what is seen anew is by few points again.
TEST(SecondLook, IsOfThePatchesThatAreToBeCutOnce) {
  Plate plate;
  const radiosity::Patches& patches = plate.light->patches();
  std::vector<std::uint32_t> all(patches.count());
  std::iota(all.begin(), all.end(), 0U);
  SurfaceSamples samples;
  samples.residual.resize(patches.count());
  for (const std::uint32_t i : all) {
    samples.residual[i].taken = 2;
    samples.residual[i].square = i < 10 ? 100.0F : 0.0F;
  }
  CutChoice choice(patches);
  choice.see(patches, samples, all);
  const std::vector<radiosity::Cut> cuts = choice.worst(patches, 0.0, 1.0, 100000);
  EXPECT_EQ(choice.doubtful(cuts, 0.1), std::vector<std::uint32_t>(all.begin(), all.begin() + 10));
  choice.be_sure_of(std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 6, 7});
  EXPECT_EQ(choice.doubtful(cuts, 0.1), (std::vector<std::uint32_t>{8, 9}));
  EXPECT_TRUE(choice.doubtful(cuts, 0.2).empty());
  choice.see(patches, samples, std::vector<std::uint32_t>{3});
  EXPECT_EQ(choice.doubtful(cuts, 0.0), (std::vector<std::uint32_t>{3, 8, 9}));
  const radiosity::Split made = radiosity::split(patches, cuts);
  const std::vector<std::uint32_t> fresh = choice.follow(made.patches, made.parent);
  ASSERT_EQ(fresh.size(), 20U);
  std::vector<radiosity::Cut> again(made.patches.count(), radiosity::Cut::None);
  for (const std::uint32_t i : fresh) again[i] = radiosity::Cut::S;
  EXPECT_EQ(choice.doubtful(again, 0.0), fresh);
}

}  // namespace
}  // namespace earthshine::studies
