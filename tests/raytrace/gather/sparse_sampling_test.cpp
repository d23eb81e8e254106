// SPDX-License-Identifier: Apache-2.0
// Sampling after a stop that leaves no time for the initial sampling.
#include <gtest/gtest.h>

#include "raytrace/render.h"
#include "tests/support/scene_builder.h"

namespace earthshine::raytrace {
namespace {

TEST(QuickLook, SparesWhatIsSeenInMirrors) {
  // A furnace, rho 0.8 and M = 0.2, with one mirror wall: radiance 1 / pi in every pixel. All
  // points in the mirror are off-grid points. The sampled ones serve the others: each has four of
  // them among 7 x 7 pixels, so that about one in six is sampled, with at most a quarter of the
  // initial sampling's rays.
  tests::SceneBuilder builder;
  const std::uint32_t grey = builder.material(tests::grey(0.8, 0.2));
  scenes::Material silver = tests::grey(0.0);
  silver.mirror = Rgb(1.0);
  const std::uint32_t mirror = builder.material(silver);
  builder.room({grey, grey, mirror, grey, grey, grey});
  const tests::Prepared prepared(builder.scene);
  const radiosity::Solution solution = prepared.solve({});
  scenes::Camera camera;
  camera.position = Vec3(0.5, 0.9, 0.5);
  camera.look_at = Vec3(0.5, 0.0, 0.45);
  camera.fov_deg = 40.0;  // the mirror fills the picture
  RenderOptions options;
  options.columns = 96;
  options.rows = 80;
  options.error = 1.0;
  const auto gathered = [&](bool at_once) {
    options.stop = [at_once] { return at_once; };
    const Frame frame = render(prepared, solution, camera, options);
    for (const float v : frame.image.find("G")->values) EXPECT_NEAR(v * base::pi, 1.0, 1e-4);
    return static_cast<double>(frame.report.rays.gather);
  };
  EXPECT_LT(gathered(true), 0.25 * gathered(false));
}

}  // namespace
}  // namespace earthshine::raytrace
