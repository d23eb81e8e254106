// SPDX-License-Identifier: Apache-2.0
// The thin lens of diameter A focused at s. A lens point p (across the axis) and the picture point
// with tangents q see the lateral position p + (s q - p) d / s at distance d. Hence the point X
// there is seen, through p, at q = X/d + p (1/s - 1/d): a uniform disc of diameter A |d - s| / (d
// s) around its pinhole image, inverted behind the focus. With f' the distance from picture to lens
// in pixels (rows / (2 tan(fov/2))) the blur circle has A f' |d - s| / (d s) pixels.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "base/numbers/random.h"
#include "raytrace/camera/camera.h"
#include "raytrace/render.h"
#include "tests/support/scene_builder.h"

namespace earthshine::raytrace {
namespace {

scenes::Camera lens(double focus_m, double aperture_m) {
  scenes::Camera camera;
  camera.position = Vec3(1, 2, 3);
  camera.look_at = Vec3(5, 2, 3);
  camera.fov_deg = 30.0;
  camera.focus_m = focus_m;
  camera.aperture_m = aperture_m;
  return camera;
}

constexpr int columns = 320, rows = 240;

double blur_px(const CameraModel& model, double aperture_m, double focus_m, double distance_m) {
  const double focal_px = rows / (2.0 * model.projection.half_height);
  return aperture_m * focal_px * std::fabs(distance_m - focus_m) / (distance_m * focus_m);
}

// The point of the ray through (x, y) and a lens point at that distance.
Vec3 at_distance(const CameraModel& model, double x, double y, std::array<double, 2> on_lens,
                 double distance_m) {
  const Ray ray = model.ray(x, y, on_lens[0], on_lens[1]);
  const double forward = glm::dot(ray.direction, model.forward);
  return ray.origin + ray.direction * (distance_m / forward);
}

// The picture point that sees `point` through a lens point: at_distance is affine in x and y.
std::array<double, 2> seen_at(const CameraModel& model, const Vec3& point,
                              std::array<double, 2> on_lens) {
  const double d = glm::dot(point - model.position, model.forward);
  const Vec3 origin = at_distance(model, 0, 0, on_lens, d);
  const double step_x = glm::dot(at_distance(model, 1, 0, on_lens, d) - origin, model.right);
  const double step_y = glm::dot(at_distance(model, 0, 1, on_lens, d) - origin, model.up);
  return {glm::dot(point - origin, model.right) / step_x,
          glm::dot(point - origin, model.up) / step_y};
}

TEST(DepthOfField, PointOutOfFocusIsAUniformDiscOfTheThinLensDiameter) {
  for (const auto& [focus, distance] : {std::pair{4.0, 9.0}, {4.0, 2.5}, {1.2, 60.0}}) {
    const CameraModel model = make_camera_model(lens(focus, 0.08), columns, rows);
    const double diameter = blur_px(model, 0.08, focus, distance);
    const Vec3 point =
        model.position + distance * (model.forward + 0.1 * model.right + 0.15 * model.up);
    const std::array<double, 2> centre = seen_at(model, point, {0.0, 0.0});
    constexpr int n = 4096;
    base::Rng rng(base::Key(7, base::Stream::Test, 0));
    double largest = 0.0, inner = 0.0;
    std::array<double, 2> mean{}, square{};
    for (int k = 0; k < n; ++k) {
      const double u = rng.next(), v = rng.next();
      const std::array<double, 2> at = seen_at(model, point, {u, v});
      const double dx = at[0] - centre[0], dy = at[1] - centre[1];
      largest = std::max(largest, std::hypot(dx, dy));
      inner += std::hypot(dx, dy) < 0.25 * diameter ? 1.0 / n : 0.0;
      mean[0] += dx / n;
      mean[1] += dy / n;
      square[0] += dx * dx / n;
      square[1] += dy * dy / n;
    }
    const double radius = diameter / 2;
    EXPECT_LE(largest, radius * (1.0 + 1e-9));
    EXPECT_GT(largest, radius * 0.999);
    // Half the radius contains a quarter of the disc; per axis the disc has mean 0, variance R^2/4
    // and variance of the square R^4/16.
    EXPECT_NEAR(inner, 0.25, 4.0 * std::sqrt(0.25 * 0.75 / n));
    for (const std::size_t axis : {0U, 1U}) {
      EXPECT_NEAR(mean[axis], 0.0, 4.0 * radius / 2.0 / std::sqrt(n));
      EXPECT_NEAR(square[axis], radius * radius / 4.0, 4.0 * radius * radius / 4.0 / std::sqrt(n));
    }
  }
}

TEST(DepthOfField, PointInFocusAndPinholePictureAreSharp) {
  const CameraModel model = make_camera_model(lens(4.0, 0.3), columns, rows);
  const CameraModel pinhole = make_camera_model(lens(0.0, 0.0), columns, rows);
  const Vec3 point = model.position + 4.0 * (model.forward - 0.2 * model.right + 0.1 * model.up);
  const std::array<double, 2> sharp = seen_at(pinhole, point, {0.0, 0.0});
  for (const double u : {0.0, 0.4, 0.9}) {
    const std::array<double, 2> at = seen_at(model, point, {u, 0.37 + 0.5 * u});
    EXPECT_NEAR(at[0], sharp[0], 1e-9);
    EXPECT_NEAR(at[1], sharp[1], 1e-9);
  }
}

struct Spot {
  double light = 0.0;         // sum of the pixels
  double variance_px2 = 0.0;  // per axis, mean of both
  double reach_px = 0.0;      // farthest lit pixel centre from the middle
};

// A bright square of `side_m` on the axis at `distance_m`, black elsewhere.
Spot spot(scenes::Camera camera, double distance_m, double side_m, int edge_px) {
  camera.position = Vec3(0, 0, distance_m);
  camera.look_at = Vec3(0.0);
  camera.up = Vec3(0, 1, 0);
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.0, 1000.0)), side_m, 0.0, true);
  const tests::Prepared prepared(builder.scene);
  RenderOptions options;
  options.columns = options.rows = edge_px;
  options.gather_rays = 4096;
  options.indirect = Indirect::None;
  const Frame frame = render(prepared, {}, camera, options);
  Spot result;
  for (int y = 0; y < edge_px; ++y) {
    for (int x = 0; x < edge_px; ++x) {
      const double value =
          frame.image.channels[1].values[static_cast<std::size_t>(y * edge_px + x)];
      const double dx = x + 0.5 - edge_px / 2.0, dy = y + 0.5 - edge_px / 2.0;
      result.light += value;
      result.variance_px2 += value * 0.5 * (dx * dx + dy * dy);
      if (value > 0.0) result.reach_px = std::max(result.reach_px, std::hypot(dx, dy));
    }
  }
  result.variance_px2 /= result.light;
  return result;
}

TEST(DepthOfField, RenderedSpotSpreadsOverTheBlurCircleAndKeepsItsLight) {
  // A square of 1.2 px (variance 0.12 px^2) in pixels of 1 px (1/12), blurred to D = 20 px
  // (D^2/16).
  const double focus = 4.0, distance = 8.0;
  constexpr int edge_px = 40;
  scenes::Camera camera = lens(focus, 0.0);
  camera.fov_deg = 20.0;
  const double focal_px = edge_px / (2.0 * std::tan(base::radians(10.0)));
  camera.aperture_m = 20.0 * distance * focus / (focal_px * (distance - focus));
  const double side = 1.2 * distance / focal_px;
  const Spot blurred = spot(camera, distance, side, edge_px);
  camera.focus_m = distance;
  const Spot sharp = spot(camera, distance, side, edge_px);
  camera.focus_m = camera.aperture_m = 0.0;
  const Spot pinhole = spot(camera, distance, side, edge_px);

  // 64 samples a pixel for 1.44 px^2 of light: 92 random samples hit it, and Sobol points have less
  // variance. Light: 1/sqrt(n); variance per axis R^2/4/sqrt(n), of two axes.
  const double hits = 64.0 * 1.44, radius = 10.0;
  EXPECT_NEAR(blurred.light / pinhole.light, 1.0, 4.0 / std::sqrt(hits));
  EXPECT_NEAR(blurred.variance_px2, radius * radius / 4.0 + 0.12 + 1.0 / 12.0,
              4.0 * radius * radius / 4.0 / std::sqrt(2.0 * hits));
  EXPECT_LE(blurred.reach_px, radius + 0.6 * std::sqrt(2.0) + 0.5 * std::sqrt(2.0));
  EXPECT_GT(blurred.reach_px, 0.8 * radius);
  EXPECT_NEAR(sharp.variance_px2, pinhole.variance_px2, 0.05);
  EXPECT_LT(sharp.reach_px, 3.0);
}

}  // namespace
}  // namespace earthshine::raytrace
