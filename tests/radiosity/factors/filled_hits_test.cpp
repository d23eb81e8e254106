// SPDX-License-Identifier: Apache-2.0
#include "radiosity/factors/filled_hits.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "base/parallel.h"
#include "radiosity/factors/column_sums.h"
#include "tests/support/scene_builder.h"

namespace earthshine::radiosity {
namespace {

// A closed matrix of hits without geometry, 64 rays per row.
FormFactors of_hits(const std::vector<std::vector<std::pair<std::uint32_t, float>>>& rows) {
  FormFactors f;
  f.rays_per_patch = 64;
  f.row_start = {0};
  for (const auto& row : rows) {
    for (const auto& [column, hits] : row) {
      f.column.push_back(column);
      f.hits.push_back(hits);
    }
    f.row_start.push_back(f.column.size());
  }
  f.row_scale.assign(rows.size(), 1.0 / 64.0);
  f.column_scale.assign(rows.size(), 1.0);
  f.kept.assign(rows.size(), 1.0);
  for (auto* share : {&f.sky, &f.black, &f.escape, &f.lost}) share->assign(rows.size(), 0.0);
  f.sky_illuminance.assign(rows.size(), Rgb(0.0));
  return f;
}

double entry(const FormFactors& f, std::uint32_t i, std::uint32_t j) {
  for (std::uint64_t e = f.row_start[i]; e < f.row_start[i + 1]; ++e) {
    if (f.column[e] == j) return f.row_scale[i] * double(f.hits[e]) * f.column_scale[j];
  }
  return 0.0;
}

TEST(ColumnSums, AreThoseOfAllRowsHoweverFewThereAre) {
  // Rows are summed in 16 bands. Sums of counts over 64 are exact in any order.
  for (const std::uint32_t count : {1U, 2U, 5U, 15U, 16U, 17U, 100U}) {
    std::vector<std::vector<std::pair<std::uint32_t, float>>> rows(count);
    std::vector<double> expected(count, 0.0);
    for (std::uint32_t i = 0; i < count; ++i) {
      for (std::uint32_t j = i % 3; j < count; j += 1 + i % 2) {
        rows[i].emplace_back(j, static_cast<float>(1 + (7 * i + 3 * j) % 5));
        expected[j] += double(rows[i].back().second) / 64.0;
      }
    }
    EXPECT_EQ(weighted_column_sums(of_hits(rows), [](std::size_t) { return 1.0; }), expected);
  }
}

TEST(FilledHits, LightThatFindsNoWayBackGetsOne) {
  // 0 and 1 hit only each other, half of the light of 2 goes to 0, and 3 hits 2. Nothing returns
  // across the cut between {0, 1} and {2, 3}, so that columns 0 and 1 have 2.5 areas of light for
  // 2. Conservation across the cut requires A_0 F_02 = A_2 F_20. Scaling the hits alone would drive
  // F_20, 0.5 by the hits, to 0.
  FormFactors f = of_hits({{{1, 64}}, {{0, 64}}, {{0, 32}, {3, 32}}, {{2, 64}}});
  const std::vector<double> area = {1.0, 1.0, 1.0, 1.0};
  const BalanceReport report = balance(f, area);
  EXPECT_TRUE(report.balanced) << report.after;
  EXPECT_GT(report.filled, 0U);
  EXPECT_GT(entry(f, 2, 0), 1e-3);
  EXPECT_NEAR(entry(f, 0, 2), entry(f, 2, 0), 1e-11);
}

TEST(FilledHits, APatchWhoseLightHasNoRoomElsewhereKeepsTheRest) {
  // Patch 0 of 3 m2 hits only 1 and 2, of 1 m2 each, which can receive 2 of its 3 m2 of light: the
  // pattern is symmetric, and yet there is no scaling. The last third stays on patch 0: 1 of 5 m2
  // in total, and none on 1 and 2, which 0 fills.
  FormFactors f = of_hits({{{1, 32}, {2, 32}}, {{0, 64}}, {{0, 64}}});
  const std::vector<double> area = {3.0, 1.0, 1.0};
  const BalanceReport report = balance(f, area);
  EXPECT_TRUE(report.balanced) << report.after;
  EXPECT_NEAR(entry(f, 0, 0), 1.0 / 3.0, 1e-3);
  EXPECT_NEAR(report.held, 0.2, 1e-3);
  EXPECT_EQ(report.worst, 0U);
}

TEST(FilledHits, FewRaysBalanceToTheSameBytesOnOneThreadAndTwo) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.room({m, m, m, m, m, m});
  const scenes::RayQuery query(builder.scene);
  const Patches patches = subdivide(builder.scene, 0.05);
  const auto balanced = [&](int threads) {
    const base::ThreadLimit limit(threads);
    FormFactors factors = cast_form_factors(builder.scene, query, patches, {8, 1});
    EXPECT_GT(balance(factors, patches.area_m2).filled, 0U);
    return factors;
  };
  const FormFactors one = balanced(1), two = balanced(2);
  EXPECT_EQ(one.hits, two.hits);
  EXPECT_EQ(one.column, two.column);
  EXPECT_EQ(one.row_scale, two.row_scale);
  EXPECT_EQ(one.column_scale, two.column_scale);
}

}  // namespace
}  // namespace earthshine::radiosity
