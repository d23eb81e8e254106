// SPDX-License-Identifier: Apache-2.0
#include "radiosity/bodies/closed_bodies.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/numbers/random.h"
#include "scenes/mesh/shapes.h"
#include "tests/support/boxes.h"

namespace earthshine::radiosity {
namespace {

using tests::grey;

// Appends a mesh as one object.
void add_mesh(tests::SceneBuilder& builder, std::uint32_t material, const scenes::Mesh& mesh) {
  const auto object = static_cast<std::uint32_t>(builder.scene.objects.size());
  scenes::Object record;
  record.name = "mesh-" + std::to_string(object);
  builder.scene.objects.push_back(record);
  const auto first = static_cast<std::uint32_t>(builder.scene.vertices.size());
  builder.scene.vertices.insert(builder.scene.vertices.end(), mesh.vertices.begin(),
                                mesh.vertices.end());
  for (const scenes::MeshPolygon& polygon : mesh.polygons) {
    const std::uint32_t* corner = &mesh.indices[polygon.first];
    for (std::uint32_t k = 1; k + 1 < polygon.count; ++k) {
      builder.scene.triangles.push_back(
          {{first + corner[0], first + corner[k], first + corner[k + 1]},
           object,
           material,
           object});
    }
  }
}

// Whether any body of the scene covers the point. A patch as large as the scene is near all of
// them.
bool covered(const scenes::Scene& scene, const Vec3& point) {
  const ClosedBodies bodies(scene, Vec3(0.0));
  tests::SceneBuilder all;
  const std::uint32_t m = all.material(grey(0.5));
  all.quad(m, {-9, -9, -9}, {9, -9, -9}, {9, 9, 9}, {-9, 9, 9});
  return bodies.cover(point, bodies.near(subdivide(all.scene, 99.0), 0, 1e-6));
}

TEST(ClosedBodies, ABallCoversWhatItsPolygonsEnclose) {
  // A ball of n segments lies between the balls of radius 1 and cos(pi / n)^2: the vertices are on
  // the sphere, the middles of the polygons inside.
  tests::SceneBuilder builder;
  constexpr int segments = 24;
  add_mesh(builder, builder.material(grey(0.5)), scenes::make_sphere({1, 2, 3}, 1.0, segments));
  const double inner = std::pow(std::cos(base::pi / segments), 2);
  const base::Key key(1, base::Stream::FormFactor, 7);
  int in = 0;
  for (std::uint32_t k = 0; k < 400; ++k) {
    const Vec3 p(2.0 * base::uniform(key, 3 * k), 1.0 + 2.0 * base::uniform(key, 3 * k + 1),
                 2.0 + 2.0 * base::uniform(key, 3 * k + 2));
    const double r = glm::length(p - Vec3(1, 2, 3));
    if (r > inner && r <= 1.0) continue;
    EXPECT_EQ(covered(builder.scene, p), r < 1.0) << r;
    in += r < inner ? 1 : 0;
  }
  EXPECT_GT(in, 100);
  // Projected along an axis through the poles and along edges of its polygons.
  EXPECT_TRUE(covered(builder.scene, {1, 2, 3}));
  EXPECT_TRUE(covered(builder.scene, {1, 2, 3.5}));
  EXPECT_TRUE(covered(builder.scene, {1.5, 2, 3}));
  EXPECT_FALSE(covered(builder.scene, {1, 2, 4.5}));
  EXPECT_FALSE(covered(builder.scene, {2.5, 2, 3}));
}

TEST(ClosedBodies, ABoxOfSixObjectsIsOneBody) {
  tests::SceneBuilder builder;
  tests::add_box(builder, builder.material(grey(0.5)), {0, 0, 0}, {1, 2, 3});
  EXPECT_TRUE(covered(builder.scene, {0.5, 1, 1.5}));
  EXPECT_TRUE(covered(builder.scene, {1e-9, 1e-9, 1e-9}));
  EXPECT_FALSE(covered(builder.scene, {-1e-9, 1, 1}));
  EXPECT_FALSE(covered(builder.scene, {0.5, 1, 3 + 1e-9}));
}

TEST(ClosedBodies, ARoomCoversNothingWhereverItIsSeenFrom) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(grey(0.5));
  builder.room({m, m, m, m, m, m});
  scenes::Sun sun;
  builder.scene.sun = sun;
  for (const Vec3& p : {Vec3(0.5), Vec3(0.5, 0.5, -1), Vec3(0.5, 0.5, -1e-6), Vec3(2.0)}) {
    EXPECT_FALSE(covered(builder.scene, p));
  }
}

TEST(ClosedBodies, WhatIsOutsideARoomIsCoveredWhereAllLightIsInRooms) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(grey(0.5));
  builder.room({m, m, m, m, m, m});
  scenes::Lamp lamp;
  lamp.position = Vec3(0.5);
  builder.scene.lamps.push_back(lamp);
  EXPECT_FALSE(covered(builder.scene, Vec3(0.25)));
  EXPECT_TRUE(covered(builder.scene, {0.5, 0.5, -1e-6}));
  builder.scene.lamps.back().position = Vec3(0.5, 0.5, -2.0);  // a second lit region
  EXPECT_FALSE(covered(builder.scene, {0.5, 0.5, -1e-6}));
  builder.scene.lamps.back().position = Vec3(0.5);
  builder.quad(builder.material(grey(0.5, 1.0)), {4, 0, 0}, {5, 0, 0}, {5, 1, 0}, {4, 1, 0});
  EXPECT_FALSE(covered(builder.scene, {0.5, 0.5, -1e-6}));  // lit from outside
}

TEST(ClosedBodies, ABoxInTheCornerOfARoomIsABodyOfItsOwn) {
  // It shares an edge with the room, and the vertex at the point.
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(grey(0.5));
  builder.room({m, m, m, m, m, m});
  builder.scene.sun = scenes::Sun();
  add_mesh(builder, m, scenes::make_box({0, 0, 0}, {0.25, 1.0, 0.25}));
  EXPECT_TRUE(covered(builder.scene, {0.1, 0.1, 1e-6}));
  EXPECT_FALSE(covered(builder.scene, {0.5, 0.1, 1e-6}));
}

TEST(ClosedBodies, ARoomWithinAShellIsOpenAndItsWallsAreNot) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(grey(0.5));
  builder.room({m, m, m, m, m, m});
  builder.scene.sun = scenes::Sun();
  add_mesh(builder, m, scenes::make_box({-0.1, -0.1, -0.1}, {1.1, 1.1, 1.1}));
  add_mesh(builder, m, scenes::make_box({0.2, 0.2, -0.05}, {0.4, 0.4, 0.3}));
  EXPECT_FALSE(covered(builder.scene, Vec3(0.5)));
  EXPECT_TRUE(covered(builder.scene, {0.5, 0.5, -0.05}));   // within the wall
  EXPECT_TRUE(covered(builder.scene, {0.3, 0.3, 0.1}));     // in the box inside the room
  EXPECT_FALSE(covered(builder.scene, {0.5, 0.5, -0.15}));  // outside
}

TEST(ClosedBodies, ABlockWithoutABottomIsStoppedUpByTheFloorThatItStandsOn) {
  // A floor of two quads that meet under the block, and a prism of walls and a roof on it.
  const auto covers = [](double lift, double floor_to, bool sheet) {
    tests::SceneBuilder builder;
    const std::uint32_t m = builder.material(grey(0.5));
    scenes::Material paper = grey(0.5);
    paper.two_sided = sheet;
    const std::uint32_t ground = builder.material(paper);
    builder.quad(ground, {0, 0, 0}, {2, 0, 0}, {2, 4, 0}, {0, 4, 0});
    builder.quad(ground, {2, 0, 0}, {floor_to, 0, 0}, {floor_to, 4, 0}, {2, 4, 0});
    const Vec3 up(0, 0, lift), high(0, 0, lift + 1.0);
    const Vec3 corner[] = {{2, 1, 0}, {3, 2, 0}, {2, 3, 0}, {1, 2, 0}};
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec3 from = corner[k], to = corner[(k + 1) % 4];
      builder.quad(m, from + up, to + up, to + high, from + high);
    }
    builder.quad(m, corner[0] + high, corner[1] + high, corner[2] + high, corner[3] + high);
    return covered(builder.scene, {2.0, 2.0, 0.5}) && covered(builder.scene, {2.0, 2.0, 1e-9}) &&
           !covered(builder.scene, {2.9, 2.9, 1e-9}) && !covered(builder.scene, {2.0, 2.0, 1.1});
  };
  EXPECT_TRUE(covers(0.0, 4.0, false));
  EXPECT_FALSE(covers(1e-3, 4.0, false));  // light enters through the gap
  EXPECT_FALSE(covers(0.0, 2.5, false));   // its corner extends beyond the edge
  EXPECT_FALSE(covers(0.0, 4.0, true));    // the other side of a sheet is no floor
}

TEST(ClosedBodies, OnlyOpaqueClosedConsistentSurfacesCover) {
  const auto covers = [](auto change) {
    tests::SceneBuilder builder;
    const std::uint32_t m = builder.material(grey(0.5));
    tests::add_box(builder, m, {0, 0, 0}, {1, 1, 1});
    change(builder);
    return covered(builder.scene, {0.4, 0.5, 0.6});
  };
  EXPECT_TRUE(covers([](tests::SceneBuilder&) {}));
  EXPECT_FALSE(covers([](tests::SceneBuilder& b) { b.scene.materials[0].two_sided = true; }));
  EXPECT_FALSE(covers([](tests::SceneBuilder& b) { b.scene.materials[0].transmit = Rgb(0.5); }));
  EXPECT_FALSE(covers([](tests::SceneBuilder& b) { b.scene.triangles.pop_back(); }));
  EXPECT_FALSE(covers([](tests::SceneBuilder& b) {  // one reversed face
    for (std::size_t t : {10, 11}) {
      std::swap(b.scene.triangles[t].vertex[1], b.scene.triangles[t].vertex[2]);
    }
  }));
  EXPECT_FALSE(covers([](tests::SceneBuilder& b) { b.scene.vertices[0] += Vec3(1e-3); }));
  EXPECT_FALSE(covers([](tests::SceneBuilder& b) {  // a lamp inside
    scenes::Lamp lamp;
    lamp.position = Vec3(0.5);
    b.scene.lamps.push_back(lamp);
  }));
}

}  // namespace
}  // namespace earthshine::radiosity
