// SPDX-License-Identifier: Apache-2.0
#include "radiosity/factors/patch_rays.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "radiosity/factors/hit_targets.h"
#include "tests/support/scene_builder.h"

namespace earthshine::radiosity {
namespace {

using scenes::RayPacket;

// A plate, a sliver triangle and a sheet, far from the origin.
scenes::Scene some_surfaces() {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  scenes::Material sheet = tests::grey(0.5);
  sheet.two_sided = true;
  const std::uint32_t thin = builder.material(sheet);
  builder.quad(m, {0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0});
  builder.quad(m, {0, 0, 2}, {0, 1, 2}, {3, 0.2, 2.5}, {3, 0, 2.5});  // not a parallelogram
  builder.quad(thin, {5, 0, 0}, {5, 1, 0}, {5, 1, 1}, {5, 0, 1});
  // The same triangle with its apex, opposite the shortest edge, as first, second and third vertex.
  const auto v = static_cast<std::uint32_t>(builder.scene.vertices.size());
  builder.scene.vertices.insert(builder.scene.vertices.end(), {{8, 0, 0}, {8, 2, 0}, {8, 2, 0.7}});
  for (std::uint32_t turn = 0; turn < 3; ++turn) {
    builder.scene.triangles.push_back(
        {{v + turn, v + (turn + 1) % 3, v + (turn + 2) % 3}, 0, m, 100 + turn});
  }
  for (Vec3& p : builder.scene.vertices) p += Vec3(300, -200, 100);
  return builder.scene;
}

TEST(PatchRays, LeaveFromTheirPatchCosineDistributedAboutItsNormal) {
  const scenes::Scene scene = some_surfaces();
  const scenes::RayQuery query(scene);
  const Patches patches = subdivide(scene, 0.4);
  constexpr std::uint32_t count = 1024;
  const PatchRays rays(patches, query, count);
  for (std::uint32_t i = 0; i < patches.count(); ++i) {
    const auto sender = rays.sender(i, base::Key(1, base::Stream::Test, i));
    const Vec3 normal = patches.normal(i);
    double cosine = 0.0, cosine2 = 0.0;
    Vec3 centre(0.0), side(0.0);
    RayPacket packet;
    for (std::uint32_t first = 0; first < count; first += RayPacket::width) {
      rays.make(sender, first, packet);
      for (std::size_t k = 0; k < RayPacket::width; ++k) {
        const Vec3 way(packet.direction_x[k], packet.direction_y[k], packet.direction_z[k]);
        ASSERT_NEAR(glm::length(way), 1.0, 2e-6);
        const double c = glm::dot(way, normal);
        ASSERT_GT(c, 0.0);
        cosine += c / count;
        cosine2 += c * c / count;
        side += way / double(count);
        const Vec3 from = query.centre() +
                          Vec3(packet.origin_x[k], packet.origin_y[k], packet.origin_z[k]) -
                          normal * query.offset_m(0);
        centre += from / double(count);
        const Facet& facet = patches.facets[patches.facet[i]];
        ASSERT_NEAR(glm::dot(from - facet.corner, normal), 0.0, 2e-6);
      }
    }
    // For a cosine distribution E cos = 2/3 and E cos^2 = 1/2, with variances 1/18 and 1/12; the
    // mean tangential component has variance 1/4 per axis. Four standard errors of independent
    // samples.
    EXPECT_NEAR(cosine, 2.0 / 3.0, 4.0 * std::sqrt(1.0 / 18.0 / count));
    EXPECT_NEAR(cosine2, 0.5, 4.0 * std::sqrt(1.0 / 12.0 / count));
    EXPECT_LE(glm::length(side - normal * cosine), 4.0 * std::sqrt(0.5 / count));
    // A (0, m, 1)-net in each parameter has a mean within one step of the area's centroid.
    const auto corners = patches.corners(i);
    const Vec3 diagonal = corners[2] - corners[0];
    const double a = 0.5 * glm::length(glm::cross(corners[1] - corners[0], diagonal));
    const double b = 0.5 * glm::length(glm::cross(diagonal, corners[3] - corners[0]));
    const Vec3 centroid =
        (a * (corners[0] + corners[1] + corners[2]) + b * (corners[0] + corners[2] + corners[3])) /
        (3.0 * (a + b));
    EXPECT_LE(glm::length(centre - centroid),
              4.0 * glm::length(diagonal) / std::sqrt(double(count)) / 8.0);
  }
}

TEST(PatchRays, APacketsRaysAreNeighbours) {
  // Eight consecutive samples in Morton order share an elementary box of an 1/8 of (u, v) space:
  // the directions of a packet vary much less than over the hemisphere.
  const scenes::Scene scene = some_surfaces();
  const scenes::RayQuery query(scene);
  const Patches patches = subdivide(scene, 4.0);
  const PatchRays rays(patches, query, 1024);
  const auto sender = rays.sender(0, base::Key(1, base::Stream::Test, 0));
  RayPacket packet;
  double spread = 0.0;
  for (std::uint32_t first = 0; first < 1024; first += RayPacket::width) {
    rays.make(sender, first, packet);
    Vec3 mean(0.0);
    for (std::size_t k = 0; k < RayPacket::width; ++k) {
      mean += Vec3(packet.direction_x[k], packet.direction_y[k], packet.direction_z[k]) / 8.0;
    }
    spread += (1.0 - glm::length(mean)) / 128.0;
  }
  EXPECT_LE(spread, 0.02);  // over the whole hemisphere 1 - 2/3
}

TEST(HitTargets, AgreeWithTheSearchInDoublePrecision) {
  const scenes::Scene scene = some_surfaces();
  const Patches patches = subdivide(scene, 0.21);
  const HitTargets targets(patches, std::vector<bool>(scene.materials.size(), false));
  for (std::uint32_t triangle = 0; triangle < scene.triangles.size(); ++triangle) {
    for (int i = 0; i < 61; ++i) {
      for (int j = 0; i + j < 61; ++j) {
        // Moved off the cells' edges by an irrational step, so that rounding does not matter.
        const double u = (i + 0.2360680) / 61.5, v = (j + 0.1415927) / 61.5;
        for (const bool front : {true, false}) {
          EXPECT_EQ(targets.find(triangle, static_cast<float>(u), static_cast<float>(v), front),
                    patches.find(triangle, static_cast<float>(u), static_cast<float>(v), front));
        }
      }
    }
  }
}

TEST(HitCounter, GivesColumnsInOrderAndStartsAnew) {
  HitCounter counter(200);
  for (const std::uint32_t patch : {199U, 3U, 64U, 3U, 63U, 199U, 3U}) counter.add(patch, 1.0F);
  counter.add(0, 0.5F);
  std::vector<std::uint32_t> column;
  std::vector<float> hits;
  counter.take(column, hits);
  EXPECT_EQ(column, (std::vector<std::uint32_t>{0, 3, 63, 64, 199}));
  EXPECT_EQ(hits, (std::vector<float>{0.5F, 3, 1, 1, 2}));
  counter.take(column, hits);
  EXPECT_EQ(column.size(), 5U);
}

}  // namespace
}  // namespace earthshine::radiosity
