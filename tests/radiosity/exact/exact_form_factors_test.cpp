// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "base/parallel.h"
#include "radiosity/exact/form_factors.h"
#include "scenes/read/scene_file.h"
#include "tests/support/boxes.h"

namespace earthshine::radiosity {
namespace {

constexpr double whole = 1e9;  // an edge length that gives one patch per facet

struct Made {
  Patches patches;
  ExactFormFactors exact;

  [[nodiscard]] double form_factor(std::size_t i, std::size_t j) const {
    const FormFactors& f = exact.factors;
    for (std::uint64_t e = f.row_start[i]; e < f.row_start[i + 1]; ++e) {
      if (f.column[e] == j) return f.row_scale[i] * double(f.hits[e]);
    }
    return 0.0;
  }
  [[nodiscard]] double row_sum(std::size_t i) const {
    const FormFactors& f = exact.factors;
    double sum = 0.0;
    for (std::uint64_t e = f.row_start[i]; e < f.row_start[i + 1]; ++e) sum += double(f.hits[e]);
    return f.row_scale[i] * sum + f.sky[i] + f.black[i];
  }
};

Made make(const scenes::Scene& scene, const Patches& patches, const ExactOptions& options = {},
          const SkyRadiance& sky = {}) {
  return {patches, exact_form_factors(scene, scenes::RayQuery(scene), patches, options, sky)};
}
Made make(const scenes::Scene& scene, double edge_m, const ExactOptions& options = {}) {
  return make(scene, subdivide(scene, edge_m), options);
}

scenes::Material sheet() {
  scenes::Material material = tests::grey(0.5);
  material.two_sided = true;
  return material;
}

// Mean over rows of sqrt(sum_j (F_ij - G_ij)^2), from the unscaled pairs.
double row_distance(const Patches& patches, const PairExchange& one, const PairExchange& two) {
  std::vector<double> square(patches.count(), 0.0);
  for (std::size_t i = 0; i < patches.count(); ++i) {
    for (std::size_t j = i + 1; j < patches.count(); ++j) {
      const double d = one.upper_m2[one.index(i, j)] - two.upper_m2[two.index(i, j)];
      square[i] += d * d / (patches.area_m2[i] * patches.area_m2[i]);
      square[j] += d * d / (patches.area_m2[j] * patches.area_m2[j]);
    }
  }
  double sum = 0.0;
  for (const double s : square) sum += std::sqrt(s);
  return sum / static_cast<double>(patches.count());
}

// Unit squares of a room at any position: with a common edge C-14 of Howell, opposite C-11.
TEST(ExactFormFactors, ARoomOfWholeFacesIsExactHereAndAMillionMetresAway) {
  for (const double away : {0.0, 1e6}) {
    tests::SceneBuilder builder;
    const std::uint32_t m = builder.material(tests::grey(0.5));
    builder.room({m, m, m, m, m, m});
    for (Vec3& v : builder.scene.vertices) v += Vec3(away, -away, away);
    const Made made = make(builder.scene, whole);
    EXPECT_NEAR(made.form_factor(0, 2), 0.2000437760754, 1e-7) << away;
    EXPECT_NEAR(made.form_factor(4, 5), 0.19982489569838, 1e-7) << away;
    EXPECT_LT(made.exact.report.max_closed_defect, 1e-6) << away;
  }
}

TEST(ExactFormFactors, BlockersAtHalfHeightTakeTheirExactShare) {
  // Unit squares 1 m apart, a blocker of side s between them: a ray is blocked if and only if its
  // midpoint is in the blocker (view-factor library of the project's cases).
  const double side[] = {0.25, 0.5, 0.75};
  const double exact[] = {0.16947420491179, 0.099506294598985, 0.02948354491476};
  for (int k = 0; k < 3; ++k) {
    tests::SceneBuilder builder;
    const std::uint32_t m = builder.material(tests::grey(0.5)), thin = builder.material(sheet());
    builder.plate(m, 1.0, 0.0, true);
    builder.plate(m, 1.0, 1.0, false);
    builder.plate(thin, side[k], 0.5, true);
    const Made made = make(builder.scene, whole);
    EXPECT_NEAR(made.form_factor(0, 1), exact[k], 1e-5) << side[k];
    // With 4 x 4 patches each, the mean over the patches is the same. A sheet's front faces up; its
    // patches follow the plates' patches.
    const Made cut = make(builder.scene, 0.25);
    double sum = 0.0;
    for (std::size_t i = 0; i < 16; ++i) {
      for (std::size_t j = 16; j < 32; ++j) sum += cut.form_factor(i, j) / 16.0;
    }
    EXPECT_NEAR(sum, exact[k], 1e-5) << side[k];
  }
}

TEST(ExactFormFactors, ATiltedBlockerHidesWhatRaysSayItHides) {
  // No edge is parallel to the receivers' sides, so that no kinks are known in advance. Ray-cast F
  // with 2^19 rays, within 4 binomial standard errors.
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5)), thin = builder.material(sheet());
  builder.plate(m, 1.0, 0.0, true);
  builder.plate(m, 1.0, 1.0, false);
  const Vec3 a(0.35, 0.2, 0.15), b(-0.15, 0.4, 0.1), corner(-0.3, -0.2, 0.35);
  builder.quad(thin, corner, corner + a, corner + a + b, corner + b);
  const Made made = make(builder.scene, whole);
  const int rays = 1 << 19;
  const FormFactors cast =
      cast_form_factors(builder.scene, scenes::RayQuery(builder.scene), made.patches, {rays, 1});
  for (std::size_t i = 0; i < cast.count(); ++i) {
    for (std::uint64_t e = cast.row_start[i]; e < cast.row_start[i + 1]; ++e) {
      const double f = double(cast.hits[e]) * cast.row_scale[i];
      EXPECT_NEAR(made.form_factor(i, cast.column[e]), f, 4.0 * std::sqrt(f * (1.0 - f) / rays));
    }
  }
  EXPECT_GT(made.exact.report.counts.partly_hidden, 0U);
}

TEST(ExactFormFactors, CubeWithABoxClosesBeforeAnyRowIsScaled) {
  // 408 patches without a reference: every row must add up to 1. The default tolerance leaves at
  // most 1e-4 of a row, a tenth of it a hundredth.
  const tests::CutScene cut = tests::cube_and_box(8);
  const Made coarse = make(cut.scene, cut.patches);
  EXPECT_EQ(coarse.exact.report.closed_rows, 408U);
  EXPECT_LT(coarse.exact.report.max_closed_defect, 1e-4);
  const Made fine = make(cut.scene, cut.patches, {.tolerance = 1e-6});
  EXPECT_LT(fine.exact.report.max_closed_defect, 4e-6);
  for (std::size_t i = 0; i < 408; ++i) EXPECT_NEAR(coarse.row_sum(i), 1.0, 1e-14);
}

TEST(ExactFormFactors, CubeWithABoxStaysWithinItsEstimatedError) {
  const tests::CutScene cut = tests::cube_and_box(8);
  const FacetSides sides(cut.patches);
  const PairExchange coarse = exchange_of_pairs(cut.patches, sides, {}, 1e-5);
  const PairExchange fine = exchange_of_pairs(cut.patches, sides, {}, 1e-6);
  EXPECT_LT(row_distance(cut.patches, coarse, fine), 2e-5);
  double estimated = 0.0;
  for (const double square : coarse.row_square_error) estimated += std::sqrt(square) / 408.0;
  EXPECT_GT(estimated, row_distance(cut.patches, coarse, fine));
  EXPECT_LT(estimated, 1e-4);
}

TEST(ExactFormFactors, ARoomFullOfBoxesCloses) {
  // 2 x 2 x 2 boxes: narrow views between them, and some 100 partly hidden pairs per row with
  // errors of at most 1e-5 of either sign.
  const tests::CutScene cut = tests::cube_and_boxes(4, 2);
  const Made made = make(cut.scene, cut.patches);
  EXPECT_EQ(made.exact.report.closed_rows, cut.patches.count());
  EXPECT_LT(made.exact.report.max_closed_defect, 2e-4);
  const PairCounts& counts = made.exact.report.counts;
  EXPECT_EQ(counts.facing_away + counts.unoccluded + counts.partly_hidden + counts.wholly_hidden,
            made.exact.report.pairs);
  EXPECT_GT(counts.wholly_hidden, 0U);
}

TEST(ExactFormFactors, ARoundBodyOfManyFacesHidesAsOneOutline) {
  // The furnace of the library: a sphere of some 500 triangles and a block in a closed room.
  const scenes::Scene scene = scenes::read_scene(std::filesystem::path(EARTHSHINE_SOURCE_DIR) /
                                                 "scenes/library/furnace/scene.toml");
  const Made made = make(scene, whole);
  EXPECT_EQ(made.exact.report.closed_rows, made.patches.count());
  EXPECT_LT(made.exact.report.max_closed_defect, 3e-5);
}

TEST(ExactFormFactors, ExchangesAreReciprocalToSinglePrecision) {
  // A_i F_ij = A_j F_ji: both come from one number, rounded to float in the rows and scaled by row
  // scales that differ from 1 by the closure's defect.
  const tests::CutScene cut = tests::cube_and_box(4);
  const Made made = make(cut.scene, cut.patches, {.tolerance = 1e-7});
  for (std::size_t i = 0; i < cut.patches.count(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double there = cut.patches.area_m2[i] * made.form_factor(i, j);
      EXPECT_NEAR(there, cut.patches.area_m2[j] * made.form_factor(j, i), 1e-6 * there);
    }
  }
}

TEST(ExactFormFactors, BothSidesOfASheetSeeTheirOwnHalfOfTheRoom) {
  // A sheet across the room at mid height: the front sees the ceiling at 1/2 m (C-11 with X = 2),
  // the back the floor, neither the other; the ceiling does not see the floor.
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5)), thin = builder.material(sheet());
  builder.room({m, m, m, m, m, m});
  builder.quad(thin, {0, 0, 0.5}, {1, 0, 0.5}, {1, 1, 0.5}, {0, 1, 0.5});
  const Made made = make(builder.scene, whole);
  EXPECT_NEAR(made.form_factor(6, 5), 0.41525328357715, 1e-7);
  EXPECT_NEAR(made.form_factor(7, 4), 0.41525328357715, 1e-7);
  EXPECT_EQ(made.form_factor(6, 4), 0.0);
  EXPECT_EQ(made.form_factor(6, 7), 0.0);
  EXPECT_EQ(made.form_factor(4, 5), 0.0);
  EXPECT_LT(made.exact.report.max_closed_defect, 2e-5);
}

TEST(ExactFormFactors, WhatIsLeftOpenIsSkyOrBlackBack) {
  // The lower plate sees the black back of the upper one, 1 m above: F = 0.19982 by C-11. It sees
  // no patch, so that rays alone divide the row: 4 standard errors of 4096.
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.plate(m, 1.0, 0.0, true);
  builder.plate(m, 1.0, 1.0, true);
  const Made made = make(builder.scene, whole, {.split_rays = 4096});
  EXPECT_NEAR(made.exact.factors.black[0], 0.19982489569838, 4 * 0.4 / std::sqrt(4096.0));
  EXPECT_EQ(made.exact.factors.black[1], 0.0);
  EXPECT_EQ(made.exact.factors.sky[1], 1.0);
  EXPECT_EQ(made.row_sum(0), 1.0);
}

TEST(ExactFormFactors, SkyIlluminanceOfAUniformSkyIsPiLTimesTheSkysShare) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.plate(m, 1.0, 0.0, true);
  builder.plate(m, 1.0, 1.0, false);
  const Made made = make(builder.scene, subdivide(builder.scene, whole), {},
                         [](const Vec3&) { return Rgb(100.0); });
  // Everything except the other plate is sky, and its share is as accurate as the plate's.
  EXPECT_NEAR(made.exact.factors.sky[0], 1.0 - 0.19982489569838, 1e-7);
  EXPECT_NEAR(made.exact.factors.sky_illuminance[0].g, 100.0 * base::pi * made.exact.factors.sky[0],
              1e-9);
}

TEST(ExactFormFactors, BodiesInsideBodiesAndTwinFacesStayWithinBounds) {
  // Two boxes at one place, one box inside another, one through its side and the room's floor: no
  // law applies, but factors are finite in [0, 1] and rows closed.
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.room({m, m, m, m, m, m});
  tests::add_box(builder, m, Vec3(0.3), Vec3(0.6));
  tests::add_box(builder, m, Vec3(0.3), Vec3(0.6));
  tests::add_box(builder, m, Vec3(0.4), Vec3(0.5));
  tests::add_box(builder, m, {0.5, 0.4, -0.2}, {0.8, 0.5, 0.4});
  const Made made = make(builder.scene, 0.5);
  const FormFactors& f = made.exact.factors;
  for (std::size_t i = 0; i < f.count(); ++i) {
    EXPECT_NEAR(made.row_sum(i), 1.0, 1e-14);
    EXPECT_GE(f.sky[i], 0.0);
    EXPECT_GE(f.black[i], 0.0);
  }
  for (const float hits : f.hits) {
    ASSERT_GT(hits, 0.0F);
    ASSERT_LE(hits, 1.0F);
  }
}

TEST(ExactFormFactors, AWallThroughTheFloorCountsWithItsUpperPart) {
  // No light arrives from below the floor's plane: C-14 for the upper half of the wall; the part of
  // the floor behind the wall sees its black back.
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.quad(m, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  builder.quad(m, {0, 0, -1}, {0, 1, -1}, {0, 1, 1}, {0, 0, 1});
  EXPECT_NEAR(make(builder.scene, whole).form_factor(0, 1), 0.2000437760754, 1e-7);
}

TEST(ExactFormFactors, SameBytesOnOneAndTwoThreads) {
  const tests::CutScene cut = tests::cube_and_box(8);
  FormFactors one, two;
  {
    const base::ThreadLimit limit(1);
    one = make(cut.scene, cut.patches).exact.factors;
  }
  {
    const base::ThreadLimit limit(2);
    two = make(cut.scene, cut.patches).exact.factors;
  }
  EXPECT_EQ(one.column, two.column);
  EXPECT_EQ(one.hits, two.hits);
  EXPECT_EQ(one.row_scale, two.row_scale);
}

TEST(ExactFormFactors, MirrorsAndGlassAreRefused) {
  for (const bool glass : {false, true}) {
    tests::SceneBuilder builder;
    scenes::Material material = tests::grey(0.0);
    (glass ? material.transmit : material.mirror) = Rgb(1.0);
    builder.plate(builder.material(material), 1.0, 0.0, true);
    EXPECT_THROW(static_cast<void>(make(builder.scene, whole)), base::Error);
  }
}

}  // namespace
}  // namespace earthshine::radiosity
