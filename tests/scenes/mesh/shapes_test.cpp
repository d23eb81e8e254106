// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh/shapes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "scenes/mesh/triangulate.h"

namespace earthshine::scenes {
namespace {

std::vector<Vec3> corners_of(const Mesh& mesh, const MeshPolygon& polygon) {
  std::vector<Vec3> corners;
  for (std::uint32_t k = 0; k < polygon.count; ++k) {
    corners.push_back(mesh.vertices[mesh.indices[polygon.first + k]]);
  }
  return corners;
}

double area_of(const Mesh& mesh) {
  double area = 0.0;
  for (const MeshPolygon& p : mesh.polygons) area += glm::length(vector_area(corners_of(mesh, p)));
  return area;
}

// Volume of a closed mesh, positive with fronts outward (divergence theorem); the vector areas of a
// closed surface sum to 0.
double volume_of(const Mesh& mesh) {
  double volume = 0.0;
  for (const MeshPolygon& p : mesh.polygons) {
    const auto c = corners_of(mesh, p);
    for (std::size_t i = 1; i + 1 < c.size(); ++i)
      volume += glm::dot(c[0], glm::cross(c[i], c[i + 1])) / 6.0;
  }
  return volume;
}

double gap_of(const Mesh& mesh) {
  Vec3 sum(0.0);
  for (const MeshPolygon& p : mesh.polygons) sum += vector_area(corners_of(mesh, p));
  return glm::length(sum);
}

TEST(Shapes, BoxHasTheAreaAndVolumeOfABox) {
  const Mesh box = make_box({-1, 0, 2}, {1, 3, 6});
  EXPECT_EQ(box.polygons.size(), 6U);
  EXPECT_NEAR(area_of(box), 2 * (2 * 3 + 3 * 4 + 2 * 4), 1e-12);
  EXPECT_NEAR(volume_of(box), 2 * 3 * 4, 1e-12);
  EXPECT_NEAR(gap_of(box), 0.0, 1e-12);
}

TEST(Shapes, SphereVerticesLieOnTheSphereAndItsAreaTendsToIt) {
  const Vec3 center(1, -2, 3);
  const double exact = 4 * base::pi * 0.8 * 0.8;
  double worse = 2.0;
  for (const int segments : {8, 32, 128}) {
    const Mesh sphere = make_sphere(center, 0.8, segments);
    for (const Vec3& v : sphere.vertices) EXPECT_NEAR(glm::length(v - center), 0.8, 1e-14);
    const double missing = 1.0 - area_of(sphere) / exact;
    EXPECT_GT(missing, 0.0);
    EXPECT_LT(missing, worse / 10.0);  // second order: a sixteenth at four times the segments
    EXPECT_GT(volume_of(sphere), 0.0);
    EXPECT_NEAR(gap_of(sphere), 0.0, 1e-12);
    worse = missing;
  }
}

TEST(Shapes, SphereOfFewestSegmentsIsClosed) {
  for (const int segments : {3, 4, 5}) {
    const Mesh sphere = make_sphere(Vec3(0.0), 1.0, segments);
    EXPECT_GT(volume_of(sphere), 0.0);
    EXPECT_NEAR(gap_of(sphere), 0.0, 1e-12);
  }
}

TEST(Shapes, CylinderHasTheAreaOfItsPrism) {
  const int n = 24;
  const double r = 0.5, h = 3.0;
  const double side = 2 * r * std::sin(base::pi / n);
  const double cap = 0.5 * n * r * r * std::sin(2 * base::pi / n);
  const Vec3 from(1, 1, 1);
  const Vec3 to = from + h * glm::normalize(Vec3(1, 2, -2));
  const Mesh closed = make_cylinder(from, to, r, n, true);
  EXPECT_NEAR(area_of(closed), n * side * h + 2 * cap, 1e-12);
  EXPECT_NEAR(volume_of(closed), cap * h, 1e-12);
  EXPECT_NEAR(gap_of(closed), 0.0, 1e-12);
  EXPECT_NEAR(area_of(make_cylinder(from, to, r, n, false)), n * side * h, 1e-12);
}

TEST(Shapes, DiskFacesAlongItsNormal) {
  const Vec3 normal = glm::normalize(Vec3(0.3, -0.5, -1.0));
  const Mesh disk = make_disk({5, 5, 5}, normal, 2.0, 16);
  Vec3 sum(0.0);
  for (const MeshPolygon& p : disk.polygons) sum += vector_area(corners_of(disk, p));
  EXPECT_NEAR(glm::dot(sum, normal), 0.5 * 16 * 4.0 * std::sin(2 * base::pi / 16), 1e-12);
  EXPECT_NEAR(glm::length(glm::cross(sum, normal)), 0.0, 1e-12);
}

TEST(Shapes, QuadIsCheckedForAreaFlatnessAndConvexity) {
  using Four = std::array<Vec3, 4>;
  EXPECT_EQ(check_quad(Four{Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(3, 1, 0), Vec3(0, 1, 0)}),
            QuadFault::None);
  EXPECT_EQ(check_quad(Four{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(3, 0, 0)}),
            QuadFault::NoArea);
  EXPECT_EQ(check_quad(Four{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0.01), Vec3(0, 1, 0)}),
            QuadFault::NotFlat);
  EXPECT_EQ(check_quad(Four{Vec3(0, 0, 0), Vec3(2, -2, 0), Vec3(0.5, 0, 0), Vec3(2, 2, 0)}),
            QuadFault::NotConvex);
  EXPECT_EQ(check_quad(Four{Vec3(0, 0, 0), Vec3(3, 3, 0), Vec3(3, 0, 0), Vec3(0, 1, 0)}),
            QuadFault::NotConvex);
}

}  // namespace
}  // namespace earthshine::scenes
