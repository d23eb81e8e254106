// SPDX-License-Identifier: Apache-2.0
// Ray offsets are bounds of the local rounding errors: light and shadow do not depend on the rest
// of the scene.
#include "scenes/surface_offset.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "scenes/ray_query.h"
#include "tests/scenes/scene_text.h"
#include "tests/support/boxes.h"
#include "tests/support/scene_builder.h"

namespace earthshine::scenes {
namespace {

Vec3 unit(std::mt19937& random) {
  std::normal_distribution<double> normal;
  Vec3 v{normal(random), normal(random), normal(random)};
  return glm::normalize(v);
}

// The nearest corners of any triangle decide: an axis-aligned plane through the centre needs no
// offset, a plane 10 m from it along its normal 2 * 2^-24 * (2 * 10 m) = 2.4 um.
TEST(SurfaceOffset, FollowsTheDistanceAlongTheNormal) {
  const double low = rounding_offset_m({{-1e4, -1e4, 0.0}, {1e4, -1e4, 0.0}, {0.0, 1e4, 0.0}});
  EXPECT_LT(low, 1e-7);
  const double high = rounding_offset_m({{-1e3, -1e3, 10.0}, {1e3, -1e3, 10.0}, {0.0, 1e3, 10.0}});
  EXPECT_NEAR(high, 2.0 * 0x1p-24 * 20.0, 1e-12);
}

// Triangles of 1 mm to 10 km, including needles, up to 10 km from the centre: no ray that starts at
// the offset and leaves hits its own triangle. 400 triangles, 256 rays each.
TEST(SurfaceOffset, NoRayMeetsTheTriangleThatItLeaves) {
  std::mt19937 random(61);
  std::uniform_real_distribution<double> even(0.0, 1.0);
  std::size_t wrong = 0, rays_cast = 0;
  for (int n = 0; n < 400; ++n) {
    tests::SceneBuilder builder;
    const std::uint32_t grey = builder.material(tests::grey(0.5));
    // Small and near the camera: the centre of detail.
    builder.plate(grey, 1e-4, 0.0, true);
    Camera camera;
    camera.position = Vec3(0.0, 0.0, 1e-3);
    builder.scene.cameras.push_back(camera);
    const double size = std::pow(10.0, -3.0 + 7.0 * even(random)),
                 away = n % 4 == 0 ? 0.0 : std::pow(10.0, 4.0 * even(random)),
                 narrow = n % 3 == 0 ? std::pow(10.0, -4.0 * even(random)) : 1.0;
    const Vec3 place = away * unit(random), along = unit(random);
    const Vec3 across = glm::normalize(glm::cross(along, unit(random)));
    const Vec3 a = place, b = place + size * along,
               c = place + size * (even(random) * along + narrow * across);
    const auto v = static_cast<std::uint32_t>(builder.scene.vertices.size());
    builder.scene.vertices.insert(builder.scene.vertices.end(), {a, b, c});
    Object object;
    object.name = "triangle";
    object.first_triangle = 2;
    object.triangle_count = 1;
    builder.scene.objects.push_back(object);
    builder.scene.triangles.push_back({{v, v + 1, v + 2}, 1, grey, 1});
    const RayQuery query(builder.scene);
    const Vec3 normal = triangle_normal(builder.scene, 2);
    RayPacket rays;
    HitPacket hits;
    for (int first = 0; first < 256; first += 8) {
      for (std::size_t k = 0; k < RayPacket::width; ++k) {
        const double root = std::sqrt(even(random)), v1 = even(random);
        const Vec3 at = a + root * (1.0 - v1) * (b - a) + root * v1 * (c - a);
        // Half of the rays are grazing.
        Vec3 way = unit(random);
        if (k % 2 == 0) way = glm::normalize(way - (1.0 - 1e-3) * glm::dot(way, normal) * normal);
        const double side = k % 4 < 2 ? 1.0 : -1.0;
        if (side * glm::dot(way, normal) < 0.0) way = -way;
        query.set(rays, k, at + side * query.offset_m(2) * normal, way);
      }
      query.closest(rays, RayPacket::width, hits);
      for (const std::uint32_t triangle : hits.triangle) wrong += triangle == 2 ? 1 : 0;
      rays_cast += RayPacket::width;
    }
  }
  EXPECT_EQ(wrong, 0U) << "of " << rays_cast;
}

// Two squares of 1 m, 5 mm apart: rays that leave one at more than 45 degrees from its normal, at
// least 1 cm from its edge, hit the other, with any objects 0.1 to 10 km away in any direction.
TEST(SurfaceOffset, AGapStaysOpenWhateverStandsFarAway) {
  std::mt19937 random(62);
  std::uniform_real_distribution<double> even(-0.49, 0.49);
  for (const double far_m : {10.0, 100.0, 2000.0, 10000.0}) {
    for (int n = 0; n < 8; ++n) {
      tests::SceneBuilder builder;
      const std::uint32_t grey = builder.material(tests::grey(0.5));
      builder.plate(grey, 1.0, 0.0, true);
      builder.plate(grey, 1.0, 0.005, false);
      const Vec3 low = far_m * unit(random);
      tests::add_box(builder, grey, low, low + Vec3(1.6));
      const RayQuery query(builder.scene);
      for (int k = 0; k < 256; ++k) {
        const Vec3 at(even(random), even(random), query.offset_m(0));
        Vec3 way = unit(random);
        way.z = std::abs(way.z) + 1.0;
        const Hit hit = query.closest(at, glm::normalize(way));
        ASSERT_FALSE(hit.missed());
        ASSERT_EQ(builder.scene.triangles[hit.triangle].object, 1U) << far_m;
        ASSERT_NEAR(hit_position(builder.scene, hit).z, 0.005, 1e-12);
      }
    }
  }
}

// A step of height h casts a shadow of h / tan(elevation). By bisection along the plane it agrees
// within 1 %, for h from 0.1 mm to 1 m on planes from 1 m to 20 km, and for a plane that extends 50
// km to one side only.
TEST(SurfaceOffset, AStepsShadowDoesNotDependOnThePlane) {
  const double elevation = base::radians(5.0);
  const Vec3 sun(std::cos(elevation), 0.0, std::sin(elevation));
  for (const double step_m : {1e-4, 1e-3, 1e-2, 1.0}) {
    for (const Vec3& reach : {Vec3(0.5, 0.5, 0), Vec3(50, 50, 0), Vec3(100, 100, 0),
                              Vec3(1e4, 1e4, 0), Vec3(5e4, 20.0, 0)}) {
      if (reach.x < 20.0 * step_m) continue;
      tests::SceneBuilder builder;
      const std::uint32_t grey = builder.material(tests::grey(0.5));
      builder.quad(grey, {-reach.y, -reach.y, 0}, {reach.x, -reach.y, 0}, {reach.x, reach.y, 0},
                   {-reach.y, reach.y, 0});
      tests::add_box(builder, grey, {0, -0.5, 0}, {0.5, 0.5, step_m});
      const RayQuery query(builder.scene);
      double dark = 0.0, lit = -30.0 * step_m;
      for (int k = 0; k < 40; ++k) {
        const double x = 0.5 * (dark + lit);
        // Straight down, like a camera.
        const Vec3 eye(x, 0.1, 1.0 + step_m);
        const Hit hit = query.closest(eye, {0, 0, -1});
        ASSERT_FALSE(hit.missed());
        const Vec3 at = hit_position(builder.scene, hit, eye, {0, 0, -1});
        ASSERT_NEAR(at.x, x, 1e-9);
        RayPacket rays;
        query.set(rays, 0, at + Vec3(0, 0, query.offset_m(hit.triangle)), sun);
        (query.occluded(rays, 1) != 0 ? dark : lit) = x;
      }
      EXPECT_NEAR(-0.5 * (dark + lit), step_m / std::tan(elevation),
                  0.01 * step_m / std::tan(elevation))
          << step_m << " on " << reach.x;
    }
  }
}

// From 10 m to 10 000 km camera rays hit the same triangles of a small scene, at the same points to
// 1e-6 of the distance between the origins.
TEST(SurfaceOffset, RaysFromFarAwayMeetWhatRaysFromNearDo) {
  tests::SceneBuilder builder;
  const std::uint32_t grey = builder.material(tests::grey(0.5));
  builder.plate(grey, 2.0, 0.0, true);
  tests::add_box(builder, grey, {-0.2, -0.2, 0.1}, {0.2, 0.2, 0.15});
  const RayQuery query(builder.scene);
  const Vec3 toward = glm::normalize(Vec3(0.1, -1.0, 1.0));
  for (const double away : {10.0, 1e3, 3e5, 1e7}) {
    RayPacket rays;
    HitPacket hits;
    for (int k = 0; k < 64; ++k) {
      // Parallel rays through points of the plate.
      const Vec3 aim(0.24 * (k % 8) - 0.83, 0.24 * (k / 8.0) - 0.91, 0.0);
      const Hit near = query.closest(aim + 5.0 * toward, -toward);
      const Vec3 eye = aim + away * toward;
      const Hit far = query.closest(eye, -toward);
      ASSERT_EQ(near.triangle, far.triangle) << away;
      const Vec3 at = hit_position(builder.scene, near, aim + 5.0 * toward, -toward),
                 seen = hit_position(builder.scene, far, eye, -toward);
      EXPECT_LT(glm::length(at - seen), 1e-8) << away;
      EXPECT_NEAR(far.t, glm::length(at - eye), 1e-6);
      query.set(rays, static_cast<std::size_t>(k % 8), eye, -toward);
      if (k % 8 < 7) continue;
      query.closest(rays, RayPacket::width, hits);
      EXPECT_EQ(hits.triangle[7], far.triangle);
    }
  }
}

// A warning names details below single precision: plates 5 mm apart, 100 km from the lamp that the
// camera looks at.
TEST(SurfaceOffset, GapsThatSinglePrecisionLosesAreNamed) {
  const auto text = [](double away_m) {
    return fmt::format(
        "format = 1\n[[material]]\nname = \"m\"\ndiffuse = 0.5\n"
        "[[object]]\nname = \"bay\"\nshape = \"box\"\nmin = [-1, -1, -1]\nmax = [1, 1, 1]\n"
        "material = \"m\"\n[[camera]]\nname = \"A\"\nposition = [0, -5, 0]\nlook_at = [0, 0, 0]\n"
        "[[object]]\nname = \"lo\"\nshape = \"quad\"\nmaterial = \"m\"\n"
        "corners = [[0, 0, {0}], [1, 0, {0}], [1, 1, {0}], [0, 1, {0}]]\n"
        "[[object]]\nname = \"hi\"\nshape = \"quad\"\nmaterial = \"m\"\n"
        "corners = [[0, 0, {1}], [0, 1, {1}], [1, 1, {1}], [1, 0, {1}]]\n",
        away_m, away_m + 0.005);
  };
  const auto named = [&](double away_m) {
    for (const std::string& warning : test::SceneFolder().read(text(away_m)).warnings) {
      if (warning.find("faces of \"lo\" and \"hi\" are 0.005 m apart") == 0) return true;
    }
    return false;
  };
  EXPECT_TRUE(named(1e4));
  EXPECT_FALSE(named(50.0));
}

}  // namespace
}  // namespace earthshine::scenes
