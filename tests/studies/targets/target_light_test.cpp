// SPDX-License-Identifier: Apache-2.0
#include "studies/targets/target_light.h"

#include <gtest/gtest.h>

#include "tests/studies/plates.h"

namespace earthshine::studies {
namespace {

std::optional<TargetLight> light_of(const scenes::Scene& scene, const scenes::Camera& camera,
                                    int size) {
  const auto frame = tests::direct_picture(scene, camera, size);
  const std::vector<TargetView> views = find_targets(scene, camera, object_map(frame.image));
  EXPECT_EQ(views.size(), 1U);
  return measure_light(views.front(), base::luminance_of(frame.image));
}

// Under one Sun the luminances are rho E / pi, so that C = rho_t / rho_b - 1, wherever the plate's
// edge divides a pixel: 37 pixels on 1.7 m put it anywhere.
TEST(TargetLight, WeberContrastOfAPlateOnGroundIsExact) {
  for (const auto& [ground, plate] : {std::pair{0.4, 0.6}, {0.8, 0.2}, {0.5, 0.5}, {0.5, 0.0}}) {
    auto builder = tests::plate_on_ground(ground, plate);
    builder.scene.sun = tests::overhead_sun(1000.0);
    const auto light = light_of(builder.scene, tests::above(2.0, 1.7), 37);
    ASSERT_TRUE(light && light->contrast);
    EXPECT_NEAR(light->luminance, plate * 1000.0 / base::pi, 1e-3);
    EXPECT_NEAR(*light->surround, ground * 1000.0 / base::pi, 1e-3);
    EXPECT_NEAR(*light->contrast, plate / ground - 1.0, 1e-5);
  }
}

TEST(TargetLight, NothingIsSaidWhereThereIsNothingToCompareWith) {
  auto builder = tests::plate_on_ground(0.0, 0.5);
  builder.scene.sun = tests::overhead_sun(1000.0);
  const auto on_black = light_of(builder.scene, tests::above(2.0, 2.0), 32);
  EXPECT_EQ(on_black->surround, 0.0);
  EXPECT_FALSE(on_black->contrast);
  const auto alone = light_of(builder.scene, tests::above(2.0, 0.5), 16);
  EXPECT_NEAR(alone->luminance, 500.0 / base::pi, 1e-3);
  EXPECT_FALSE(alone->surround || alone->contrast);
}

TEST(TargetLight, OutOfTheFrameThereIsNone) {
  auto builder = tests::plate_on_ground(0.4, 0.6);
  scenes::Camera away = tests::above(2.0, 1.0);
  away.look_at = Vec3(9, 0, 9);
  EXPECT_FALSE(light_of(builder.scene, away, 16));
}

}  // namespace
}  // namespace earthshine::studies
