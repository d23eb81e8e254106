// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh/triangulate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace earthshine::scenes {
namespace {

double area_of(const std::vector<Vec3>& corners, const std::array<std::uint32_t, 3>& t) {
  return 0.5 *
         glm::length(glm::cross(corners[t[1]] - corners[t[0]], corners[t[2]] - corners[t[0]]));
}

Triangulation divide(const std::vector<Vec3>& corners, double smallest_area = 1e-12) {
  Triangulation result;
  triangulate(corners, smallest_area, result);
  return result;
}

double total_area(const std::vector<Vec3>& corners, const Triangulation& pieces) {
  return std::accumulate(pieces.triangles.begin(), pieces.triangles.end(), 0.0,
                         [&](double sum, const auto& t) { return sum + area_of(corners, t); });
}

// All triangles have the polygon's winding.
bool one_sense(const std::vector<Vec3>& corners, const Triangulation& pieces) {
  const Vec3 normal = vector_area(corners);
  return std::all_of(pieces.triangles.begin(), pieces.triangles.end(), [&](const auto& t) {
    return glm::dot(glm::cross(corners[t[1]] - corners[t[0]], corners[t[2]] - corners[t[0]]),
                    normal) > 0.0;
  });
}

// A star with n points, in an oblique plane.
std::vector<Vec3> star(int n, double inner, double outer) {
  const base::Frame3 frame = base::frame_around(glm::normalize(Vec3(1.0, -2.0, 0.5)));
  std::vector<Vec3> corners;
  for (int i = 0; i < 2 * n; ++i) {
    const double angle = base::pi * i / n;
    const double r = i % 2 == 0 ? outer : inner;
    corners.push_back(Vec3(3.0, 1.0, 2.0) +
                      frame.to_world({r * std::cos(angle), r * std::sin(angle), 0.0}));
  }
  return corners;
}

TEST(Triangulate, ParallelogramIsDividedAlongItsFirstDiagonal) {
  const std::vector<Vec3> corners{{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {1, 1, 0}};
  const auto pieces = divide(corners);
  ASSERT_EQ(pieces.kind, PolygonKind::Sound);
  ASSERT_EQ(pieces.triangles.size(), 2U);
  EXPECT_EQ(pieces.triangles[0], (std::array<std::uint32_t, 3>{0, 1, 2}));
  EXPECT_EQ(pieces.triangles[1], (std::array<std::uint32_t, 3>{0, 2, 3}));
  EXPECT_DOUBLE_EQ(pieces.area, 2.0);
}

TEST(Triangulate, ConcaveQuadIsDividedAtItsInnerCorner) {
  for (std::size_t turn = 0; turn < 4; ++turn) {
    std::vector<Vec3> corners{{0, 0, 0}, {2, -2, 0}, {0.5, 0, 0}, {2, 2, 0}};
    std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(turn),
                corners.end());
    const auto pieces = divide(corners);
    EXPECT_EQ(pieces.kind, PolygonKind::Sound);
    EXPECT_NEAR(total_area(corners, pieces), pieces.area, 1e-15);
    EXPECT_TRUE(one_sense(corners, pieces));
  }
}

// A polygon whose area the usual library multiplies by 7.4: 33 narrow teeth.
TEST(Triangulate, Concave66GonKeepsItsArea) {
  const auto corners = star(33, 0.05, 1.0);
  const double exact = 33 * 0.05 * 1.0 * std::sin(base::pi / 33);  // n r R sin(pi/n)
  const auto pieces = divide(corners);
  ASSERT_EQ(pieces.kind, PolygonKind::Sound);
  EXPECT_EQ(pieces.triangles.size(), 64U);
  EXPECT_NEAR(pieces.area, exact, 1e-14);
  EXPECT_NEAR(total_area(corners, pieces), exact, 1e-14);
  EXPECT_TRUE(one_sense(corners, pieces));
}

TEST(Triangulate, LargestPolygonKeepsItsAreaAndIsDividedAtOnce) {
  const auto corners = star(512, 0.3, 1.0);
  const auto pieces = divide(corners, 1e-15);
  ASSERT_EQ(pieces.kind, PolygonKind::Sound);
  EXPECT_EQ(pieces.triangles.size(), 1022U);
  EXPECT_NEAR(total_area(corners, pieces) / pieces.area, 1.0, 1e-12);
}

TEST(Triangulate, StraightCornersKeepTheirPlaceInTheOutline) {
  // Five corners on each side: a careless choice would end in triangles without area and leave
  // gaps.
  std::vector<Vec3> corners;
  for (int side = 0; side < 4; ++side) {
    const Vec3 from[] = {{0, 0, 0}, {5, 0, 0}, {5, 5, 0}, {0, 5, 0}};
    const Vec3 along[] = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
    for (int k = 0; k < 5; ++k) corners.push_back(from[side] + double(k) * along[side]);
  }
  const auto pieces = divide(corners);
  ASSERT_EQ(pieces.kind, PolygonKind::Sound);
  EXPECT_EQ(pieces.triangles.size(), 18U);
  EXPECT_NEAR(total_area(corners, pieces), 25.0, 1e-12);
  EXPECT_TRUE(one_sense(corners, pieces));
}

TEST(Triangulate, HoleReachedByABridgeIsNotCovered) {
  const std::vector<Vec3> corners{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0},
                                  {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}};
  const auto pieces = divide(corners);
  ASSERT_EQ(pieces.kind, PolygonKind::Sound);
  EXPECT_NEAR(total_area(corners, pieces), 12.0, 1e-12);
}

TEST(Triangulate, RepeatedCornersInARowCountOnce) {
  const std::vector<Vec3> corners{{0, 0, 0}, {0, 0, 0}, {2, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 0}};
  const auto pieces = divide(corners);
  ASSERT_EQ(pieces.kind, PolygonKind::Sound);
  EXPECT_EQ(pieces.triangles.size(), 1U);
  EXPECT_NEAR(total_area(corners, pieces), 2.0, 1e-15);
}

TEST(Triangulate, PolygonsWithoutAreaAreDegenerate) {
  EXPECT_EQ(divide({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}).kind, PolygonKind::Degenerate);
  EXPECT_EQ(divide({{0, 0, 0}, {1, 0, 0}, {1, 0, 0}}).kind, PolygonKind::Degenerate);
  EXPECT_EQ(divide({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}).kind, PolygonKind::Degenerate);
  EXPECT_EQ(divide({{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}}).kind, PolygonKind::Degenerate);
  EXPECT_EQ(divide({{0, 0, 0}, {1e-7, 0, 0}, {0, 1e-7, 0}}).kind, PolygonKind::Degenerate);
}

TEST(Triangulate, OutlinesThatCrossThemselvesAreFound) {
  EXPECT_EQ(divide({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}).kind, PolygonKind::Crossing);
  EXPECT_EQ(divide({{0, 0, 0}, {3, 3, 0}, {3, 0, 0}, {0, 1, 0}}).kind, PolygonKind::Crossing);
  std::vector<Vec3> pentagram;
  for (int i = 0; i < 5; ++i) {
    pentagram.emplace_back(std::cos(0.8 * base::pi * i), std::sin(0.8 * base::pi * i), 0.0);
  }
  EXPECT_EQ(divide(pentagram).kind, PolygonKind::Crossing);
}

TEST(Triangulate, SlightlyWarpedQuadIsSoundAndSaysHowMuch) {
  const std::vector<Vec3> corners{{0, 0, 0}, {1, 0, 0}, {1, 1, 0.02}, {0, 1, 0}};
  const auto pieces = divide(corners);
  ASSERT_EQ(pieces.kind, PolygonKind::Sound);
  EXPECT_NEAR(pieces.triangle_area, total_area(corners, pieces), 1e-15);
  EXPECT_GT(pieces.triangle_area, pieces.area);
  EXPECT_LT(pieces.triangle_area, pieces.area * 1.001);
}

}  // namespace
}  // namespace earthshine::scenes
