// SPDX-License-Identifier: Apache-2.0
// Pictures stopped before any sample, and pictures after an interrupted solve.
#include <gtest/gtest.h>

#include <cmath>

#include "raytrace/error_budget.h"
#include "raytrace/paths/path_tracer.h"
#include "studies/picture_error.h"
#include "tests/studies/room.h"

namespace earthshine::studies {
namespace {

using tests::small_room;

constexpr int size_px = 64;

raytrace::RenderOptions small_picture(std::uint64_t seed) {
  raytrace::RenderOptions options;
  options.columns = options.rows = size_px;
  options.error = 0.03;
  options.seed = seed;
  return options;
}

NoisyPicture traced(std::uint64_t seed) {
  raytrace::PathOptions options;
  options.columns = options.rows = size_px;
  options.paths_per_pixel = 256;
  options.seed = seed;
  const raytrace::Frame frame =
      raytrace::trace_paths(small_room().prepared, small_room().camera, options);
  NoisyPicture picture;
  for (const float y : base::luminance_of(frame.image)) picture.luminance.push_back(double(y));
  for (const float v : frame.image.find("variance")->values) picture.variance.push_back(double(v));
  return picture;
}

const ReferencePair& truth() {
  static const ReferencePair pair{traced(11), traced(12)};
  return pair;
}

struct Found {
  PictureError true_error;
  raytrace::ErrorEstimate stated;
  std::size_t dark = 0;  // pixels with a surface and without light
};

Found draw(const radiosity::Solution& solution, const raytrace::RenderOptions& options) {
  const tests::SmallRoom& room = small_room();
  const raytrace::Frame frame = raytrace::render(room.prepared, solution, room.camera, options);
  const std::vector<bool> counted = frame.error.counted();
  const std::vector<float> luminance = base::luminance_of(frame.image);
  Found found{picture_error(luminance, truth(), counted),
              raytrace::error_budget(room.study(), {&room.camera, options}, frame).total};
  for (std::size_t p = 0; p < luminance.size(); ++p) {
    found.dark += counted[p] && luminance[p] <= 0.0F ? 1 : 0;
  }
  return found;
}

// Pictures add the residual of their solution. Without a solution this is all interreflection,
// nearly half of the light in this room. The wanted error is stated and is true.
TEST(StoppedPicture, WithoutASolutionItHasTheSameLight) {
  const scenes::World world = small_room().study();
  double bias = 0.0;
  constexpr int pictures = 4;
  for (std::uint64_t seed = 1; seed <= pictures; ++seed) {
    const Found found = draw(radiosity::unsolved(world.groups), small_picture(seed));
    EXPECT_LE(found.stated.estimate, 0.03);
    EXPECT_LT(found.true_error.low, 1.5 * found.stated.bound_95) << seed;
    bias += found.true_error.bias / pictures;
  }
  // The means of a picture and of the references are far more accurate than their pixels.
  EXPECT_NEAR(bias, 0.0, 0.01);
}

// A picture stopped before its first sample has one sample of each kind for 25 pixels of a surface.
// Every pixel has light, and the mean is right. The stated error is 0.8 to 1.5 times the true one,
// the goal for pictures (docs/accuracy.md): root mean square of 128 pictures of each kind.
TEST(StoppedPicture, AtOnceItStatesWhatItIsOffBy) {
  const scenes::World world = small_room().study();
  for (const bool solved : {true, false}) {
    double true_square = 0.0, stated_square = 0.0, bias = 0.0;
    constexpr int pictures = 128;
    for (std::uint64_t seed = 1; seed <= pictures; ++seed) {
      raytrace::RenderOptions options = small_picture(seed);
      options.stop = [] { return true; };
      const Found found =
          draw(solved ? small_room().solution : radiosity::unsolved(world.groups), options);
      EXPECT_EQ(found.dark, 0U);
      true_square += std::pow(found.true_error.error, 2) / pictures;
      stated_square += std::pow(found.stated.estimate, 2) / pictures;
      bias += found.true_error.bias / pictures;
    }
    EXPECT_GT(stated_square, 0.05 * 0.05) << solved;  // it was stopped
    EXPECT_GT(std::sqrt(stated_square / true_square), 0.8) << solved;
    EXPECT_LT(std::sqrt(stated_square / true_square), 1.5) << solved;
    EXPECT_NEAR(bias, 0.0, 0.02) << solved;
  }
}

// Without denoising all gather points are sampled, and the stated error is as accurate.
TEST(StoppedPicture, WithoutDenoisingItStatesItsNoiseToo) {
  double true_square = 0.0, stated_square = 0.0;
  constexpr int pictures = 16;
  for (std::uint64_t seed = 1; seed <= pictures; ++seed) {
    raytrace::RenderOptions options = small_picture(seed);
    options.denoise = false;
    options.stop = [] { return true; };
    const Found found = draw(small_room().solution, options);
    true_square += std::pow(found.true_error.error, 2) / pictures;
    stated_square += std::pow(found.stated.estimate, 2) / pictures;
  }
  EXPECT_GT(std::sqrt(stated_square / true_square), 0.8);
  EXPECT_LT(std::sqrt(stated_square / true_square), 1.5);
}

}  // namespace
}  // namespace earthshine::studies
