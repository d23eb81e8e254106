// SPDX-License-Identifier: Apache-2.0
#include "studies/why/lit_points.h"

#include <gtest/gtest.h>

#include <array>
#include <utility>

#include "tests/studies/plates.h"

namespace earthshine::studies {
namespace {

constexpr int size = 32;
constexpr double reflectance = 0.6;

// A white plate on grey ground, seen from above, below any further plates.
struct Lit {
  tests::SceneBuilder builder = tests::plate_on_ground(0.4, reflectance);
  std::vector<SeenPoint> points;

  // To be called when all plates are there.
  scenes::RayQuery look() {
    scenes::RayQuery query(builder.scene);
    const scenes::Camera camera = tests::above(2.0, 2.0);
    const auto frame = tests::direct_picture(builder.scene, camera, size);
    const TargetView view = find_target(object_map(frame.image), 1);
    points = seen_points(builder.scene, query, camera, size, size, view.measured);
    return query;
  }
  // Shades the points with x < 0 (or x > 0) from above, out of the camera's view.
  void shade(bool left) {
    const double a = left ? -3.0 : 0.0, b = left ? 0.0 : 3.0;
    builder.quad(0, {a, -3, 9}, {b, -3, 9}, {b, 3, 9}, {a, 3, 9});
  }
};

TEST(LitPoints, SeenPointsLieOnTheTargetTowardTheCamera) {
  Lit lit;
  (void)lit.look();
  EXPECT_EQ(lit.points.size(), 196U);  // 14 x 14 of 16 x 16 pixels are inside its outline
  for (const SeenPoint& point : lit.points) {
    EXPECT_NEAR(point.position.z, 0.0, 1e-6);
    EXPECT_NEAR(point.normal.z, 1.0, 1e-9);
    EXPECT_NEAR(point.reflectance, reflectance, 1e-9);
  }
}

TEST(LitPoints, AreAtMostAsManyAsWantedAndSpreadEvenly) {
  const auto builder = tests::plate_on_ground(0.4, reflectance);
  const scenes::RayQuery query(builder.scene);
  const scenes::Camera camera = tests::above(2.0, 2.0);
  std::vector<std::uint32_t> pixels;
  for (std::uint32_t i = 0; i < size * size; ++i) pixels.push_back(i);
  const auto points = seen_points(builder.scene, query, camera, size, size, pixels, 100);
  ASSERT_EQ(points.size(), 100U);
  EXPECT_LT(points.back().position.y, -0.9);  // includes the last rows
}

TEST(LitPoints, HalfShadedPlateIsHalfLitBySunAndTheShadowHasAName) {
  Lit lit;
  lit.shade(true);
  const scenes::RayQuery query = lit.look();
  const Reach sun = reach_of_direction(lit.builder.scene, query, lit.points, Vec3(0, 0, 1), 1000.0);
  EXPECT_NEAR(share_of(sun.lit), 0.5, 1e-9);
  EXPECT_EQ(share_of(sun.facing), 1.0);
  const double full = reflectance * 1000.0 / base::pi;
  EXPECT_NEAR(sun.unshadowed, full, 1e-9 * full);
  EXPECT_NEAR(sun.luminance, 0.5 * full, 1e-9 * full);
  ASSERT_EQ(sun.shadows.size(), 1U);
  EXPECT_EQ(sun.shadows.front().object, 2U);
  EXPECT_EQ(sun.shadows.front().rays, lit.points.size() / 2);
}

TEST(LitPoints, SourceBehindTheSurfaceFacesNothing) {
  Lit lit;
  const scenes::RayQuery query = lit.look();
  const Reach sun =
      reach_of_direction(lit.builder.scene, query, lit.points, Vec3(0, 0, -1), 1000.0);
  EXPECT_EQ(share_of(sun.facing), 0.0);
  EXPECT_EQ(share_of(sun.lit), 0.0);
  EXPECT_EQ(sun.unshadowed, 0.0);
}

// A black back reflects nothing; its front would reflect rho E / pi.
TEST(LitPoints, BlackBackKnowsWhatItsFrontWouldGive) {
  Lit lit;
  for (const std::size_t k : {2U, 3U}) {
    std::uint32_t* corner = lit.builder.scene.triangles[k].vertex;
    std::swap(corner[1], corner[2]);
  }
  const scenes::RayQuery query = lit.look();
  const Reach sun = reach_of_direction(lit.builder.scene, query, lit.points, Vec3(0, 0, 1), 1000.0);
  const double full = reflectance * 1000.0 / base::pi;
  EXPECT_EQ(sun.luminance, 0.0);
  EXPECT_NEAR(sun.on_back, full, 1e-9 * full);
}

TEST(LitPoints, PointLampGivesItsInverseSquareOrItsShadow) {
  Lit lit;
  const scenes::RayQuery query = lit.look();
  scenes::Lamp lamp;
  lamp.position = Vec3(0, 0, 100.0);
  lamp.intensity_cd = Rgb(1e6);
  const Reach reach = reach_of_lamp(lit.builder.scene, query, lit.points, lamp);
  EXPECT_EQ(share_of(reach.lit), 1.0);
  EXPECT_NEAR(reach.luminance, reflectance * 100.0 / base::pi, 0.01);  // 1e6 / 100^2 lx
  lit.builder.plate(0, 6.0, 9.0, true);
  const scenes::RayQuery shaded(lit.builder.scene);
  const Reach dark = reach_of_lamp(lit.builder.scene, shaded, lit.points, lamp);
  EXPECT_EQ(share_of(dark.lit), 0.0);
  EXPECT_NEAR(dark.unshadowed, reach.luminance, 1e-9);
}

TEST(LitPoints, EmittingPlateReachesWhatItFaces) {
  Lit lit;
  const std::uint32_t panel = lit.builder.material(tests::grey(0.0, 500.0));
  lit.builder.plate(panel, 1.0, 5.0, false);
  const scenes::RayQuery query = lit.look();
  const scenes::EmitterSet emitters(lit.builder.scene, panel);
  const Reach reach = reach_of_emitters(lit.builder.scene, query, lit.points, emitters, 16);
  EXPECT_EQ(share_of(reach.lit), 1.0);
  // L = M / pi over 1 m^2 at 5 m: E = M / (25 pi) directly overhead, up to 4 % less at an angle.
  const double overhead = reflectance * 500.0 / (25.0 * base::pi * base::pi);
  EXPECT_NEAR(reach.luminance, overhead, 0.04 * overhead);
}

// A uniform disc of half angle alpha overhead: E = pi L sin^2 alpha. 256 even directions have the
// mean cosine within 1 %.
TEST(LitPoints, EarthOverheadGivesTheIlluminanceOfItsDisc) {
  Lit lit;
  scenes::Earth& uniform = lit.builder.scene.earth.emplace();
  uniform.half_angle_deg = 60.0;
  uniform.model = scenes::EarthModel::Uniform;
  uniform.radiance = Rgb(2000.0);
  const scenes::RayQuery query = lit.look();
  const Reach earth = reach_of_earth(lit.builder.scene, query, lit.points, 256);
  EXPECT_EQ(share_of(earth.lit), 1.0);
  EXPECT_NEAR(earth.luminance, reflectance * 2000.0 * 0.75, 0.01 * reflectance * 1500.0);
  EXPECT_EQ(earth.luminance, earth.unshadowed);
}

TEST(LitPoints, EarthWithoutASunGivesNothing) {
  Lit lit;
  const scenes::RayQuery query = lit.look();
  EXPECT_EQ(share_of(reach_of_earth(lit.builder.scene, query, lit.points).lit), 0.0);
  scenes::Earth earth;
  earth.half_angle_deg = 60.0;
  earth.altitude_m = 3e5;
  const Reach night = reach_of_earth(lit.builder.scene, query, lit.points, earth, std::nullopt);
  EXPECT_EQ(night.lit.size(), lit.points.size());
  EXPECT_EQ(share_of(night.facing), 0.0);
}

}  // namespace
}  // namespace earthshine::studies
