// SPDX-License-Identifier: Apache-2.0
// The cut of an earlier round that a refined solution keeps, in memory and in its file.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "radiosity/patch_layout.h"
#include "radiosity/refine.h"
#include "radiosity/solution_file.h"
#include "tests/base/temporary_folder.h"
#include "tests/support/scene_builder.h"

namespace earthshine::radiosity {
namespace {

// A plate of 1 m in the Sun under a smaller one, whose shadow lies askew on it.
scenes::Scene shadowed_plate() {
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 1.0, 0.0, true);
  builder.quad(builder.material(tests::grey(0.0)), {-0.2, 0, 0.3}, {0, -0.17, 0.3}, {0.2, 0, 0.3},
               {0, 0.23, 0.3});
  scenes::Sun sun;
  sun.direction = glm::normalize(Vec3(0.1, 0.05, 1));
  sun.angular_radius_deg = 0.0;
  builder.scene.sun = sun;
  builder.scene.cameras.emplace_back();
  builder.scene.path = "plate.toml";
  return builder.scene;
}

SolveOptions refining(std::size_t max_patches) {
  SolveOptions options;
  options.form_factor_rays = 64;
  options.patch_edge_m = 0.03;
  options.refine = {true, 0.25, max_patches, 0.0};
  return options;
}

struct Stored {
  test::TemporaryFolder folder;
  std::filesystem::path path = folder / "plate.h5";
  scenes::Scene scene = shadowed_plate();
  scenes::LightGroups groups = scenes::find_light_groups(scene);
  SolveOptions options;
  Solution solution;

  explicit Stored(std::size_t max_patches)
      : options(refining(max_patches)), solution(tests::Prepared(scene).solve(options)) {}
  void write() const { write_solution(path, solution, {scene, groups, options, "1.0"}); }
  [[nodiscard]] Solution read() const {
    return read_solution(path, {scene, groups, options, "1.0"});
  }
  // What is said of a file in which the coarser cut was changed.
  template <class Change>
  [[nodiscard]] std::string said_after(Change change) {
    const Solution sound = solution;
    change(solution);
    write();
    solution = sound;
    return test::error_of(base::Blame::Input, [&] { (void)read(); });
  }
};

TEST(OtherCut, HasTwiceTheErrorOrMoreAndFewerPatches) {
  const Stored stored(600);
  const OtherCut& coarser = stored.solution.other;
  const std::vector<RefineRound>& rounds = stored.solution.report.rounds;
  ASSERT_GT(coarser.patches.count(), 0U);
  EXPECT_GE(coarser.error, 2.0 * rounds.back().error);
  EXPECT_LT(coarser.patches.count(), stored.solution.patches.count());
  // One of the rounds, with its error; and of those that were kept the last: each has at most 0.8
  // of the error of the one before, so that none below 2 / 0.8 of the final error was left out,
  // unless a round took more than that away.
  bool found = false;
  for (std::size_t k = 0; k + 1 < rounds.size(); ++k) {
    if (rounds[k].patches != coarser.patches.count()) continue;
    EXPECT_EQ(rounds[k].error, coarser.error);
    found = true;
    for (std::size_t later = k + 1; later < rounds.size(); ++later) {
      if (rounds[later].error < 2.0 * rounds.back().error) continue;
      EXPECT_GT(rounds[later].error, 0.8 * coarser.error);
    }
  }
  EXPECT_TRUE(found);
}

TEST(OtherCut, RefinementThatEndsTooSoonHasNone) {
  const Stored stored(34);
  const std::vector<RefineRound>& rounds = stored.solution.report.rounds;
  ASSERT_LT(rounds.front().error, 2.0 * rounds.back().error);
  EXPECT_EQ(stored.solution.other.patches.count(), 0U);
}

TEST(OtherCut, EvenPatchesHaveNone) {
  const scenes::Scene scene = shadowed_plate();
  SolveOptions even = refining(600);
  even.refine.on = false;
  even.patch_edge_m = 0.25;
  EXPECT_EQ(tests::Prepared(scene).solve(even).other.patches.count(), 0U);
}

TEST(OtherCut, ComesBackFromTheFile) {
  const Stored stored(600);
  stored.write();
  const OtherCut read = stored.read().other, &own = stored.solution.other;
  EXPECT_EQ(read.error, own.error);
  EXPECT_EQ(read.patches.area_m2, own.patches.area_m2);
  EXPECT_EQ(read.patches.tree, own.patches.tree);
  EXPECT_EQ(read.patches.facet, own.patches.facet);
  ASSERT_EQ(read.patches.count(), own.patches.count());
  for (std::uint32_t i = 0; i < own.patches.count(); ++i) {
    EXPECT_EQ(read.patches.corners(i), own.patches.corners(i));
  }
}

TEST(OtherCut, NoneComesBackAsNone) {
  Stored stored(600);
  stored.solution.other = {};
  stored.write();
  EXPECT_EQ(stored.read().other.patches.count(), 0U);
  EXPECT_EQ(stored.read().other.error, 0.0);
}

TEST(OtherCut, AForgedOneIsRefused) {
  Stored stored(600);
  const auto said = [&](auto change) { return stored.said_after(change); };
  EXPECT_NE(said([](Solution& s) { s.other.patches.area_m2[3] *= 2.0; }), "");
  EXPECT_NE(said([](Solution& s) { s.other.patches.area_m2.pop_back(); }), "");
  EXPECT_NE(said([](Solution& s) { s.other.patches.tree.back() ^= 1U; }), "");
  EXPECT_NE(said([](Solution& s) { s.other.patches.tree.front() = 0x80000000U; }), "");
  EXPECT_NE(said([](Solution& s) { s.other.patches.facets.pop_back(); }), "");
  EXPECT_NE(said([](Solution& s) { s.other.patches.facets[0].s_count = 1U << 31; }), "");
  EXPECT_NE(said([](Solution& s) {
              s.other.patches.area_m2[0] = std::numeric_limits<double>::quiet_NaN();
            }),
            "");
  // An error that no coarser cut has would make nonsense of the estimates.
  for (const double error :
       {std::numeric_limits<double>::quiet_NaN(), -1.0, std::numeric_limits<double>::infinity()}) {
    const std::string text = said([&](Solution& s) { s.other.error = error; });
    EXPECT_NE(text.find("other_cut_error"), std::string::npos) << error << text;
  }
}

}  // namespace
}  // namespace earthshine::radiosity
