// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "base/numbers/random.h"
#include "raytrace/camera/camera.h"

namespace earthshine::raytrace {
namespace {

using Columns4 = std::array<double, 4>;

// M v, M row by row.
Columns4 times(const std::array<double, 16>& m, const Columns4& v) {
  Columns4 r{};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 4; ++k) r[i] += m[4 * i + k] * v[k];
  }
  return r;
}

// v M, as in OpenEXR, in the single precision of the file.
Columns4 times(const Columns4& v, const std::array<double, 16>& m) {
  Columns4 r{};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 4; ++k) r[i] += v[k] * static_cast<double>(float(m[4 * k + i]));
  }
  return r;
}

struct Shot {
  CameraModel camera;
  double x, y, distance;
  Vec3 position;
};

// Cameras within 10 m of the origin in random directions, and points on rays through their pixels.
std::vector<Shot> shots() {
  std::vector<Shot> all;
  base::Rng rng(base::Key(1, base::Stream::Test, 0));
  const auto anywhere = [&rng] {
    const double x = rng.next(), y = rng.next(), z = rng.next();
    return 10.0 * Vec3(2 * x - 1, 2 * y - 1, 2 * z - 1);
  };
  for (int i = 0; i < 200; ++i) {
    scenes::Camera camera;
    camera.position = anywhere();
    camera.look_at = anywhere();
    camera.up = glm::normalize(anywhere());
    camera.fov_deg = 20.0 + 70.0 * rng.next();
    Shot shot;
    shot.camera = make_camera_model(camera, 200 + i % 50, 150 + i % 70);
    shot.x = rng.next() * shot.camera.columns;
    shot.y = rng.next() * shot.camera.rows;
    const Ray ray = shot.camera.ray(shot.x, shot.y, 0.0, 0.0);
    shot.distance = 2.0 + 10.0 * rng.next();
    shot.position = ray.origin + shot.distance * ray.direction;
    all.push_back(shot);
  }
  return all;
}

// K and to_world invert the camera's ray: pixel -> ray -> point -> pixel.
TEST(CameraHeader, ComputerVisionMatricesProjectAPointToItsPixel) {
  for (const Shot& shot : shots()) {
    const CameraMatrices m = camera_matrices(shot.camera);
    // The inverse of a rigid motion: transposed rotation.
    const Vec3 from(shot.position.x - m.to_world[3], shot.position.y - m.to_world[7],
                    shot.position.z - m.to_world[11]);
    double c[3];
    for (std::size_t i = 0; i < 3; ++i) {
      c[i] = m.to_world[i] * from.x + m.to_world[4 + i] * from.y + m.to_world[8 + i] * from.z;
    }
    EXPECT_GT(c[2], 0.0);
    EXPECT_NEAR((m.k[0] * c[0] + m.k[1] * c[1] + m.k[2] * c[2]) / c[2], shot.x, 1e-9);
    EXPECT_NEAR((m.k[3] * c[0] + m.k[4] * c[1] + m.k[5] * c[2]) / c[2], shot.y, 1e-9);
    EXPECT_DOUBLE_EQ(m.k[0], m.k[4]);  // square pixels
  }
}

TEST(CameraHeader, PoseIsARightHandedRotationAndTheCamerasPlace) {
  for (const Shot& shot : shots()) {
    const CameraMatrices m = camera_matrices(shot.camera);
    const Columns4 origin = times(m.to_world, {0, 0, 0, 1});
    EXPECT_EQ(Vec3(origin[0], origin[1], origin[2]), shot.camera.position);
    const auto column = [&m](std::size_t i) {
      return Vec3(m.to_world[i], m.to_world[4 + i], m.to_world[8 + i]);
    };
    EXPECT_LT(glm::length(glm::cross(column(0), column(1)) - column(2)), 1e-12);
    EXPECT_LT(glm::length(column(1) + shot.camera.up), 1e-12);
    EXPECT_LT(glm::length(column(2) - shot.camera.forward), 1e-12);
  }
}

// The file has single precision: 2^-24 of some 20 m at 2 m and 250 pixels is 1.5e-4 pixels at most,
// a few times that in sum.
TEST(CameraHeader, StandardMatricesProjectAPointToItsPlaceOnTheScreen) {
  for (const Shot& shot : shots()) {
    const CameraMatrices m = camera_matrices(shot.camera);
    const Columns4 world = {shot.position.x, shot.position.y, shot.position.z, 1.0};
    const Columns4 ndc = times(world, m.world_to_ndc);
    EXPECT_NEAR(ndc[0] / ndc[3] * shot.camera.columns, shot.x, 1e-3);
    EXPECT_NEAR(ndc[1] / ndc[3] * shot.camera.rows, shot.y, 1e-3);
    const Columns4 camera = times(world, m.world_to_camera);
    const Vec3 from = shot.position - shot.camera.position;
    EXPECT_NEAR(camera[0], glm::dot(from, shot.camera.right), 1e-5);
    EXPECT_NEAR(camera[1], glm::dot(from, shot.camera.up), 1e-5);
    EXPECT_NEAR(camera[2], glm::dot(from, shot.camera.forward), 1e-5);
    EXPECT_EQ(camera[3], 1.0);
    // The screen window at distance 1 is as wide as the picture.
    EXPECT_NEAR((camera[0] / camera[2] / m.screen_window_width + 0.5) * shot.camera.columns, shot.x,
                1e-3);
  }
}

}  // namespace
}  // namespace earthshine::raytrace
