// SPDX-License-Identifier: Apache-2.0
// Pictures drawn for several weighted sums of their layers.
#include "raytrace/adaptive/sum_errors.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "raytrace/render.h"
#include "tests/support/scene_builder.h"

namespace earthshine::raytrace {
namespace {

// A lamp, and one of 1.5 % of its light behind a plate. The error of the sum of both says little
// about the weak one. With both layers as sums each of them has the error, and so has the sum of
// all layers.
TEST(SumErrors, EachSumHasTheError) {
  tests::SceneBuilder builder;
  const std::uint32_t grey = builder.material(tests::grey(0.5));
  builder.room({grey, grey, grey, grey, grey, grey});
  builder.plate(grey, 0.3, 0.4, true);
  for (const double x : {0.3, 0.8}) {
    scenes::Lamp lamp;
    lamp.name = lamp.group = x < 0.5 ? "left" : "right";
    lamp.kind = scenes::LampKind::Disk;
    lamp.position = Vec3(x, 0.6, 0.8);
    lamp.axis = Vec3(0, 0, -1);
    lamp.radius_m = 0.1;
    lamp.exitance = Rgb(x < 0.5 ? 1000.0 : 15.0);
    builder.scene.lamps.push_back(lamp);
  }
  scenes::Camera camera;
  camera.position = Vec3(0.95, 0.9, 0.5);
  camera.look_at = Vec3(0.3, 0.4, 0.1);
  camera.fov_deg = 60.0;
  const tests::Prepared prepared(builder.scene);
  radiosity::SolveOptions solve;
  solve.patch_edge_m = 0.5;
  solve.form_factor_rays = 64;
  const radiosity::Solution solution = prepared.solve(solve);
  const std::array<std::array<double, 2>, 3> each = {{{1.0, 0.0}, {0.0, 1.0}, {1.0, 1.0}}};
  const auto drawn = [&](const std::vector<std::vector<double>>& sums) {
    RenderOptions options;
    options.columns = options.rows = 64;
    options.error = 0.01;
    options.per_light = true;
    options.sums = sums;
    return render(prepared, solution, camera, options).layers;
  };
  const LayerErrors alone = drawn({});
  EXPECT_LE(alone.of(each[2])->relative(), 0.01);
  EXPECT_GT(alone.of(each[1])->relative(), 0.011);
  const LayerErrors listed = drawn({{1.0, 0.0}, {0.0, 1.0}});
  for (const auto& weights : each) EXPECT_LE(listed.of(weights)->relative(), 0.01);
}

}  // namespace
}  // namespace earthshine::raytrace
