// SPDX-License-Identifier: Apache-2.0
// Bright patches behind glass: gather rays and paths are aimed at them through it.
#include <gtest/gtest.h>

#include <cmath>

#include "raytrace/render.h"
#include "tests/raytrace/path_picture.h"

namespace earthshine::raytrace {
namespace {

constexpr int edge_px = 16, pictures = 8;

// A bare lamp above the floor of a closed room, and panes from 5 cm above it on, each from wall to
// wall.
scenes::Scene lit_floor(double lamp_m, const scenes::Material& pane, int panes) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.room({m, m, m, m, m, m});
  const std::uint32_t glass = builder.material(pane);
  for (int k = 0; k < panes; ++k) {
    const double z = 0.05 + 0.02 * k;
    builder.quad(glass, {0, 0, z}, {1, 0, z}, {1, 1, z}, {0, 1, z});
  }
  scenes::Lamp lamp;
  lamp.name = lamp.group = "lamp";
  lamp.kind = scenes::LampKind::Point;
  lamp.position = Vec3(0.4, 0.6, lamp_m);
  lamp.intensity_cd = Rgb(100.0);
  builder.scene.lamps.push_back(lamp);
  return builder.scene;
}

// Above the panes; sees neither them nor the floor.
scenes::Camera upward() {
  scenes::Camera camera;
  camera.position = Vec3(0.1, 0.2, 0.4);
  camera.look_at = Vec3(0.9, 0.8, 0.8);
  camera.fov_deg = 60.0;
  return camera;
}

struct Mean {
  double mean = 0.0, standard_error = 0.0;
};

// Mean over all pixels, of pictures with different seeds.
template <class Draw>
Mean mean_of(const Draw& draw) {
  std::vector<double> means;
  for (std::uint64_t seed = 1; seed <= pictures; ++seed) {
    const base::Image image = draw(seed);
    double sum = 0.0;
    for (const float v : image.find("G")->values) sum += double(v) / (edge_px * edge_px);
    means.push_back(sum);
  }
  Mean all;
  for (const double one : means) all.mean += one / pictures;
  for (const double one : means) all.standard_error += (one - all.mean) * (one - all.mean);
  all.standard_error = std::sqrt(all.standard_error / (pictures - 1.0) / pictures);
  return all;
}

struct Solved {
  explicit Solved(const scenes::Scene& scene) : prepared(scene) {
    radiosity::SolveOptions solve;
    solve.form_factor_rays = 256;
    solve.patch_edge_m = 0.002;
    solve.refine.start_edge_m = 0.25;
    solve.refine.on = true;
    solve.refine.max_patches = 3000;
    solution = prepared.solve(solve);
  }
  // With the solution times a factor: the residual compensates any error of the solution.
  [[nodiscard]] Mean gathered(double factor, bool denoise) const {
    radiosity::Solution scaled = solution;
    for (auto* values : {&scaled.radiosity, &scaled.indirect_radiosity}) {
      for (float& value : *values) value *= static_cast<float>(factor);
    }
    return mean_of([&](std::uint64_t seed) {
      RenderOptions options;
      options.columns = options.rows = edge_px;
      options.gather_rays = 256;
      options.denoise = denoise;
      options.seed = seed;
      return render(prepared, scaled, upward(), options).image;
    });
  }
  tests::Prepared prepared;
  radiosity::Solution solution;
};

// With and without denoising, and for any factor on the solution.
void expect_same_picture(const scenes::Scene& scene, const Mean& wanted) {
  const Solved solved(scene);
  for (const bool denoise : {false, true}) {
    for (const double factor : {1.0, 0.25}) {
      SCOPED_TRACE(testing::Message() << "denoising " << denoise << ", " << factor);
      const Mean found = solved.gathered(factor, denoise);
      const double standard_error = std::hypot(found.standard_error, wanted.standard_error);
      EXPECT_NEAR(found.mean, wanted.mean, 4.0 * standard_error);
      EXPECT_LT(4.0 * standard_error, 0.05 * wanted.mean);
    }
  }
}

// The lamp is 0.1 mm above the floor: half of its light lands on a spot that random rays miss.
TEST(BehindGlass, PanesThatLetAllThroughChangeNoPicture) {
  const scenes::Material clear = sheet(0.0, 0.0, 1.0);
  const Mean bare = Solved(lit_floor(1e-4, clear, 0)).gathered(1.0, false);
  for (const int panes : {1, 2}) expect_same_picture(lit_floor(1e-4, clear, panes), bare);
}

// The spot is 5 cm wide, so that paths find it, too, and the pane above it is bright itself.
TEST(BehindGlass, APaneThatDoesAllIsDrawnAsByAllPaths) {
  const scenes::Scene scene = lit_floor(0.03, sheet(0.2, 0.2, 0.5), 1);
  const tests::Prepared prepared(scene);
  expect_same_picture(scene, mean_of([&](std::uint64_t seed) {
                        PathOptions options;
                        options.columns = options.rows = edge_px;
                        options.paths_per_pixel = 1024;
                        options.paths = PathSet::NoCaustics;
                        options.seed = seed;
                        return trace_paths(prepared, upward(), options).image;
                      }));
}

// A dark closed room with a pane from wall to wall, in a bright box: rays that continue at the
// pane's edge must not start behind the wall.
TEST(BehindGlass, AtItsEdgeNothingLeaksIntoAClosedRoom) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.room({m, m, m, m, m, m});
  const std::uint32_t glass = builder.material(sheet(0.0, 0.0, 1.0));
  builder.quad(glass, {0, 0, .5}, {1, 0, .5}, {1, 1, .5}, {0, 1, .5});
  const std::uint32_t bright = builder.material(tests::grey(0.5, 1e6));
  const double a = -0.5, b = 1.5;
  builder.quad(bright, {a, a, a}, {a, b, a}, {a, b, b}, {a, a, b});
  builder.quad(bright, {b, a, a}, {b, a, b}, {b, b, b}, {b, b, a});
  builder.quad(bright, {a, a, a}, {a, a, b}, {b, a, b}, {b, a, a});
  builder.quad(bright, {a, b, a}, {b, b, a}, {b, b, b}, {a, b, b});
  const Solved solved(builder.scene);
  for (const bool denoise : {false, true}) EXPECT_EQ(solved.gathered(1.0, denoise).mean, 0.0);
}

// An upright panel that lights a floor: perfectly transparent panes, seen at any angle, leave the
// light on the floor unchanged.
TEST(BehindGlass, PanesBeforeAnEmitterChangeNoDirectLight) {
  const auto mean = [](int panes) {
    tests::SceneBuilder builder;
    builder.plate(builder.material(tests::grey(0.5)), 1.0, 0.0, true);
    const std::uint32_t lit = builder.material(tests::grey(0.0, 100.0));
    builder.quad(lit, {.6, -.1, .1}, {.6, -.1, .3}, {.6, .1, .3}, {.6, .1, .1});
    const std::uint32_t glass = builder.material(sheet(0.0, 0.0, 1.0));
    for (int k = 0; k < panes; ++k) {
      const double z = 0.02 + 0.01 * k;
      builder.quad(glass, {-1, -1, z}, {1, -1, z}, {1, 1, z}, {-1, 1, z});
    }
    const scenes::Scene scene = builder.scene;
    const tests::Prepared prepared(scene);
    scenes::Camera camera;
    camera.position = Vec3(0, 0, 1);
    camera.look_at = Vec3(0.0);
    camera.up = Vec3(0, 1, 0);
    camera.fov_deg = 40.0;
    return mean_of([&](std::uint64_t seed) {
      PathOptions options;
      options.columns = options.rows = edge_px;
      options.paths_per_pixel = 64;
      options.seed = seed;
      return trace_paths(prepared, camera, options).image;
    });
  };
  const Mean bare = mean(0);
  EXPECT_GT(bare.mean, 0.0);
  for (const int panes : {1, 3}) {
    const Mean found = mean(panes);
    EXPECT_NEAR(found.mean, bare.mean, 4.0 * std::hypot(found.standard_error, bare.standard_error));
  }
}

}  // namespace
}  // namespace earthshine::raytrace
