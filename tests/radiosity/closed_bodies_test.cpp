// SPDX-License-Identifier: Apache-2.0
#include "radiosity/closed_bodies.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "base/random.h"
#include "radiosity/covered_patches.h"
#include "scenes/shapes.h"
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
  // A ball of n segments lies between the balls of radius 1 and cos(pi / n)^2: the polygons'
  // vertices lie on the round surface, their middles within that.
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
  // Seen along an axis through the poles and along seams of its polygons.
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
  builder.scene.lamps.back().position = Vec3(0.5, 0.5, -2.0);  // a second world, lit too
  EXPECT_FALSE(covered(builder.scene, {0.5, 0.5, -1e-6}));
  builder.scene.lamps.back().position = Vec3(0.5);
  builder.quad(builder.material(grey(0.5, 1.0)), {4, 0, 0}, {5, 0, 0}, {5, 1, 0}, {4, 1, 0});
  EXPECT_FALSE(covered(builder.scene, {0.5, 0.5, -1e-6}));  // lit by what shines out there
}

TEST(ClosedBodies, ABoxInTheCornerOfARoomIsABodyOfItsOwn) {
  // It shares an edge of the room and the corner's point with it.
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
  EXPECT_TRUE(covered(builder.scene, {0.3, 0.3, 0.1}));     // in the box that stands in the room
  EXPECT_FALSE(covered(builder.scene, {0.5, 0.5, -0.15}));  // outside
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
  EXPECT_FALSE(covers([](tests::SceneBuilder& b) {  // one face turned over
    for (std::size_t t : {10, 11}) {
      std::swap(b.scene.triangles[t].vertex[1], b.scene.triangles[t].vertex[2]);
    }
  }));
  EXPECT_FALSE(covers([](tests::SceneBuilder& b) { b.scene.vertices[0] += Vec3(1e-3); }));
  EXPECT_FALSE(covers([](tests::SceneBuilder& b) {  // somebody lives there
    scenes::Lamp lamp;
    lamp.position = Vec3(0.5);
    b.scene.lamps.push_back(lamp);
  }));
}

FormFactors open_factors(const scenes::Scene& scene, const scenes::RayQuery& query,
                         const Patches& patches, int rays = 1024) {
  FormFactorOptions options;
  options.rays_per_patch = rays;
  options.leave_out_covered = true;
  return cast_form_factors(scene, query, patches, options);
}

TEST(CoveredParts, TheShareLeftOpenIsTheAreaThatTheBoxLeaves) {
  // A floor of one patch, 1 m2, and a box over 0.3 x 0.4 m of it, standing and sunk. 1024 points,
  // binomial at most: 4 sqrt(0.12 * 0.88 / 1024).
  for (const double low : {0.0, -0.2}) {
    tests::SceneBuilder builder;
    const std::uint32_t m = builder.material(grey(0.5));
    builder.quad(m, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    tests::add_box(builder, m, {0.2, 0.5, low}, {0.5, 0.9, 0.3});
    const scenes::RayQuery query(builder.scene);
    const Patches patches = subdivide(builder.scene, 10.0);
    const FormFactors f = open_factors(builder.scene, query, patches);
    ASSERT_EQ(f.open.share.size(), 7U);
    EXPECT_NEAR(f.open.share[0], 0.88, 4.0 * std::sqrt(0.12 * 0.88 / 1024)) << low;
    EXPECT_EQ(f.black[0], 0.0);
    for (std::size_t face = 1; face < 7; ++face) EXPECT_EQ(f.open.share[face], 1.0) << face;
    EXPECT_NEAR(open_areas(f.open, patches.area_m2)[0], f.open.share[0], 1e-12);
  }
}

TEST(CoveredParts, NothingIsLookedForWhereNoRayMeetsABack) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(grey(0.5));
  builder.room({m, m, m, m, m, m});
  tests::add_box(builder, m, Vec3(0.4), Vec3(0.6));
  const scenes::RayQuery query(builder.scene);
  const Patches patches = subdivide(builder.scene, 0.5);
  const FormFactors f = open_factors(builder.scene, query, patches),
                    as_cast = cast_form_factors(builder.scene, query, patches, {1024, 1});
  EXPECT_TRUE(f.open.share.empty());
  EXPECT_EQ(f.open.bodies, nullptr);
  EXPECT_EQ(f.hits, as_cast.hits);
  EXPECT_EQ(f.column, as_cast.column);
  EXPECT_EQ(f.row_scale, as_cast.row_scale);
}

TEST(CoveredParts, AWhollyCoveredPatchHasNoRowAndNoColumn) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(grey(0.5));
  builder.quad(m, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  tests::add_box(builder, m, {0.25, 0.25, -0.1}, {0.75, 0.75, 0.3});
  const scenes::RayQuery query(builder.scene);
  const Patches patches = subdivide(builder.scene, 0.125);
  const FormFactors f = open_factors(builder.scene, query, patches);
  double closed_m2 = 0.0;
  for (std::uint32_t i = 0; i < f.count(); ++i) {
    double sum = f.sky[i] + f.black[i];
    for (std::uint64_t e = f.row_start[i]; e < f.row_start[i + 1]; ++e) {
      sum += f.row_scale[i] * double(f.hits[e]);
      if (f.open.share[f.column[e]] == 0.0) {
        EXPECT_EQ(f.hits[e], 0.0F);
      }
    }
    EXPECT_NEAR(sum, 1.0, 1e-14);
    if (f.open.share[i] > 0.0) continue;
    closed_m2 += patches.area_m2[i];
    EXPECT_EQ(f.row_start[i], f.row_start[i + 1]);
    EXPECT_EQ(f.lost[i], 1.0);
  }
  EXPECT_NEAR(closed_m2, 0.25, 1e-12);  // cells of 1/8 m end where the box does
}

TEST(CoveredParts, AHitOnAPatchThatTakesNoPartIsLostAndTheRowStaysClosed) {
  // A room of six patches, of which the last is said to be covered: 0.2 of what each other sends
  // goes to black backs instead.
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(grey(0.5));
  builder.room({m, m, m, m, m, m});
  const scenes::RayQuery query(builder.scene);
  FormFactors f = cast_form_factors(builder.scene, query, subdivide(builder.scene, 1.0), {1024, 1});
  f.open.share = {1, 1, 1, 1, 1, 0};
  lose_hits_on_covered(f);
  for (std::uint32_t i = 0; i < 5; ++i) {
    double sum = f.black[i];
    for (std::uint64_t e = f.row_start[i]; e < f.row_start[i + 1]; ++e) {
      sum += f.row_scale[i] * double(f.hits[e]);
    }
    EXPECT_NEAR(sum, 1.0, 1e-14);
    EXPECT_NEAR(f.black[i], 0.2, 4.0 * std::sqrt(0.16 / 1024));
    EXPECT_EQ(f.lost[i], f.black[i]);
  }
}

// The floor [0,1]^2 under a Sun overhead, a box of 0.3 x 0.4 m sunk in it.
Solution sunlit_floor(double edge_m) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(grey(0.5));
  builder.quad(m, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  tests::add_box(builder, m, {0.2, 0.5, -0.1}, {0.5, 0.9, 0.3});
  scenes::Sun sun;
  sun.illuminance_lx = Rgb(1000.0);
  sun.angular_radius_deg = 0.0;
  builder.scene.sun = sun;
  SolveOptions options;
  options.patch_edge_m = edge_m;
  return tests::Prepared(builder.scene).solve(options);
}

TEST(CoveredParts, DirectLightIsTheMeanOverWhatIsOpen) {
  // No shadow falls beside the box: the floor has 1000 lx wherever it is open, in whatever patches,
  // and all that falls on 1 m2 lands once, but for the noise of the share.
  for (const double edge_m : {2.0, 0.2, 0.07}) {
    const Solution s = sunlit_floor(edge_m);
    EXPECT_NEAR(s.report.groups[0].landed_lm.g, 1000.0, 4e3 * std::sqrt(0.12 * 0.88 / 1024));
    EXPECT_NEAR(s.report.objects[0].area_m2, 1.0, 1e-12);
    EXPECT_LE(s.report.groups[0].imbalance, 1e-12);
    for (std::uint32_t i = 0; i < s.patches.count(); ++i) {
      if (s.patches.object(i) != 0) continue;
      const Rectangle r = s.patches.rectangle(i);
      const bool inner = r.s0 > 0.2 && r.s1 < 0.5 && r.t0 > 0.5 && r.t1 < 0.9;
      if (!inner) {
        EXPECT_NEAR(s.direct_lx[3 * i], 1000.0, 1e-3) << r.s0 << " " << r.t0;
      }
    }
  }
}

TEST(CoveredParts, ACoveredPatchShowsItsOpenNeighboursAndNoLightWhereThereAreNone) {
  // Cells of 1/16 m: the box covers four by six of them and more, so that some have open neighbours
  // and some have none.
  const Solution s = sunlit_floor(0.0625);
  int shown = 0, dark = 0;
  for (std::uint32_t i = 0; i < s.patches.count(); ++i) {
    if (s.patches.object(i) != 0) continue;
    const Rectangle r = s.patches.rectangle(i);
    const double beyond = std::min({r.s0 - 0.2, 0.5 - r.s1, r.t0 - 0.5, 0.9 - r.t1});
    if (beyond < 1e-9) continue;
    const bool has_neighbour = beyond < 0.0625 - 1e-9;
    (has_neighbour ? shown : dark) += 1;
    if (has_neighbour) {
      EXPECT_NEAR(s.direct_lx[3 * i], 1000.0, 1e-3);
    } else {
      EXPECT_EQ(s.direct_lx[3 * i], 0.0F);
    }
    EXPECT_NEAR(s.radiosity[3 * i], 0.5 * (s.direct_lx[3 * i] + s.indirect_lx[3 * i]), 1e-3);
  }
  EXPECT_GT(shown, 0);
  EXPECT_GT(dark, 0);
}

}  // namespace
}  // namespace earthshine::radiosity
