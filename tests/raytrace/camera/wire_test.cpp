// SPDX-License-Identifier: Apache-2.0
#include "raytrace/camera/wire.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "tests/support/boxes.h"

namespace earthshine::raytrace {
namespace {

scenes::Camera camera_at(const Vec3& position, const Vec3& look_at, double fov_deg = 40.0) {
  scenes::Camera camera;
  camera.position = position;
  camera.look_at = look_at;
  camera.fov_deg = fov_deg;
  if (look_at.x == position.x && look_at.y == position.y) camera.up = Vec3(0, 1, 0);
  return camera;
}

double length_of(const WireSegment& s) { return std::hypot(s.x1 - s.x0, s.y1 - s.y0); }

double total_length(const std::vector<WireSegment>& segments) {
  double sum = 0.0;
  for (const WireSegment& s : segments) sum += length_of(s);
  return sum;
}

std::vector<WireSegment> seen(const scenes::Scene& scene, const scenes::Camera& camera,
                              int edge_px = 200, double crease_deg = 30.0) {
  return visible_wire(feature_edges(scene, crease_deg), scenes::RayQuery(scene),
                      make_camera_model(camera, edge_px, edge_px));
}

// Joins all quads to one object, as in a box from a file.
void join(scenes::Scene& scene) {
  for (scenes::Triangle& t : scene.triangles) t.object = 0;
}

TEST(Wire, BoxHasTwelveEdgesAndNoDiagonals) {
  tests::SceneBuilder builder;
  tests::add_box(builder, builder.material(tests::grey(0.5)), Vec3(0), Vec3(1));
  join(builder.scene);
  EXPECT_EQ(feature_edges(builder.scene, 30.0).size(), 12U);
  // A right angle is a crease up to 90 degrees; above, a box has only silhouettes.
  const auto edges = feature_edges(builder.scene, 91.0);
  EXPECT_EQ(edges.size(), 12U);
  EXPECT_TRUE(std::all_of(edges.begin(), edges.end(),
                          [](const FeatureEdge& e) { return e.silhouette_only; }));
}

TEST(Wire, BordersAndChangesOfMaterialAreEdgesAndSeamsOfAFlatFaceAreNot) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5)),
                      n = builder.material(tests::grey(0.2));
  builder.quad(m, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  builder.quad(m, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0});
  join(builder.scene);
  EXPECT_EQ(feature_edges(builder.scene, 30.0).size(), 6U);
  for (std::size_t t : {2U, 3U}) builder.scene.triangles[t].material = n;
  EXPECT_EQ(feature_edges(builder.scene, 30.0).size(), 7U);
}

TEST(Wire, EdgesLieWhereTheCamerasOwnRaysMeetThem) {
  // Every end of every segment is a point of the picture whose ray passes within 1e-9 of a box
  // edge.
  tests::SceneBuilder builder;
  tests::add_box(builder, builder.material(tests::grey(0.5)), Vec3(0), Vec3(1));
  join(builder.scene);
  const scenes::Camera camera = camera_at({3, -4, 2.5}, {0.5, 0.5, 0.5});
  const CameraModel model = make_camera_model(camera, 200, 200);
  const auto edges = feature_edges(builder.scene, 30.0);
  const auto segments = seen(builder.scene, camera);
  for (const WireSegment& s : segments) {
    for (const auto& [x, y] : {std::pair{s.x0, s.y0}, {s.x1, s.y1}}) {
      const Ray ray = model.ray(x, y, 0.0, 0.0);
      double nearest = 1e9;
      for (const FeatureEdge& e : edges) {
        // Distance of two lines, by their common normal.
        const Vec3 across = glm::cross(ray.direction, glm::normalize(e.to - e.from));
        nearest = std::min(nearest,
                           std::fabs(glm::dot(e.from - ray.origin, across)) / glm::length(across));
      }
      EXPECT_LT(nearest, 1e-9);
    }
  }
}

TEST(Wire, BoxShowsTheNineEdgesOfItsThreeVisibleFaces) {
  tests::SceneBuilder builder;
  tests::add_box(builder, builder.material(tests::grey(0.5)), Vec3(0), Vec3(1));
  join(builder.scene);
  const scenes::Camera camera = camera_at({3, -4, 2.5}, {0.5, 0.5, 0.5});
  const CameraModel model = make_camera_model(camera, 200, 200);
  const auto pixel = [&](const Vec3& p) {
    const Vec3 d = p - model.position;
    const double z = glm::dot(d, model.forward) * model.projection.half_height;
    return glm::dvec2(glm::dot(d, model.right), -glm::dot(d, model.up)) * (100.0 / z);
  };
  // Faces x = 1, y = 0 and z = 1 are visible; the three edges at (0, 1, 0) are not.
  double expected = 0.0;
  for (const FeatureEdge& e : feature_edges(builder.scene, 30.0)) {
    const Vec3 hidden(0, 1, 0);
    if (e.from == hidden || e.to == hidden) continue;
    expected += glm::length(pixel(e.from) - pixel(e.to));
  }
  const auto segments = seen(builder.scene, camera);
  EXPECT_EQ(segments.size(), 9U);
  EXPECT_NEAR(total_length(segments), expected, 1.0);
}

TEST(Wire, LineIsCutWhereAPlateHidesIt) {
  // A plate at half the distance hides a segment of twice its size. The camera is at height 4 above
  // a square of side 2, f' = 100 / tan 20 deg = 274.7 px; the plate of side 0.4 at height 2 covers
  // the middle of the square's edge y = -1.
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.plate(m, 2.0, 0.0, true);
  const scenes::Scene alone = builder.scene;
  builder.quad(m, {-0.2, -0.7, 2}, {0.2, -0.7, 2}, {0.2, -0.3, 2}, {-0.2, -0.3, 2});
  const scenes::Camera camera = camera_at({0, 0, 4}, Vec3(0.0));
  const double focal_px = 100.0 / std::tan(base::radians(20.0));
  EXPECT_NEAR(total_length(seen(alone, camera)), 4.0 * 2.0 / 4.0 * focal_px, 1e-6);
  const auto segments = seen(builder.scene, camera);
  double of_square = 0.0, of_plate = 0.0;
  for (const WireSegment& s : segments) (s.object == 0 ? of_square : of_plate) += length_of(s);
  EXPECT_NEAR(of_plate, 4.0 * 0.4 / 2.0 * focal_px, 1e-6);
  EXPECT_NEAR(of_square, (4.0 * 2.0 - 0.8) / 4.0 * focal_px, 2.0 / 16.0 + 1e-6);
}

TEST(Wire, CylinderShowsItsTwoOutlinesAndNoFacets) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  constexpr int n = 48;
  const auto rim = [&](int k, double z) {
    const double a = 2.0 * base::pi * k / n;
    return Vec3(std::cos(a), std::sin(a), z);
  };
  for (int k = 0; k < n; ++k) {
    const int next = (k + 1) % n;
    builder.quad(m, rim(k, 0), rim(next, 0), rim(next, 3), rim(k, 3));
  }
  join(builder.scene);
  const auto segments = seen(builder.scene, camera_at({10, 0.3, 1.5}, {0, 0, 1.5}));
  int upright = 0;
  for (const WireSegment& s : segments) {
    if (std::fabs(s.x1 - s.x0) < 3.0 && length_of(s) > 50.0) ++upright;
  }
  EXPECT_EQ(upright, 2);
}

TEST(Wire, EdgesBehindAndBesideTheCameraAreLeftOut) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.plate(m, 2.0, 0.0, true);
  EXPECT_TRUE(seen(builder.scene, camera_at({0, 0, 4}, {0, 0, 8})).empty());
  EXPECT_TRUE(seen(builder.scene, camera_at({50, 0, 4}, {50, 0.001, 0})).empty());
  // Two sides extend behind the camera: clipped at the picture's border, without ends from behind.
  const auto segments = seen(builder.scene, camera_at({0, 0, 0.2}, {1, 0, 0.1}, 60.0));
  EXPECT_FALSE(segments.empty());
  for (const WireSegment& s : segments) {
    for (const double v : {s.x0, s.x1, s.y0, s.y1}) {
      EXPECT_GE(v, -1.0 - 1e-9);
      EXPECT_LE(v, 201.0 + 1e-9);
    }
  }
}

TEST(Wire, SameSegmentsOnOneAndTwoThreads) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  for (int k = 0; k < 30; ++k) {
    tests::add_box(builder, m, Vec3(k * 0.3, (k % 5) * 0.4, 0.0),
                   Vec3(k * 0.3 + 0.2, (k % 5) * 0.4 + 0.3, 0.5 + 0.1 * (k % 7)));
  }
  std::vector<std::vector<WireSegment>> runs;
  for (const int threads : {1, 2}) {
    const base::ThreadLimit limit(threads);
    runs.push_back(seen(builder.scene, camera_at({-3, -5, 4}, {4, 1, 0})));
  }
  ASSERT_EQ(runs[0].size(), runs[1].size());
  EXPECT_FALSE(runs[0].empty());
  for (std::size_t k = 0; k < runs[0].size(); ++k) {
    EXPECT_EQ(runs[0][k].x0, runs[1][k].x0);
    EXPECT_EQ(runs[0][k].y1, runs[1][k].y1);
  }
}

}  // namespace
}  // namespace earthshine::raytrace
