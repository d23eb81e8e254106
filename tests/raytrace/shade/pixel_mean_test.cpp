// SPDX-License-Identifier: Apache-2.0
// Large pixels of the shared gather, against the closed form of their means.
#include <gtest/gtest.h>

#include <cmath>

#include "raytrace/paths/path_tracer.h"
#include "raytrace/render.h"
#include "tests/support/scene_builder.h"

namespace earthshine::raytrace {
namespace {

// The middle pixel of 3 x 3 looks straight down on a dark floor from the foot of a sunlit wall to
// w = 2 m off it. A long wall of height h with exitance M gives
// E(x) = M / 2 (1 - x / sqrt(x^2 + h^2)) at distance x, with the integral
// M / 2 (x - sqrt(x^2 + h^2)): the mean over the pixel is ten times the value at its centre. A wall
// of 100 m lacks less than (w / 50)^2 of that; the wall gets back less than rho / 4 of M. In one
// case a black speck close to the camera covers the middle fifth of the pixel, across and down. In
// another, under a black roof at 30 m, few of the centre's rays meet the wall, and the first ones
// may miss it. The pixel's value must be the same in all cases.
enum class With { Nothing, Speck, Roof };
class PixelMean : public ::testing::TestWithParam<With> {};

TEST_P(PixelMean, LightThatChangesWithinAPixelIsItsMean) {
  constexpr double w = 2.0, h = 0.1, rho = 0.01, exitance = 500.0, height = 10.0;
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(rho)), 200.0, 0.0, true);
  builder.quad(builder.material(tests::grey(0.5)), Vec3(0, -50, 0), Vec3(0, 50, 0), Vec3(0, 50, h),
               Vec3(0, -50, h));
  const bool hidden = GetParam() == With::Speck;
  constexpr double covered = 0.2, near = 0.01;
  if (hidden) {
    const double edge = 0.5 * covered * w * near, z = height * (1.0 - near);
    builder.quad(builder.material(tests::grey(0.0)), Vec3(0.5 * w - edge, -edge, z),
                 Vec3(0.5 * w + edge, -edge, z), Vec3(0.5 * w + edge, edge, z),
                 Vec3(0.5 * w - edge, edge, z));
  }
  if (GetParam() == With::Roof) {
    builder.quad(builder.material(tests::grey(0.0)), Vec3(-200, -200, 30), Vec3(-200, 200, 30),
                 Vec3(200, 200, 30), Vec3(200, -200, 30));
  }
  scenes::Sun sun;
  sun.direction = Vec3(1, 0, 0);  // along the floor
  sun.illuminance_lx = Rgb(2.0 * exitance);
  sun.angular_radius_deg = 1e-5;
  builder.scene.sun = sun;
  const tests::Prepared prepared(builder.scene);
  scenes::Camera camera;
  camera.position = Vec3(0.5 * w, 0, height);
  camera.look_at = Vec3(0.5 * w, 0, 0);
  camera.up = Vec3(0, 1, 0);
  camera.fov_deg = 2.0 * std::atan(1.5 * w / height) * 180.0 / base::pi;
  RenderOptions options;
  options.columns = options.rows = 3;
  options.gather_rays = 2048;
  options.denoise = false;
  radiosity::SolveOptions solve;
  solve.patch_edge_m = 5.0;
  const radiosity::Solution solution = prepared.solve(solve);
  constexpr int pictures = 128;
  double sum = 0.0, squares = 0.0;
  for (options.seed = 1; options.seed <= pictures; ++options.seed) {
    const Frame frame = render(prepared, solution, camera, options);
    const double found = double(frame.image.find("G")->values[4]);
    sum += found, squares += found * found;
  }
  const double found = sum / pictures;
  const double standard_error = std::sqrt((squares / pictures - found * found) / (pictures - 1));
  const auto integral = [&](double from, double to) {
    const auto upto = [&](double x) { return x - std::sqrt(x * x + h * h); };
    return exitance / 2.0 * (upto(to) - upto(from));
  };
  const double seen =
      (integral(0.0, w) -
       (hidden ? covered * integral((1 - covered) * w / 2, (1 + covered) * w / 2) : 0.0)) /
      w;
  const double right = rho / base::pi * seen;
  EXPECT_LT(standard_error, 0.05 * right);
  EXPECT_NEAR(found, right, 4.0 * standard_error + (std::pow(w / 50.0, 2) + rho / 4.0) * right);
}

INSTANTIATE_TEST_SUITE_P(Gather, PixelMean,
                         ::testing::Values(With::Nothing, With::Speck, With::Roof));

// A glossy vault of facets, 2 degrees from one to the next, that turns by 16 degrees across the
// middle pixel of 3 x 3, under a sunlit strip that is 8 degrees wide. The facet at the pixel's
// centre mirrors the strip, most of the pixel does not: the picture has the mean of all paths.
TEST(TurningLobe, IsItsMeanOverThePixel) {
  constexpr double w = 2.0, height = 10.0, step = base::radians(2.0);
  const double radius = w / 2.0 / std::sin(4.0 * step);
  tests::SceneBuilder builder;
  scenes::Material glossy = tests::grey(0.0);
  glossy.specular = Rgb(0.5);
  glossy.shininess = 90.0;
  const std::uint32_t shiny = builder.material(glossy);
  const auto along = [&](double turn, double y) {
    return Vec3(radius * std::sin(turn), y, radius * (std::cos(turn) - 1.0));
  };
  for (int k = -12; k < 12; ++k) {
    const double left = (k + 0.5) * step, right = left + step;
    builder.quad(shiny, along(left, -50), along(right, -50), along(right, 50), along(left, 50));
  }
  builder.quad(builder.material(tests::grey(0.5)), Vec3(-2, -200, 30), Vec3(-2, 200, 30),
               Vec3(2, 200, 30), Vec3(2, -200, 30));
  scenes::Sun sun;
  sun.direction = Vec3(0.8, 0, -0.6);  // below the vault's horizon
  sun.illuminance_lx = Rgb(1000.0);
  sun.angular_radius_deg = 1e-5;
  builder.scene.sun = sun;
  const tests::Prepared prepared(builder.scene);
  scenes::Camera camera;
  camera.position = Vec3(0, 0, height);
  camera.look_at = Vec3(0.0);
  camera.up = Vec3(0, 1, 0);
  camera.fov_deg = base::degrees(2.0 * std::atan(1.5 * w / height));
  radiosity::SolveOptions solve;
  solve.patch_edge_m = 5.0;
  const radiosity::Solution solution = prepared.solve(solve);
  const auto pixel = [&](bool by_paths) {
    constexpr int pictures = 256;
    double sum = 0.0, squares = 0.0;
    for (std::uint64_t seed = 1; seed <= pictures; ++seed) {
      RenderOptions options;
      options.columns = options.rows = 3;
      options.gather_rays = 64;
      options.denoise = false;
      options.seed = seed;
      PathOptions paths;
      paths.columns = paths.rows = 3;
      paths.paths_per_pixel = 512;
      paths.seed = seed;
      const Frame frame = by_paths ? trace_paths(prepared, camera, paths)
                                   : render(prepared, solution, camera, options);
      const double found = double(frame.image.find("G")->values[4]);
      sum += found, squares += found * found;
    }
    const double mean = sum / pictures;
    return std::pair(mean, (squares / pictures - mean * mean) / (pictures - 1));
  };
  const auto [right, right_variance] = pixel(true);
  const auto [found, variance] = pixel(false);
  const double standard_error = std::sqrt(right_variance + variance);
  EXPECT_LT(standard_error, 0.05 * right);
  EXPECT_NEAR(found, right, 4.0 * standard_error);
}

}  // namespace
}  // namespace earthshine::raytrace
