// SPDX-License-Identifier: Apache-2.0
// An instance equals its original written out with the instance's pose: in its triangles, and in
// the hits of rays. Rays use the original's ray structure with a transform
// (scenes/ray_structure.h).
#include <gtest/gtest.h>

#include "base/numbers/random.h"
#include "scenes/ray_query.h"
#include "tests/scenes/scene_text.h"

namespace earthshine::scenes {
namespace {

const std::string beginning =
    "format = 1\nunit = \"cm\"\n[[material]]\nname = \"a\"\ndiffuse = 0.5\n"
    "[[material]]\nname = \"b\"\ndiffuse = 0.2\ntwo_sided = true\n";
const std::string ball = "shape = \"sphere\"\ncenter = [1, 2, 3]\nradius = 20\nsegments = 12\n";
const std::string original =
    "[[object]]\nname = \"o\"\nmaterial = \"a\"\nscale = [2, 1, 1.5]\nrotate = [10, 20, 30]\n"
    "translate = [5, -7, 9]\n" +
    ball;
const std::vector<std::string> poses = {
    "translate = [100, 0, 0]\n", "scale = 2\nrotate = [0, 90, 45]\ntranslate = [-90, 50, 10]\n",
    "scale = [0.5, 1, 2]\ntranslate = [0, 0, 120]\nmaterial = \"b\"\n"};

// Each pose as an instance, or written out.
std::string text(bool instances) {
  std::string all = beginning + original;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    all += "[[object]]\nname = \"i" + std::to_string(k) + "\"\n" + poses[k];
    if (instances) {
      all += "instance_of = \"o\"\n";
    } else {
      all += (k < 2 ? "material = \"a\"\n" : "") + ball;
    }
  }
  return all;
}

TEST(Instance, IsItsOriginalWrittenOutWithItsOwnPose) {
  const test::SceneFolder folder;
  const Scene made = folder.read(text(true)), written = folder.read(text(false));
  ASSERT_EQ(made.triangles.size(), written.triangles.size());
  ASSERT_EQ(made.vertices.size(), written.vertices.size());
  for (std::size_t t = 0; t < made.triangles.size(); ++t) {
    const Triangle &a = made.triangles[t], &b = written.triangles[t];
    EXPECT_EQ(a.object, b.object);
    EXPECT_EQ(a.material, b.material);
    EXPECT_EQ(a.polygon, b.polygon);
    for (std::size_t k = 0; k < 3; ++k) {
      // Lengths of about a metre after three products: a few units of 1e-16.
      EXPECT_LT(glm::length(made.vertices[a.vertex[k]] - written.vertices[b.vertex[k]]), 1e-14);
    }
  }
  for (std::size_t o = 0; o < made.objects.size(); ++o) {
    EXPECT_EQ(made.objects[o].instance.has_value(), o > 0);
    EXPECT_EQ(made.objects[o].triangle_count, written.objects[o].triangle_count);
    EXPECT_EQ(made.objects[o].polygon_count, written.objects[o].polygon_count);
    EXPECT_NEAR(made.objects[o].area_m2 / written.objects[o].area_m2, 1.0, 1e-12);
    EXPECT_EQ(made.objects[o].surface.closed_parts, 1U);
  }
  EXPECT_EQ(made.warnings, written.warnings);
}

TEST(Instance, IsMetByTheSameRays) {
  const test::SceneFolder folder;
  const Scene made = folder.read(text(true)), written = folder.read(text(false));
  const RayQuery instanced(made), plain(written);
  base::Rng rng(base::Key(1, base::Stream::Test, 0));
  std::size_t met = 0, instances_met = 0, others = 0;
  for (int k = 0; k < 20000; ++k) {
    const Vec3 from(4.0 * rng.next() - 2.0, 4.0 * rng.next() - 2.0, 4.0 * rng.next() - 1.5);
    const Vec3 to(2.4 * rng.next() - 1.2, 1.2 * rng.next() - 0.4, 1.8 * rng.next() - 0.4);
    const Vec3 way = glm::normalize(to - from);
    const Hit a = instanced.closest(from, way), b = plain.closest(from, way);
    RayPacket packet;
    HitPacket hits;
    instanced.set(packet, 0, from, way);
    instanced.closest(packet, 1, hits);
    EXPECT_EQ(hits.triangle[0], a.triangle);
    EXPECT_EQ(instanced.occluded(packet, 1) != 0, !a.missed());
    if (a.triangle != b.triangle) {  // across an edge, by rounding
      ++others;
      continue;
    }
    if (a.missed()) continue;
    ++met;
    instances_met += made.triangles[a.triangle].object > 0 ? 1 : 0;
    EXPECT_EQ(a.front, b.front);
    EXPECT_EQ(hits.front[0] != 0, b.front);
    EXPECT_NEAR(a.t, b.t, 1e-4);  // for faces seen edge-on
    EXPECT_LT(glm::length(hit_position(made, a) - hit_position(written, b)), 1e-4);
  }
  EXPECT_GT(met, 5000U);
  EXPECT_GT(instances_met, 3000U);
  EXPECT_LT(others, 20U);
}

TEST(Instance, HasTheSidesOfItsOriginal) {
  const test::SceneFolder folder;
  Scene scene =
      folder.read(beginning +
                  "[[object]]\nname = \"o\"\nmaterial = \"a\"\nshape = \"quad\"\n"
                  "corners = [[-100, -100, 0], [100, -100, 0], [100, 100, 0], [-100, 100, 0]]\n"
                  "[[object]]\nname = \"i\"\ninstance_of = \"o\"\nrotate = [0, 0, 180]\n"
                  "translate = [0, 0, 100]\n");
  EXPECT_EQ(scene.objects[1].instance->object, 0U);
  const RayQuery query(scene);
  const Hit hit = query.closest({0.5, 0.2, 2.0}, {0, 0, -1});
  EXPECT_EQ(scene.triangles[hit.triangle].object, 1U);
  EXPECT_TRUE(hit.front);
  EXPECT_FALSE(query.closest({0.5, 0.2, 0.5}, {0, 0, 1}).front);
}

TEST(Instance, SaysWhatIsWrong) {
  const test::SceneFolder folder;
  const std::string instance = "[[object]]\nname = \"i\"\ninstance_of = \"o\"\n";
  const auto refused = [&](const std::string& more) {
    return folder.refusal(beginning + original + more);
  };
  EXPECT_TRUE(test::holds(refused("[[object]]\nname = \"i\"\ninstance_of = \"p\"\n"),
                          {"scene.toml:22:1", "is \"p\"", "an [[object]] with a mesh or a shape"}));
  EXPECT_TRUE(test::holds(refused(instance + "[[object]]\nname = \"j\"\ninstance_of = \"i\"\n"),
                          {"is \"i\"", "an [[object]] with a mesh"}));
  EXPECT_TRUE(test::holds(refused(instance + "mesh = \"x.obj\"\n"),
                          {"unknown key \"mesh\"", "instance_of"}));
  EXPECT_TRUE(test::holds(refused(instance + "scale = [2, 1, 1.5]\nrotate = [10, 20, 30]\n"
                                             "translate = [5, -7, 9]\n"),
                          {"exactly where \"o\" stands", "a surface is in the scene once"}));
  EXPECT_TRUE(test::holds(refused(instance + "[[object]]\nname = \"j\"\ninstance_of = \"o\"\n"),
                          {"exactly where \"i\" stands"}));
  EXPECT_TRUE(test::holds(refused(instance + "material = \"c\"\n"), {"\"c\""}));
  EXPECT_TRUE(test::holds(refused("[[object]]\nname = \"o\"\ninstance_of = \"o\"\n"), {"\"o\""}));
  EXPECT_TRUE(test::holds(refused(instance + "translate = [1e13, 0, 0]\n"), {"translate"}));
}

}  // namespace
}  // namespace earthshine::scenes
