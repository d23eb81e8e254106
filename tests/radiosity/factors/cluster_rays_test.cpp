// SPDX-License-Identifier: Apache-2.0
// Form factors and energy of face clusters (radiosity/patches/clusters.h).
#include <gtest/gtest.h>

#include <cmath>

#include "radiosity/factors/form_factors.h"
#include "tests/support/fine_meshes.h"

namespace earthshine::radiosity {
namespace {

// Rays of a cluster start on its triangles and leave on their side: rays of a convex body do not
// hit it.
TEST(ClusterRays, RaysOfAConvexBodyLeaveIt) {
  tests::SceneBuilder builder;
  tests::fine_sphere(builder, builder.material(tests::grey(0.5)), {0, 0, 0}, 1.0, 24);
  const scenes::RayQuery query(builder.scene);
  const Patches patches = subdivide(builder.scene, 0.5, 0.5);
  FormFactorOptions options;
  options.rays_per_patch = 256;
  const FormFactors factors = cast_form_factors(builder.scene, query, patches, options);
  EXPECT_TRUE(factors.column.empty());
  for (const double sky : factors.sky) EXPECT_EQ(sky, 1.0);
}

// A closed room in which everything emits M and reflects rho has B = M / (1 - rho) everywhere,
// including a sphere of 99 904 triangles, whose few patches see rounded neighbours; the energy
// balance closes.
TEST(ClusterRays, AFurnaceWithAFineSphereIsExact) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.6, 0.4));
  builder.room({m, m, m, m, m, m});
  tests::fine_sphere(builder, m, {0.5, 0.5, 0.45}, 0.25, 158);
  ASSERT_GT(builder.scene.triangles.size(), 99000U);
  const tests::Prepared prepared(builder.scene);
  SolveOptions options;
  options.patch_edge_m = 0.2;
  options.form_factor_rays = 256;
  const Solution solution = prepared.solve(options);
  ASSERT_NE(solution.patches.clustered, nullptr);
  EXPECT_LT(solution.patches.count(), 1500U);
  for (const float b : solution.radiosity) EXPECT_NEAR(b, 1.0, 1e-6);
  for (const GroupLedger& group : solution.report.groups) EXPECT_LT(group.imbalance, 1e-12);
  EXPECT_TRUE(solution.report.balance.balanced);
}

// Seen from inside a sphere every cluster is concave and lights itself: by the cosine law a share F
// = A / A_sphere of all light arrives at any area A of a sphere, including the sender (up to chords
// for arcs), and rows without it would not close.
TEST(ClusterRays, HollowOnesLightThemselves) {
  tests::SceneBuilder builder;
  tests::fine_sphere(builder, builder.material(tests::grey(0.5)), {0, 0, 0}, 1.0, 48);
  for (scenes::Triangle& t : builder.scene.triangles) std::swap(t.vertex[1], t.vertex[2]);
  const scenes::RayQuery query(builder.scene);
  const Patches patches = subdivide(builder.scene, 0.5, 0.5);
  FormFactorOptions options;
  options.rays_per_patch = 1024;
  const FormFactors factors = cast_form_factors(builder.scene, query, patches, options);
  double kept = 0.0, area = 0.0, expected = 0.0, variance = 0.0;
  for (std::uint32_t i = 0; i < patches.count(); ++i) area += patches.area_m2[i];
  for (std::uint32_t i = 0; i < patches.count(); ++i) {
    double row = 0.0;
    for (std::uint64_t e = factors.row_start[i]; e < factors.row_start[i + 1]; ++e) {
      row += factors.row_scale[i] * double(factors.hits[e]);
      if (factors.column[e] == i) kept += factors.row_scale[i] * double(factors.hits[e]);
    }
    EXPECT_NEAR(row, 1.0, 1e-6) << i;
    const double share = patches.area_m2[i] / area;
    expected += share;
    variance += share * (1.0 - share) / options.rays_per_patch;
  }
  EXPECT_NEAR(kept, expected, 4.0 * std::sqrt(variance) + 0.02 * expected);
}

}  // namespace
}  // namespace earthshine::radiosity
