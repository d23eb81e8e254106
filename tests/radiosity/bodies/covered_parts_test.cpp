// SPDX-License-Identifier: Apache-2.0
// Patches that bodies cover partly or completely.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "radiosity/factors/covered_patches.h"
#include "tests/support/boxes.h"

namespace earthshine::radiosity {
namespace {

using tests::grey;

FormFactors open_factors(const scenes::Scene& scene, const scenes::RayQuery& query,
                         const Patches& patches, int rays = 1024) {
  FormFactorOptions options;
  options.rays_per_patch = rays;
  options.leave_out_covered = true;
  return cast_form_factors(scene, query, patches, options);
}

TEST(CoveredParts, TheShareLeftOpenIsTheAreaThatTheBoxLeaves) {
  // A floor of one patch, 1 m2, and a box on 0.3 x 0.4 m of it, standing and sunk. 1024 points,
  // binomial at most: 4 sqrt(0.12 * 0.88 / 1024).
  for (const double low : {0.0, -0.2}) {
    tests::SceneBuilder builder;
    const std::uint32_t m = builder.material(grey(0.5));
    builder.quad(m, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    tests::add_box(builder, m, {0.2, 0.5, low}, {0.5, 0.9, 0.3});
    const scenes::RayQuery query(builder.scene);
    const Patches patches = subdivide(builder.scene, 10.0);
    const FormFactors f = open_factors(builder.scene, query, patches);
    ASSERT_EQ(f.open.share.size(), 7U);
    EXPECT_NEAR(f.open.share[0], 0.88, 4.0 * std::sqrt(0.12 * 0.88 / 1024)) << low;
    EXPECT_EQ(f.black[0], 0.0);
    for (std::size_t face = 1; face < 7; ++face) EXPECT_EQ(f.open.share[face], 1.0) << face;
    EXPECT_NEAR(open_areas(f.open, patches.area_m2)[0], f.open.share[0], 1e-12);
  }
}

TEST(CoveredParts, NothingIsLookedForWhereNoRayMeetsABack) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(grey(0.5));
  builder.room({m, m, m, m, m, m});
  tests::add_box(builder, m, Vec3(0.4), Vec3(0.6));
  const scenes::RayQuery query(builder.scene);
  const Patches patches = subdivide(builder.scene, 0.5);
  const FormFactors f = open_factors(builder.scene, query, patches),
                    as_cast = cast_form_factors(builder.scene, query, patches, {1024, 1});
  EXPECT_TRUE(f.open.share.empty());
  EXPECT_EQ(f.open.bodies, nullptr);
  EXPECT_EQ(f.hits, as_cast.hits);
  EXPECT_EQ(f.column, as_cast.column);
  EXPECT_EQ(f.row_scale, as_cast.row_scale);
}

TEST(CoveredParts, AWhollyCoveredPatchHasNoRowAndNoColumn) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(grey(0.5));
  builder.quad(m, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  tests::add_box(builder, m, {0.25, 0.25, -0.1}, {0.75, 0.75, 0.3});
  const scenes::RayQuery query(builder.scene);
  const Patches patches = subdivide(builder.scene, 0.125);
  const FormFactors f = open_factors(builder.scene, query, patches);
  double closed_m2 = 0.0;
  for (std::uint32_t i = 0; i < f.count(); ++i) {
    double sum = f.sky[i] + f.black[i];
    for (std::uint64_t e = f.row_start[i]; e < f.row_start[i + 1]; ++e) {
      sum += f.row_scale[i] * double(f.hits[e]);
      if (f.open.share[f.column[e]] == 0.0) {
        EXPECT_EQ(f.hits[e], 0.0F);
      }
    }
    EXPECT_NEAR(sum, 1.0, 1e-14);
    if (f.open.share[i] > 0.0) continue;
    closed_m2 += patches.area_m2[i];
    EXPECT_EQ(f.row_start[i], f.row_start[i + 1]);
    EXPECT_EQ(f.lost[i], 1.0);
  }
  EXPECT_NEAR(closed_m2, 0.25, 1e-12);  // cells of 1/8 m end at the box
}

TEST(CoveredParts, AHitOnAPatchThatTakesNoPartIsLostAndTheRowStaysClosed) {
  // A room of six patches, of which the last one is marked as covered: 0.2 of each other patch's
  // light goes to black backs instead.
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(grey(0.5));
  builder.room({m, m, m, m, m, m});
  const scenes::RayQuery query(builder.scene);
  FormFactors f = cast_form_factors(builder.scene, query, subdivide(builder.scene, 1.0), {1024, 1});
  f.open.share = {1, 1, 1, 1, 1, 0};
  lose_hits_on_covered(f);
  for (std::uint32_t i = 0; i < 5; ++i) {
    double sum = f.black[i];
    for (std::uint64_t e = f.row_start[i]; e < f.row_start[i + 1]; ++e) {
      sum += f.row_scale[i] * double(f.hits[e]);
    }
    EXPECT_NEAR(sum, 1.0, 1e-14);
    EXPECT_NEAR(f.black[i], 0.2, 4.0 * std::sqrt(0.16 / 1024));
    EXPECT_EQ(f.lost[i], f.black[i]);
  }
}

// The floor [0,1]^2 under a Sun overhead, a box of 0.3 x 0.4 m sunk in it.
Solution sunlit_floor(double edge_m) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(grey(0.5));
  builder.quad(m, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  tests::add_box(builder, m, {0.2, 0.5, -0.1}, {0.5, 0.9, 0.3});
  scenes::Sun sun;
  sun.illuminance_lx = Rgb(1000.0);
  sun.angular_radius_deg = 0.0;
  builder.scene.sun = sun;
  SolveOptions options;
  options.patch_edge_m = edge_m;
  return tests::Prepared(builder.scene).solve(options);
}

TEST(CoveredParts, DirectLightIsTheMeanOverWhatIsOpen) {
  // The Sun overhead casts no shadow beside the box: the open floor has 1000 lx, for any patches,
  // and all light on 1 m2 lands once, except for the noise of the open share.
  for (const double edge_m : {2.0, 0.2, 0.07}) {
    const Solution s = sunlit_floor(edge_m);
    EXPECT_NEAR(s.report.groups[0].landed_lm.g, 1000.0, 4e3 * std::sqrt(0.12 * 0.88 / 1024));
    EXPECT_NEAR(s.report.objects[0].area_m2, 1.0, 1e-12);
    EXPECT_LE(s.report.groups[0].imbalance, 1e-12);
    for (std::uint32_t i = 0; i < s.patches.count(); ++i) {
      if (s.patches.object(i) != 0) continue;
      const Rectangle r = s.patches.rectangle(i);
      const bool inner = r.s0 > 0.2 && r.s1 < 0.5 && r.t0 > 0.5 && r.t1 < 0.9;
      if (!inner) {
        EXPECT_NEAR(s.direct_lx[3 * i], 1000.0, 1e-3) << r.s0 << " " << r.t0;
      }
    }
  }
}

TEST(CoveredParts, ACoveredPatchShowsItsOpenNeighboursAndNoLightWhereThereAreNone) {
  // Cells of 1/16 m: the box covers four by six of them and more, so that some have open neighbours
  // and some have none.
  const Solution s = sunlit_floor(0.0625);
  int shown = 0, dark = 0;
  for (std::uint32_t i = 0; i < s.patches.count(); ++i) {
    if (s.patches.object(i) != 0) continue;
    const Rectangle r = s.patches.rectangle(i);
    const double beyond = std::min({r.s0 - 0.2, 0.5 - r.s1, r.t0 - 0.5, 0.9 - r.t1});
    if (beyond < 1e-9) continue;
    const bool has_neighbour = beyond < 0.0625 - 1e-9;
    (has_neighbour ? shown : dark) += 1;
    if (has_neighbour) {
      EXPECT_NEAR(s.direct_lx[3 * i], 1000.0, 1e-3);
    } else {
      EXPECT_EQ(s.direct_lx[3 * i], 0.0F);
    }
    EXPECT_NEAR(s.radiosity[3 * i], 0.5 * (s.direct_lx[3 * i] + s.indirect_lx[3 * i]), 1e-3);
  }
  EXPECT_GT(shown, 0);
  EXPECT_GT(dark, 0);
}

}  // namespace
}  // namespace earthshine::radiosity
