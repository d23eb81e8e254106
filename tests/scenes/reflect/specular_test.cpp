// SPDX-License-Identifier: Apache-2.0
#include "scenes/reflect/specular.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "scenes/specular_paths.h"
#include "tests/support/scene_builder.h"

namespace earthshine::scenes {
namespace {

// A unit square at z = 0, front up.
Scene square(const Material& material) {
  tests::SceneBuilder builder;
  builder.quad(builder.material(material), {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  return builder.scene;
}

TEST(Specular, StepFromACornerStartsInsideTheMirrorOnTheReflectedSide) {
  // A hundred-thousandth of the distance from the corner (0, 0) to the triangle's middle (2/3,
  // 1/3).
  Material mirror = tests::grey(0.0);
  mirror.mirror = Rgb(0.9);
  const Scene scene = square(mirror);
  const Vec3 down = glm::normalize(Vec3(1, 0, -1));
  const SpecularStep step = specular_step(scene, {0, 0.0, 0.0, 1.0, true}, down, 1e-6);
  EXPECT_NEAR(step.origin.x, 1e-5 * 2.0 / 3.0, 1e-15);
  EXPECT_NEAR(step.origin.y, 1e-5 / 3.0, 1e-15);
  EXPECT_NEAR(step.origin.z, 1e-6, 1e-18);
  EXPECT_NEAR(glm::length(step.direction - glm::normalize(Vec3(1, 0, 1))), 0.0, 1e-15);
}

// Aimed rays stay on their line, so that they reach their target, unless this leads past the
// triangle's edge, where a wall may be.
TEST(Specular, AimedStepsThroughASheetStayOnTheirLine) {
  Material glass = tests::grey(0.0);
  glass.transmit = Rgb(0.9);
  glass.two_sided = true;
  const Scene scene = square(glass);
  const Vec3 down = glm::normalize(Vec3(5, 0, -1));
  constexpr double offset = 1e-3;
  const Hit inside{0, 0.2, 0.3, 1.0, true}, at_edge{0, 0.3, 0.6995, 1.0, true};
  const SpecularStep aimed = specular_step(scene, inside, down, offset, true);
  EXPECT_NEAR(glm::length(aimed.origin - (hit_position(scene, inside) + offset * Vec3(5, 0, -1))),
              0.0, 1e-15);
  EXPECT_EQ(aimed.direction, down);
  const SpecularStep safe = specular_step(scene, at_edge, down, offset, true),
                     found = specular_step(scene, at_edge, down, offset);
  EXPECT_EQ(safe.origin, found.origin);
  EXPECT_NEAR(found.origin.z, -offset, 1e-15);
}

// A mirror reflects a grazing ray nearly along its own direction.
TEST(Specular, WhatIsMoreOfAMirrorThanGlassLetsNothingStraightOn) {
  Material pane = tests::grey(0.0);
  pane.two_sided = true;
  pane.mirror = Rgb(0.6);
  pane.transmit = Rgb(0.3);
  const Vec3 grazing = glm::normalize(Vec3(10, 0, -1)), up(0, 0, 1);
  EXPECT_FALSE(goes_straight_on(grazing, specular_direction(pane, up, grazing)));
  pane.transmit = Rgb(0.61);
  EXPECT_TRUE(goes_straight_on(grazing, specular_direction(pane, up, grazing)));
}

TEST(Specular, StepThroughGlassGoesOnBelow) {
  Material glass = tests::grey(0.0);
  glass.transmit = Rgb(0.9);
  glass.ior = 1.5;
  const Scene scene = square(glass);
  const Vec3 down = glm::normalize(Vec3(1, 0, -1));
  const SpecularStep step = specular_step(scene, {0, 0.3, 0.3, 1.0, true}, down, 1e-6);
  EXPECT_NEAR(step.origin.z, -1e-6, 1e-18);
  EXPECT_NEAR(step.direction.x, std::sqrt(0.5) / 1.5, 1e-15);  // Snell's law
  EXPECT_LT(step.direction.z, 0.0);
}

// Between two parallel mirrors a ray never ends: the visitor ends it. A ray that may only continue
// straight ends at the first mirror.
TEST(Specular, ARayIsFollowedUntilItsVisitorEndsIt) {
  tests::SceneBuilder builder;
  Material mirror = tests::grey(0.0);
  mirror.mirror = Rgb(0.9);
  const std::uint32_t m = builder.material(mirror);
  builder.plate(m, 1.0, 0.0, true);
  builder.plate(m, 1.0, 1.0, false);
  const RayQuery query(builder.scene);
  const Vec3 down(0, 0, -1);
  const Hit first = query.closest({0.1, 0.2, 0.5}, down);
  std::vector<double> along;
  const auto visit = [&](const Hit& hit, const Vec3& direction, int step) {
    EXPECT_FALSE(hit.missed());
    EXPECT_EQ(static_cast<std::size_t>(step), along.size());
    along.push_back(direction.z);
    return step < 3;
  };
  follow_specular(builder.scene, query, first, down, false, visit);
  EXPECT_EQ(along, (std::vector<double>{-1.0, 1.0, -1.0, 1.0}));
  along.clear();
  follow_specular(builder.scene, query, first, down, true, visit);
  EXPECT_EQ(along, (std::vector<double>{-1.0}));
}

}  // namespace
}  // namespace earthshine::scenes
