// SPDX-License-Identifier: Apache-2.0
#include "scenes/view/projection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>

namespace earthshine::scenes {
namespace {

Camera calibrated(Distortion distortion, std::array<double, 5> k) {
  Camera camera;
  camera.columns = 640;
  camera.rows = 480;
  camera.intrinsics = {500.0, 520.0, 330.0, 225.0};
  camera.distortion = distortion;
  camera.distortion_k = k;
  return camera;
}

// Its farthest corner is 1.6 from the axis on the film.
Camera wide(Camera camera) {
  camera.intrinsics = {250.0, 250.0, 320.0, 240.0};
  return camera;
}

glm::dvec2 pixel(const Projection& projection, const Vec3& point) {
  const glm::dvec2 at = projection.place(point);
  return {640.0 * at.x, 480.0 * at.y};
}

// The equations of OpenCV's documentation (calib3d), worked by hand for the point (0.2, 0.1, 0.5),
// x' = 0.4, y' = 0.2, r^2 = 0.2:
//   radial = 1 - 0.3 * 0.2 + 0.1 * 0.04 - 0.05 * 0.008 = 0.9436
//   x'' = 0.4 * 0.9436 + 2 * 0.001 * 0.08 - 0.002 * (0.2 + 0.32) = 0.37656
//   y'' = 0.2 * 0.9436 + 0.001 * (0.2 + 0.08) - 2 * 0.002 * 0.08 = 0.18868
TEST(Projection, BrownConradyIsOpenCvs) {
  const Projection lens(calibrated(Distortion::BrownConrady, {-0.3, 0.1, 0.001, -0.002, -0.05}),
                        640, 480);
  const glm::dvec2 at = pixel(lens, {0.2, 0.1, 0.5});
  EXPECT_NEAR(at.x, 330.0 + 500.0 * 0.37656, 1e-9);
  EXPECT_NEAR(at.y, 225.0 + 520.0 * 0.18868, 1e-9);
}

// OpenCV's fisheye module: r = sqrt(0.2), theta = atan(r), theta_d = theta (1 + k1 theta^2 + ...).
TEST(Projection, FisheyeIsOpenCvs) {
  const Projection lens(calibrated(Distortion::Fisheye, {0.05, -0.01, 0.002, -0.0005}), 640, 480);
  const double r = std::sqrt(0.2), t = std::atan(r), t2 = t * t;
  const double td =
      t * (1 + 0.05 * t2 - 0.01 * t2 * t2 + 0.002 * t2 * t2 * t2 - 0.0005 * t2 * t2 * t2 * t2);
  const glm::dvec2 at = pixel(lens, {0.2, 0.1, 0.5});
  EXPECT_NEAR(at.x, 330.0 + 500.0 * td / r * 0.4, 1e-9);
  EXPECT_NEAR(at.y, 225.0 + 520.0 * td / r * 0.2, 1e-9);
  // Behind the camera too: theta = 100 degrees.
  const double back = base::radians(100.0), b2 = back * back;
  const double far = back * (1 + b2 * (0.05 + b2 * (-0.01 + b2 * (0.002 - b2 * 0.0005))));
  EXPECT_NEAR(pixel(lens, {std::sin(back), 0.0, std::cos(back)}).x, 330.0 + 500.0 * far, 1e-9);
}

// Directions of places are seen at these places; the area of film per steradian and its longest
// side are those of four neighbouring directions, by central differences (errors of h^2).
TEST(Projection, InvertsAndMeasures) {
  for (const Camera& camera :
       {calibrated(Distortion::None, {}),
        calibrated(Distortion::BrownConrady, {-0.3, 0.1, 0.001, -0.002, 0.02}),
        calibrated(Distortion::BrownConrady, {0.4, 0.2, -0.003, 0.002, 0.0}),
        // The film r (1 + 0.5 r^2 - 0.2 r^4) grows up to r = sqrt(2), to 1.697: a wide picture lies
        // between the limit of r and that of the film.
        wide(calibrated(Distortion::BrownConrady, {0.5, -0.2, 0.0, 0.0, 0.0})),
        calibrated(Distortion::Fisheye, {0.05, -0.01, 0.002, -0.0005})}) {
    const Projection lens(camera, 640, 480);
    EXPECT_TRUE(lens.covers_picture());
    for (const glm::dvec2 at : {glm::dvec2(0.0, 0.0), {0.99, 0.03}, {0.4, 0.7}, {0.53, 0.47}}) {
      const Vec3 d = glm::normalize(lens.direction(at));
      EXPECT_LT(glm::length(lens.place(3.0 * d) - at), 1e-12);
      EXPECT_TRUE(lens.shows(lens.direction(glm::mix(at, glm::dvec2(0.5), 1e-6))));
      const base::Frame3 around = base::frame_around(d);
      constexpr double h = 1e-5;
      const auto slope = [&](const Vec3& axis) {
        const glm::dvec2 moved = lens.place(d + h * axis) - lens.place(d - h * axis);
        return glm::dvec2(moved.x * 2.0 * lens.half_width, moved.y * 2.0 * lens.half_height) /
               (2.0 * h);
      };
      const glm::dvec2 u = slope(around.tangent), v = slope(around.bitangent);
      const double area = std::abs(u.x * v.y - u.y * v.x);
      EXPECT_NEAR(lens.film_per_sr(d) / area, 1.0, 1e-7);
      EXPECT_GE(lens.film_per_rad(d), (1.0 - 1e-7) * std::max(glm::length(u), glm::length(v)));
    }
  }
}

// With k1 = -0.3 the film r (1 - 0.3 r^2) turns back at r = 1 / sqrt(0.9) = 1.054: a point farther
// from the axis is outside the picture, not folded into it, and a picture that wide is refused.
TEST(Projection, DoesNotFold) {
  Camera camera = calibrated(Distortion::BrownConrady, {-0.3, 0, 0, 0, 0});
  EXPECT_FALSE(Projection(camera, 640, 480).shows({1.8, 0.0, 1.0}));
  camera.intrinsics = {300.0, 300.0, 320.0, 240.0};
  EXPECT_FALSE(Projection(camera, 640, 480).covers_picture());
}

// A pinhole at the angle a from the axis: f / cos^2 a away from the axis, f / cos a around it.
// Through a fisheye lens r = f (a + k a^3): f (1 + 3 k a^2) away, r / sin a around. With k1 alone,
// Brown and Conrady's lens stretches the pinhole's radius t by 1 + 3 k1 t^2.
TEST(Projection, PixelsPerRadianAreThoseOfTheLensAndOfTheFinerSide) {
  Camera camera = calibrated(Distortion::None, {});
  camera.intrinsics = {480.0, 30.0, 320.0, 240.0};
  const Projection tall(camera, 640, 480);
  const auto at = [](double deg) {
    return Vec3(std::sin(base::radians(deg)), 0.0, std::cos(base::radians(deg)));
  };
  EXPECT_NEAR(tall.px_per_rad({0, 0, 1}, 640, 480), 480.0, 1e-4);
  EXPECT_NEAR(tall.px_per_rad(at(60), 640, 480), 480.0 * 4.0, 1e-3);
  const Vec3 upward(0.0, at(60).x, at(60).z);
  EXPECT_NEAR(tall.px_per_rad(upward, 640, 480), 480.0 * 2.0, 1e-3);
  EXPECT_NEAR(tall.px_per_rad(at(76), 1280, 960), 2.0 * 480.0 / std::pow(at(76).z, 2), 0.1);
  const double f = 250.0, a = base::radians(50.0), t = std::tan(a);
  const Projection fish(wide(calibrated(Distortion::Fisheye, {-0.02, 0, 0, 0, 0})), 640, 480);
  EXPECT_NEAR(fish.px_per_rad(at(50), 640, 480), f * (a - 0.02 * a * a * a) / std::sin(a), 1e-3);
  const Projection barrel(wide(calibrated(Distortion::BrownConrady, {0.05, 0, 0, 0, 0})), 640, 480);
  EXPECT_NEAR(barrel.px_per_rad(at(50), 640, 480),
              f * (1.0 + 3.0 * 0.05 * t * t) / std::pow(std::cos(a), 2), 1e-2);
}

}  // namespace
}  // namespace earthshine::scenes
