// SPDX-License-Identifier: Apache-2.0
#include "raytrace/camera/camera.h"

#include <gtest/gtest.h>

#include <cmath>

namespace earthshine::raytrace {
namespace {

scenes::Camera looking_down_x() {
  scenes::Camera camera;
  camera.position = Vec3(1, 2, 3);
  camera.look_at = Vec3(5, 2, 3);
  camera.up = Vec3(0, 0, 1);
  camera.fov_deg = 40.0;
  return camera;
}

TEST(Camera, CentreOfThePictureLooksAtTheTarget) {
  const CameraModel model = make_camera_model(looking_down_x(), 640, 480);
  EXPECT_NEAR(glm::length(model.ray(320, 240, 0, 0).direction - Vec3(1, 0, 0)), 0.0, 1e-15);
}

TEST(Camera, TopEdgeIsHalfTheVerticalFieldUpAndColumnsRunToTheRight) {
  const CameraModel model = make_camera_model(looking_down_x(), 640, 480);
  const Vec3 top = model.ray(320, 0, 0, 0).direction;
  EXPECT_NEAR(std::asin(top.z), base::radians(20.0), 1e-12);
  // Looking along +x with z up, right is -y.
  EXPECT_LT(model.ray(640, 240, 0, 0).direction.y, 0.0);
}

TEST(Camera, PixelsAreSquareWhateverTheAspect) {
  const CameraModel model = make_camera_model(looking_down_x(), 640, 480);
  const Vec3 c = model.ray(320, 240, 0, 0).direction;
  const Vec3 right = model.ray(321, 240, 0, 0).direction,
             down = model.ray(320, 241, 0, 0).direction;
  EXPECT_NEAR(glm::length(right - c), glm::length(down - c), 1e-9);
}

TEST(Camera, EveryPointOfTheLensSeesTheSamePointInFocus) {
  scenes::Camera lens = looking_down_x();
  lens.focus_m = 4.0;
  lens.aperture_m = 0.5;
  const CameraModel model = make_camera_model(lens, 64, 64);
  const Vec3 expected = [&] {
    const Ray r = model.ray(20.3, 11.7, 0.0, 0.0);
    return r.origin + r.direction * (4.0 / r.direction.x);
  }();
  for (const double u : {0.1, 0.5, 0.99}) {
    const Ray r = model.ray(20.3, 11.7, u, 0.3 * u);
    const Vec3 p = r.origin + r.direction * ((5.0 - r.origin.x) / r.direction.x);
    EXPECT_NEAR(glm::length(p - expected), 0.0, 1e-9);
    EXPECT_LE(glm::length(r.origin - lens.position), 0.25 + 1e-12);
  }
}

// Points along a ray project to the ray's film position, through the same point of the lens. A
// pixel's square, projected to a plane by four rays, has the area of film_per_m2 there.
TEST(Camera, FilmIsWhereRaysCameFrom) {
  for (const double aperture : {0.0, 0.2}) {
    scenes::Camera camera;
    camera.position = Vec3(1, -2, 3);
    camera.look_at = Vec3(0.3, 0.1, 0.2);
    camera.aperture_m = aperture;
    camera.focus_m = 2.5;
    const CameraModel model = make_camera_model(camera, 30, 20);
    const Ray ray = model.ray(22.3, 4.1, 0.7, 0.4);
    const Vec3 point = ray.origin + 3.7 * ray.direction;
    const glm::dvec2 film = model.film_from(ray.origin, point);
    EXPECT_NEAR(film.x, 22.3, 1e-9);
    EXPECT_NEAR(film.y, 4.1, 1e-9);
    const Vec3 normal = glm::normalize(Vec3(0.5, -0.4, 0.9));
    const auto met = [&](double x, double y) {
      const Vec3 way = model.direction_from(ray.origin, 22.3 + x, 4.1 + y);
      return ray.origin + glm::dot(point - ray.origin, normal) / glm::dot(way, normal) * way;
    };
    const double h = 1e-4;
    const double area =
        glm::length(glm::cross(met(h, h) - met(-h, -h), met(-h, h) - met(h, -h))) / 2;
    EXPECT_NEAR(model.film_per_m2(ray.origin, point, normal) * area, 4.0 * h * h, 1e-6 * h * h);
  }
}

TEST(Camera, BlurCircleFollowsTheThinLens) {
  // A point at distance z seen through a lens of diameter A focused at s: its pencil is
  // A |s - z| / z wide in the plane in focus.
  scenes::Camera lens = looking_down_x();
  lens.focus_m = 4.0;
  lens.aperture_m = 0.2;
  const CameraModel model = make_camera_model(lens, 64, 64);
  const Vec3 point = lens.position + Vec3(8, 0, 0);
  const Ray edge = model.ray(32, 32, 1.0 - 1e-12, 0.0);
  const Vec3 to_point = point - edge.origin;  // the same lens point's ray to the blurred point
  const Vec3 at_focus = edge.origin + to_point * (4.0 / to_point.x);
  EXPECT_NEAR(glm::length(at_focus - (lens.position + Vec3(4, 0, 0))), 0.1 * (8.0 - 4.0) / 8.0,
              1e-9);
}

}  // namespace
}  // namespace earthshine::raytrace
