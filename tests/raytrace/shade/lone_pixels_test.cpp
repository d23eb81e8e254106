// SPDX-License-Identifier: Apache-2.0
// Lone pixels: a sliver of a surface in a pixel has the light of the surface beside it, and
// surfaces in mirrors are denoised like directly visible ones.
#include <gtest/gtest.h>

#include "raytrace/render.h"
#include "tests/support/scene_builder.h"

namespace earthshine::raytrace {
namespace {

// A room whose surfaces emit 1 - rho and reflect rho: B = 1 and L = 1 / pi everywhere, for any
// view, so that edges add no scatter.
tests::SceneBuilder furnace(const scenes::Material& left_wall) {
  tests::SceneBuilder builder;
  const std::uint32_t wall = builder.material(tests::grey(0.6, 0.4));
  builder.room({builder.material(left_wall), wall, wall, wall, wall, wall});
  return builder;
}

// Half of the solution is left to paths. A sample without a gather point follows one path, which
// estimates that half with a relative standard deviation of about 1: a pixel of four such samples
// would have an error of 0.5 / sqrt(4), 25 %. Means over a surface have an error of half a per
// cent.
void expect_no_lone_pixels(const scenes::Scene& scene, const Vec3& look_at) {
  const tests::Prepared prepared(scene);
  radiosity::SolveOptions solve;
  solve.patch_edge_m = 0.25;
  solve.form_factor_rays = 64;
  radiosity::Solution solution = prepared.solve(solve);
  for (auto* values : {&solution.radiosity, &solution.indirect_radiosity}) {
    for (float& value : *values) value *= 0.5F;
  }
  scenes::Camera camera;
  camera.name = "door";
  camera.position = Vec3(0.5, 0.95, 0.5);
  camera.look_at = look_at;
  camera.fov_deg = 60.0;
  RenderOptions options;
  options.columns = options.rows = 96;
  options.gather_rays = 32;
  options.camera_samples = 4;
  const Frame frame = render(prepared, solution, camera, options);
  for (const float v : frame.image.find("G")->values) {
    EXPECT_NEAR(double(v) * base::pi, 1.0, 0.12);
  }
}

TEST(LonePixels, EdgesHaveNone) {
  tests::SceneBuilder builder = furnace(tests::grey(0.6, 0.4));
  scenes::Material sheet = tests::grey(0.6, 0.4);
  sheet.two_sided = true;
  const std::uint32_t bar = builder.material(sheet);
  for (int k = 0; k < 5; ++k) {
    const double x = 0.25 + 0.1 * k, lean = 0.013 * (k + 1);
    builder.quad(bar, {x, 0.3, 0.2}, {x + 0.04, 0.3, 0.2}, {x + 0.04 + lean, 0.3, 0.8},
                 {x + lean, 0.3, 0.8});
  }
  expect_no_lone_pixels(builder.scene, Vec3(0.5, 0.3, 0.5));
}

TEST(LonePixels, MirrorsShowNone) {
  scenes::Material mirror = tests::grey(0.05, 0.05);
  mirror.mirror = Rgb(0.9);
  expect_no_lone_pixels(furnace(mirror).scene, Vec3(0.0, 0.3, 0.5));
}

}  // namespace
}  // namespace earthshine::raytrace
