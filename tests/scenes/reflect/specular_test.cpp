// SPDX-License-Identifier: Apache-2.0
#include "scenes/reflect/specular.h"

#include <gtest/gtest.h>

#include <cmath>

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
  // A hundred-thousandth of the way from the corner (0, 0) to the triangle's middle (2/3, 1/3).
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

}  // namespace
}  // namespace earthshine::scenes
