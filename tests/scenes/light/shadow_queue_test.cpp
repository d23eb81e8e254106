// SPDX-License-Identifier: Apache-2.0
#include "scenes/light/shadow_queue.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "tests/support/scene_builder.h"

namespace earthshine::scenes {
namespace {

struct Taken {
  std::vector<int> item;
  std::vector<double> share;
};

// Upward rays from twenty points in a row; a roof of 1 m x 1 m covers those with |x| < 0.5.
Taken trace(std::size_t most, std::uint64_t& rays) {
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 1.0, 1.0, false);
  const RayQuery query(builder.scene);
  Taken taken;
  const auto take = [&](int item, const Rgb& share) {
    taken.item.push_back(item);
    taken.share.push_back(share.g);
  };
  ShadowQueue<int> queue(query, most);
  const LightSample sky{{0, 0, 1}, std::numeric_limits<double>::infinity(), Rgb(1.0)};
  for (int k = 0; k < 20; ++k) {
    const Vec3 point(0.1 * k - 0.95, 0.01, 0.0);
    queue.add(sky, point, point, k, take, static_cast<std::size_t>(k % 2));
  }
  queue.trace(take);
  rays = queue.rays();
  return taken;
}

TEST(ShadowQueue, EachRayGetsItsShareInTheOrderOfTheRays) {
  std::uint64_t rays = 0;
  const Taken taken = trace(RayPacket::width, rays);
  ASSERT_EQ(taken.item.size(), 20U);
  EXPECT_EQ(rays, 20U);
  for (int k = 0; k < 20; ++k) {
    const auto at = static_cast<std::size_t>(k);
    EXPECT_EQ(taken.item[at], k);
    EXPECT_EQ(taken.share[at], k >= 5 && k < 15 ? 0.0 : 1.0) << k;  // x = -0.45 .. 0.45
  }
}

// Even rays go to one light, odd rays to another.
TEST(ShadowQueue, ALongQueueTracesTheRaysOfOneLightTogether) {
  std::uint64_t rays = 0;
  const Taken taken = trace(64, rays);
  ASSERT_EQ(taken.item.size(), 20U);
  for (int k = 0; k < 20; ++k) {
    const auto at = static_cast<std::size_t>(k);
    EXPECT_EQ(taken.item[at], k < 10 ? 2 * k : 2 * k - 19);
    EXPECT_EQ(taken.share[at], taken.item[at] >= 5 && taken.item[at] < 15 ? 0.0 : 1.0);
  }
}

// Nothing fits between a surface and a source that touches it.
TEST(ShadowQueue, ASourceWithinTheOffsetNeedsNoRay) {
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 1.0, 0.0, true);
  const RayQuery query(builder.scene);
  ShadowQueue<int> queue(query);
  int calls = 0;
  const auto take = [&](int, const Rgb&) { ++calls; };
  const LightSample touching{{0, 0, 1}, 1e-6, Rgb(1.0)};
  queue.add(touching, Vec3(0.0), Vec3(0, 0, 1e-5), 1, take);
  queue.trace(take);
  EXPECT_EQ(calls, 0);
  EXPECT_EQ(queue.rays(), 0U);
}

}  // namespace
}  // namespace earthshine::scenes
