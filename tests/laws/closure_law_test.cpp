// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/support/scene_builder.h"

namespace earthshine {
namespace {

TEST(Closure, NoRayLeaksFromAClosedRoomFarFromTheOrigin) {
  // Two million rays from all walls; the room is 10 km from the origin, to stress single precision.
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.room({m, m, m, m, m, m});
  for (Vec3& p : builder.scene.vertices) p += Vec3(1e4, -1e4, 5e3);
  const tests::Prepared prepared(builder.scene);
  const radiosity::Patches patches = radiosity::subdivide(builder.scene, 0.25);
  const radiosity::FormFactors factors =
      radiosity::cast_form_factors(builder.scene, prepared.query, patches, {1 << 14, 7});
  EXPECT_GT(factors.ray_count, 1500000U);
  for (std::size_t i = 0; i < factors.count(); ++i) {
    EXPECT_EQ(factors.sky[i], 0.0);
    EXPECT_EQ(factors.black[i], 0.0);
  }
}

}  // namespace
}  // namespace earthshine
