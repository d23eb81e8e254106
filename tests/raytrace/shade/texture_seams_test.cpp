// SPDX-License-Identifier: Apache-2.0
// A texture with parts for different faces: no pixel of a face takes light from another part, and
// the stated error of a picture holds for texels of any size.
#include <gtest/gtest.h>

#include <cmath>

#include "raytrace/render.h"
#include "scenes/surface_texture.h"
#include "scenes/texture/texture.h"
#include "tests/support/scene_builder.h"

namespace earthshine::raytrace {
namespace {

constexpr int atlas_edge = 256, seams_edge_px = 24;

// grey(x, y) of a square picture.
template <class Grey>
std::shared_ptr<const scenes::Texture> texture(const Grey& grey) {
  base::Pixels pixels{atlas_edge, atlas_edge, {}};
  for (int y = 0; y < atlas_edge; ++y) {
    for (int x = 0; x < atlas_edge; ++x) {
      for (int c = 0; c < 3; ++c) pixels.rgba.push_back(static_cast<std::uint8_t>(grey(x, y)));
      pixels.rgba.push_back(255);
    }
  }
  scenes::TextureReading plain;
  plain.is_srgb = false;
  return std::make_shared<const scenes::Texture>(pixels, plain);
}

// A quad across the view from (-0.5, -0.5) to (0.5, 0.5) with the rectangle from `low` to `high` of
// the texture, lit by a Sun behind the camera.
scenes::Scene worn(const std::shared_ptr<const scenes::Texture>& picture, bool emits,
                   const glm::vec2& low, const glm::vec2& high) {
  scenes::Material material = tests::grey(emits ? 0.0 : 0.8, emits ? 1000.0 : 0.0);
  scenes::MaterialMaps maps;
  scenes::TextureMap& map = emits ? maps.emit : maps.diffuse;
  map.texture = picture;
  map.transform = std::make_shared<const scenes::TextureTransform>();
  material.maps = std::make_shared<const scenes::MaterialMaps>(maps);
  tests::SceneBuilder builder;
  builder.quad(builder.material(material), {-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0.5, 0.5, 0},
               {-0.5, 0.5, 0});
  builder.scene.vertex_uv = {{low.x, high.y}, {high.x, high.y}, {high.x, low.y}, {low.x, low.y}};
  scenes::settle_textures(builder.scene);
  builder.scene.sun = scenes::Sun{Vec3(0, 0, 1), Rgb(1000.0), 0.0};
  return builder.scene;
}

Frame picture_of(const scenes::Scene& scene, double distance_m, double error, std::uint64_t seed,
                 double time_limit_s = 0.0) {
  scenes::Camera camera;
  camera.position = Vec3(0.0, 0.0, distance_m);
  camera.look_at = Vec3(0.0);
  camera.up = Vec3(0.3, 1.0, 0.0);
  camera.fov_deg = 30.0;
  const tests::Prepared prepared(scene);
  radiosity::SolveOptions solve;
  solve.patch_edge_m = 0.5;
  RenderOptions options;
  options.columns = options.rows = seams_edge_px;
  options.error = error;
  options.seed = seed;
  options.time_limit_s = time_limit_s;
  return render(prepared, prepared.solve(solve), camera, options);
}

// The left half is 0.6, the right half black; the quad has the left half up to the last texel.
TEST(TextureSeams, NoPixelTakesLightFromTheOtherSideOfASeam) {
  const auto halves = texture([](int x, int) { return x < atlas_edge / 2 ? 153 : 0; });
  const float last = 0.5F - 0.5F / atlas_edge;
  for (const bool emits : {true, false}) {
    // The quad fills the view, extending beyond every pixel; then from afar, 10 pixels wide.
    const scenes::Scene near = worn(halves, emits, {0.002F, 0.0F}, {last, 1.0F});
    const double expected = (emits ? 1000.0 * 0.6 : 0.8 * 0.6 * 1000.0) / base::pi;
    for (const double distance_m : {0.9, 4.5}) {
      const Frame frame = picture_of(near, distance_m, 0.05, 1);
      double brightest = 0.0, middle = 0.0;
      const auto& light = frame.image.find("G")->values;
      for (const float value : light) brightest = std::max(brightest, double(value));
      middle = double(light[seams_edge_px / 2 * seams_edge_px + seams_edge_px / 2]);
      EXPECT_NEAR(brightest, expected, 2e-3 * expected) << emits << distance_m;
      EXPECT_NEAR(middle, expected, 2e-3 * expected) << emits << distance_m;
      if (distance_m > 1.0) continue;
      for (const float value : light) EXPECT_NEAR(double(value), expected, 2e-3 * expected);
    }
  }
}

// Squares of the texture far smaller than a pixel, and another part along the seam.
scenes::Scene fine_squares() {
  const auto atlas = texture([](int x, int y) {
    if (x >= atlas_edge / 2) return 255;
    return (x / 3 + y / 5) % 2 == 0 ? 40 : 160;
  });
  return worn(atlas, false, {0.002F, 0.0F}, {0.498F, 1.0F});
}

struct FoundAndStated {
  double found = 0.0, stated = 0.0;  // RMS over the mean luminance
};

FoundAndStated both_errors(const scenes::Scene& scene, double error, double time_limit_s) {
  constexpr int seeds = 8;
  const Frame fine = picture_of(scene, 1.6, 0.002, 99);
  const std::vector<float>& truth = fine.image.find("G")->values;
  double mean = 0.0, pixels = 0.0, squares = 0.0, stated = 0.0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const Frame frame = picture_of(scene, 1.6, error, seed, time_limit_s);
    stated += add_up(frame.error).squared_error() / seeds;
    const std::vector<float>& light = frame.image.find("G")->values;
    for (std::size_t p = 0; p < truth.size(); ++p) {
      if (truth[p] <= 0.0F) continue;
      mean += double(truth[p]) / seeds;
      pixels += 1.0 / seeds;
      squares += std::pow(double(light[p] - truth[p]), 2) / seeds;
    }
  }
  mean /= pixels;
  return {std::sqrt(squares / pixels) / mean, std::sqrt(stated)};
}

TEST(TextureSeams, StatedErrorHoldsForTexelsMuchSmallerThanPixels) {
  const scenes::Scene scene = fine_squares();
  for (const double error : {0.05, 0.01}) {
    const FoundAndStated errors = both_errors(scene, error, 0.0);
    EXPECT_LT(errors.found, 1.15 * errors.stated) << error;
    EXPECT_LT(errors.stated, error) << error;
  }
}

// With an expired time limit, three of four pixels have a single sample, which states no error; the
// fourth pixel states it.
TEST(TextureSeams, StatedErrorHoldsWhereTimeIsUpAtOnce) {
  const FoundAndStated errors = both_errors(fine_squares(), 0.0, 1e-6);
  EXPECT_GT(errors.found, 0.2);
  EXPECT_LT(errors.found, 1.15 * errors.stated);
  EXPECT_GT(errors.found, 0.7 * errors.stated);
}

}  // namespace
}  // namespace earthshine::raytrace
