// SPDX-License-Identifier: Apache-2.0
// Face clusters make a solution coarse but leave pictures correct. Pictures by a solution on
// clusters, by a solution on triangles and by paths have one mean, within four standard errors of
// pictures with different seeds. The room's only lamp is just above a fine sphere and shines down,
// so that most light comes from a small bright part of the sphere, which aimed rays sample.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "radiosity/patches/clusters.h"
#include "raytrace/incoming/incoming_light.h"
#include "raytrace/paths/path_tracer.h"
#include "raytrace/render.h"
#include "tests/support/fine_meshes.h"

namespace earthshine {
namespace {

constexpr int edge_px = 20, pictures = 10;

struct Mean {
  double mean = 0.0, standard_error = 0.0;
};

template <class Draw>
Mean mean_of(const Draw& draw) {
  std::vector<double> found;
  for (std::uint64_t seed = 1; seed <= pictures; ++seed) {
    const std::vector<float> y = base::luminance_of(draw(seed));
    double sum = 0.0;
    for (const float v : y) sum += double(v) / double(y.size());
    found.push_back(sum);
  }
  Mean mean;
  for (const double one : found) mean.mean += one / pictures;
  double squares = 0.0;
  for (const double one : found) squares += std::pow(one - mean.mean, 2);
  mean.standard_error = std::sqrt(squares / (pictures - 1.0) / pictures);
  return mean;
}

TEST(ClusterLaw, PicturesAreThoseOfTheTriangles) {
  tests::SceneBuilder builder;
  const std::uint32_t wall = builder.material(tests::grey(0.6)),
                      ball = builder.material(tests::grey(0.8));
  builder.room({wall, wall, wall, wall, wall, wall});
  tests::fine_sphere(builder, ball, {0.5, 0.5, 0.3}, 0.2, 40);
  tests::fine_wall(builder, ball, {0.75, 0.1, 0.1}, {0.1, 0, 0}, {0, 0.8, 0.6}, 20);
  scenes::Lamp lamp;
  lamp.name = lamp.group = "lamp";
  lamp.kind = scenes::LampKind::Spot;
  lamp.position = {0.5, 0.45, 0.56};
  lamp.axis = {0, 0, -1};
  lamp.beam_deg = 60;
  lamp.field_deg = 120;
  lamp.intensity_cd = Rgb(100.0);
  builder.scene.lamps.push_back(lamp);
  scenes::Camera camera;
  camera.position = Vec3(0.05, 0.1, 0.35);
  camera.look_at = Vec3(1.0, 0.6, 0.3);
  camera.fov_deg = 70;
  const tests::Prepared prepared(builder.scene);
  radiosity::SolveOptions options;
  options.form_factor_rays = 64;
  options.patch_edge_m = 0.25;
  const radiosity::Solution clusters = prepared.solve(options);
  ASSERT_NE(clusters.patches.clustered, nullptr);
  ASSERT_LT(clusters.patches.count(), 3000U);
  ASSERT_FALSE(raytrace::BrightPatches(clusters).empty());
  const radiosity::Solution triangles =
      radiosity::solve(prepared, options, radiosity::subdivide(builder.scene, 0.25));
  ASSERT_GT(triangles.patches.count(), 6000U);

  const auto drawn = [&](const radiosity::Solution& solution, bool denoise) {
    return mean_of([&](std::uint64_t seed) {
      raytrace::RenderOptions how;
      how.columns = how.rows = edge_px;
      how.gather_rays = 64;
      how.denoise = denoise;
      how.seed = seed;
      return raytrace::render(prepared, solution, camera, how).image;
    });
  };
  const Mean truth = mean_of([&](std::uint64_t seed) {
    raytrace::PathOptions how;
    how.columns = how.rows = edge_px;
    how.paths_per_pixel = 256;
    how.paths = raytrace::PathSet::NoCaustics;
    how.seed = seed;
    return raytrace::trace_paths(prepared, camera, how).image;
  });
  for (const bool denoise : {true, false}) {
    const Mean coarse = drawn(clusters, denoise), fine = drawn(triangles, denoise);
    for (const Mean& other : {fine, truth}) {
      const double error = std::hypot(coarse.standard_error, other.standard_error);
      EXPECT_NEAR(coarse.mean, other.mean, 4.0 * error) << "denoising " << denoise;
      EXPECT_LT(error, 0.025 * other.mean);
    }
  }
}

}  // namespace
}  // namespace earthshine
