// SPDX-License-Identifier: Apache-2.0
#include "scenes/ray_query.h"

#include <gtest/gtest.h>

#include "tests/support/scene_builder.h"

namespace earthshine::scenes {
namespace {

TEST(RayQuery, PacketAndSingleRayFindTheSamePointAndSide) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.plate(m, 2.0, 1.0, false);
  const RayQuery query(builder.scene);
  RayPacket rays;
  HitPacket hits;
  for (std::size_t k = 0; k < RayPacket::width; ++k) {
    query.set(rays, k, {0.1 * double(k) - 0.3, 0.2, 0.0}, {0, 0, k % 2 == 0 ? 1.0 : -1.0});
  }
  query.closest(rays, RayPacket::width, hits);
  for (std::size_t k = 0; k < RayPacket::width; ++k) {
    const Hit hit = query.closest({0.1 * double(k) - 0.3, 0.2, 0.0}, {0, 0, k % 2 == 0 ? 1 : -1});
    EXPECT_EQ(hits.triangle[k], hit.triangle);
    EXPECT_EQ(hit.missed(), k % 2 == 1);
    if (hit.missed()) continue;
    EXPECT_NEAR(hit.t, 1.0, 1e-6);
    EXPECT_EQ(hits.front[k], 1U);
    EXPECT_TRUE(hit.front);
  }
}

TEST(RayQuery, LanesBeyondTheCountAreNotTraced) {
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 2.0, 1.0, false);
  const RayQuery query(builder.scene);
  RayPacket rays{};
  for (std::size_t k = 0; k < RayPacket::width; ++k) query.set(rays, k, {0, 0, 0}, {0, 0, 1});
  HitPacket hits;
  query.closest(rays, 3, hits);
  EXPECT_NE(hits.triangle[2], no_triangle);
  EXPECT_EQ(hits.triangle[3], no_triangle);
  EXPECT_EQ(query.occluded(rays, 3), 0b111U);
}

TEST(RayQuery, ShadowRayStopsAtItsEnd) {
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 2.0, 1.0, false);
  const RayQuery query(builder.scene);
  RayPacket rays{};
  query.set(rays, 0, {0, 0, 0}, {0, 0, 1}, 0.999);
  query.set(rays, 1, {0, 0, 0}, {0, 0, 1}, 1.001);
  EXPECT_EQ(query.occluded(rays, 2), 0b10U);
}

// Only then subtracting it from near points is exact, and equal with every compiler.
TEST(RayQuery, SinglePrecisionHoldsTheCentre) {
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 2.0, 1.0, false);
  for (Vec3& vertex : builder.scene.vertices) vertex += Vec3(0.1, 0.2, 0.3);
  const Vec3 centre = RayQuery(builder.scene).centre();
  for (int k = 0; k < 3; ++k) {
    const volatile auto held = static_cast<float>(centre[k]);
    EXPECT_EQ(centre[k], double(held)) << k;
    EXPECT_NE(centre[k], 0.0) << k;
  }
}

TEST(RayQuery, EmptySceneLetsEverythingPass) {
  const Scene scene;
  const RayQuery query(scene);
  EXPECT_TRUE(query.closest({0, 0, 0}, {0, 0, 1}).missed());
}

}  // namespace
}  // namespace earthshine::scenes
