// SPDX-License-Identifier: Apache-2.0
// Edges in pictures with fixed numbers of samples: a pixel's value is its covered share.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "raytrace/render.h"
#include "tests/support/scene_builder.h"

namespace earthshine::raytrace {
namespace {

// The line of points with normal . (x, y) = at; the half plane beyond it is covered.
struct HalfPlane {
  double normal_x, normal_y, at;
  [[nodiscard]] double beyond(double x, double y) const { return normal_x * x + normal_y * y - at; }
};

// The share of the unit square at (x, y) that a half plane covers: area of the square clipped by
// the line.
double covered(const HalfPlane& half, double x, double y) {
  const std::array<std::array<double, 2>, 4> corner = {
      {{x, y}, {x + 1, y}, {x + 1, y + 1}, {x, y + 1}}};
  std::vector<std::array<double, 2>> kept;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto &a = corner[k], &b = corner[(k + 1) % 4];
    const double at_a = half.beyond(a[0], a[1]), at_b = half.beyond(b[0], b[1]);
    if (at_a >= 0.0) kept.push_back(a);
    if ((at_a >= 0.0) == (at_b >= 0.0)) continue;
    const double t = at_a / (at_a - at_b);
    kept.push_back({a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])});
  }
  double twice = 0.0;
  for (std::size_t k = 0; k < kept.size(); ++k) {
    const auto &a = kept[k], &b = kept[(k + 1) % kept.size()];
    twice += (a[0] - x) * (b[1] - y) - (b[0] - x) * (a[1] - y);
  }
  return 0.5 * twice;
}

// 96 x 96 pixels of the plane z = 0 seen from above, each one unit wide and high; x to the right
// and y down in the picture.
constexpr int edge_px = 96;

RenderOptions by_settings() {
  RenderOptions options;
  options.columns = options.rows = edge_px;
  options.gather_rays = 8;
  options.camera_samples = 16;
  return options;
}

scenes::Camera from_above() {
  scenes::Camera camera;
  camera.position = Vec3(0.5 * edge_px, -0.5 * edge_px, 1000.0);
  camera.look_at = Vec3(0.5 * edge_px, -0.5 * edge_px, 0.0);
  camera.up = Vec3(0, 1, 0);
  camera.fov_deg = 2.0 * std::atan(0.5 * edge_px / 1000.0) * 180.0 / base::pi;
  return camera;
}

scenes::Sun point_sun(const Vec3& direction) {
  scenes::Sun sun;
  sun.direction = glm::normalize(direction);
  sun.illuminance_lx = Rgb(1000.0);
  sun.angular_radius_deg = 1e-5;
  return sun;
}

// Allowed error at an edge. Each of 4 x 4 equal squares of a pixel has one of 16 samples, at a
// uniform position. A straight line crosses at most 7 of them. There the squared error is
// c (1 - c), 1/6 on average over positions of the line: the RMS error is sqrt(7 / 6) / 16 over all
// pixels, and with 1/4 in each square four times sqrt(7 / 4) / 16 in any pixel. With 4 samples it
// would be sqrt(3 / 6) / 4, since the line crosses at most 3 of 2 x 2.
const double most_rms = std::sqrt(7.0 / 6.0) / 16.0, most_anywhere = std::sqrt(7.0 / 4.0) / 4.0;

// values: relative to a fully covered pixel.
void expect_coverage(const std::vector<float>& values, double whole, const HalfPlane& half) {
  double squares = 0.0;
  int pixels = 0;
  for (int y = 1; y < edge_px - 1; ++y) {
    for (int x = 1; x < edge_px - 1; ++x) {
      const double exact = covered(half, x, y);
      const double shown = double(values[static_cast<std::size_t>(y * edge_px + x)]) / whole;
      if (exact <= 0.0 || exact >= 1.0) {
        EXPECT_NEAR(shown, exact, 1e-4) << x << ' ' << y;
        continue;
      }
      EXPECT_NEAR(shown, exact, most_anywhere) << x << ' ' << y;
      squares += (shown - exact) * (shown - exact);
      ++pixels;
    }
  }
  ASSERT_GT(pixels, edge_px);
  EXPECT_LT(std::sqrt(squares / pixels), most_rms);
}

HalfPlane through_the_middle(double angle_deg) {
  const double angle = base::radians(angle_deg);
  const double x = std::cos(angle), y = std::sin(angle), middle = 0.5 * edge_px + 0.3;
  return {x, y, (x + y) * middle};
}

// A large rectangle of the plane z = height, front up, whose near edge is the half plane's line. In
// the scene y is up, in the picture down.
void add_beyond(tests::SceneBuilder& builder, std::uint32_t material, const HalfPlane& half,
                double height) {
  const Vec3 normal(half.normal_x, -half.normal_y, 0.0), along(half.normal_y, half.normal_x, 0.0);
  const Vec3 foot = normal * half.at + Vec3(0.0, 0.0, height);
  constexpr double far = 1000.0;
  builder.quad(material, foot - along * far, foot + normal * far - along * far,
               foot + normal * far + along * far, foot + along * far);
}

TEST(Edges, OfASilhouette) {
  for (const double angle : {7.0, 33.0, 101.0}) {
    const HalfPlane half = through_the_middle(angle);
    tests::SceneBuilder builder;
    add_beyond(builder, builder.material(tests::grey(0.5)), half, 0.0);
    builder.scene.sun = point_sun(Vec3(0.3, 0.2, 1.0));
    const tests::Prepared prepared(builder.scene);
    radiosity::SolveOptions solve;
    solve.patch_edge_m = 100.0;
    const Frame frame = render(prepared, prepared.solve(solve), from_above(), by_settings());
    const double whole = 1000.0 * builder.scene.sun->direction.z * 0.5 / base::pi;
    expect_coverage(frame.image.find("G")->values, whole, half);
  }
}

}  // namespace
}  // namespace earthshine::raytrace
