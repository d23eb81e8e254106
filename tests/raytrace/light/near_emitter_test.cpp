// SPDX-License-Identifier: Apache-2.0
// Shadow rays end at their target point on an emitter, not at the emitter itself: at any angle, in
// scenes of any size, and through glass.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "raytrace/render.h"
#include "tests/raytrace/path_picture.h"

namespace earthshine::raytrace {
namespace {

constexpr int size_px = 16;

// A floor of 1 m and a square of 20 cm that shines down from 10 cm, seen from below: from the floor
// beyond 17 cm it is seen under more than 60 degrees. A black plate far below, wide or small,
// lights nothing. The panes are perfectly transparent.
struct Hall {
  Hall(double width_m, int panes) {
    tests::SceneBuilder builder;
    builder.plate(builder.material(tests::grey(0.5)), 1.0, 0.0, true);
    const std::uint32_t lit = builder.material(tests::grey(0.0, 100.0));
    builder.plate(lit, 0.2, 0.1, false);
    builder.plate(builder.material(tests::grey(0.0)), width_m, -0.1, true);
    for (int k = 0; k < panes; ++k) {
      builder.plate(builder.material(sheet(0.0, 0.0, 1.0)), 1.0, 0.02 + 0.01 * k, true);
    }
    scene = builder.scene;
  }
  scenes::Scene scene;
};

scenes::Camera beside() {
  scenes::Camera camera;
  camera.position = Vec3(0.45, 0.0, 0.015);
  camera.look_at = Vec3(0.3, 0.0, 0.0);
  camera.fov_deg = 40.0;
  return camera;
}

double mean_green(const base::Image& image) {
  double sum = 0.0;
  for (const float v : image.find("G")->values) sum += double(v) / (size_px * size_px);
  return sum;
}

constexpr std::size_t ways = 3, seeds = 8;

// By the path tracer, the ray tracer and the solver: means and their standard errors.
struct Found {
  std::array<double, ways> mean{}, standard_error{};
};
Found light_of(const scenes::Scene& scene, const scenes::Camera& camera) {
  const tests::Prepared prepared(scene);
  std::array<std::array<double, ways>, seeds> each{};
  Found found;
  for (std::size_t k = 0; k < seeds; ++k) {
    PathOptions paths;
    paths.columns = paths.rows = size_px;
    paths.paths_per_pixel = 64;
    RenderOptions direct;
    direct.columns = direct.rows = size_px;
    direct.gather_rays = 64;
    direct.indirect = Indirect::None;
    radiosity::SolveOptions solve;
    solve.patch_edge_m = 0.25;
    solve.form_factor_rays = 16;
    paths.seed = direct.seed = solve.seed = k + 1;
    const radiosity::Solution solution = prepared.solve(solve);
    each[k] = {mean_green(trace_paths(prepared, camera, paths).image),
               mean_green(render(prepared, solution, camera, direct).image),
               solution.report.objects[0].radiosity_lm_m2.g};
    for (std::size_t way = 0; way < ways; ++way) found.mean[way] += each[k][way] / double(seeds);
  }
  for (std::size_t way = 0; way < ways; ++way) {
    double squares = 0.0;
    for (const auto& one : each) squares += std::pow(one[way] - found.mean[way], 2);
    found.standard_error[way] = std::sqrt(squares / double(seeds * (seeds - 1)));
  }
  return found;
}

void expect_same(const Found& found, const Found& wanted) {
  for (std::size_t way = 0; way < ways; ++way) {
    const double standard_error = std::hypot(found.standard_error[way], wanted.standard_error[way]);
    EXPECT_NEAR(found.mean[way], wanted.mean[way], 4.0 * standard_error) << way;
    EXPECT_LT(4.0 * standard_error, 0.05 * wanted.mean[way]) << way;
  }
}

TEST(NearEmitter, SendsAsMuchInALargeSceneAndThroughPanesAsInASmallOne) {
  const Found bare = light_of(Hall(0.1, 0).scene, beside());
  for (const auto& [width_m, panes] :
       {std::pair{20.0, 0}, std::pair{0.1, 1}, std::pair{0.1, 3}, std::pair{20.0, 2}}) {
    const Found other = light_of(Hall(width_m, panes).scene, beside());
    SCOPED_TRACE(testing::Message() << width_m << " m, panes " << panes);
    expect_same(other, bare);
  }
}

// A square that shines down on a mirror lights the ceiling 20 cm beside it like its image below
// without the mirror. The ceiling is dark, because the mirror shows it, too; the scene is so large
// that shadow rays sample the square.
TEST(NearEmitter, AMirrorThrowsWhatTheImageWouldSend) {
  const auto made = [](bool mirrored) {
    tests::SceneBuilder builder;
    builder.quad(builder.material(tests::grey(0.001)), {.3, -.1, .1}, {.3, .1, .1}, {.5, .1, .1},
                 {.5, -.1, .1});
    const std::uint32_t lit = builder.material(tests::grey(0.0, 100.0));
    builder.plate(lit, 0.2, mirrored ? 0.1 : -0.1, !mirrored);
    scenes::Material mirror = tests::grey(0.0);
    mirror.mirror = Rgb(1.0);
    if (mirrored) builder.plate(builder.material(mirror), 1.0, 0.0, true);
    builder.plate(builder.material(tests::grey(0.0)), 20.0, -0.2, true);
    return builder.scene;
  };
  scenes::Camera camera;
  camera.position = Vec3(0.4, 0.0, 0.02);
  camera.look_at = Vec3(0.4, 0.0, 0.1);
  camera.up = Vec3(0, 1, 0);
  camera.fov_deg = 50.0;
  expect_same(light_of(made(true), camera), light_of(made(false), camera));
}

}  // namespace
}  // namespace earthshine::raytrace
