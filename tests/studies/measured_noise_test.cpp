// SPDX-License-Identifier: Apache-2.0
#include "studies/measured_noise.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/studies/normal.h"
#include "tests/studies/plates.h"
#include "tests/studies/room.h"

namespace earthshine::studies {
namespace {

raytrace::RenderOptions small_picture() {
  raytrace::RenderOptions options;
  options.columns = 24;
  options.rows = 20;
  options.gather_rays = 16;
  options.shared.on = true;
  options.shared.noise = 0.05;
  return options;
}

// What measure_noise() says, in (cd/m^2)^2, with the standard error that its bound tells of.
struct Found {
  MeasuredNoise noise;
  double squared = 0.0, error = 0.0, luminance = 0.0;
};

struct Bench {
  const tests::SmallRoom& room = tests::small_room();
  raytrace::RenderOptions options = small_picture();
  SurfacePixels seen{room.study(), room.camera, options};
  raytrace::Frame frame = room.picture(options);

  Bench() { frame.report.rays.camera += 6'000'000; }  // of a picture that pays 400 looks

  [[nodiscard]] Found measure(const raytrace::Frame& changed) const {
    Found found;
    found.noise =
        measure_noise(room.study(), room.solution, {&room.camera, options}, changed, seen);
    found.luminance = pixel_means(changed, seen, seen.all()).luminance;
    const Doubt all = found.noise.gather + found.noise.lamps + found.noise.camera;
    const double squares = found.luminance * found.luminance;
    found.squared = squares * all.estimate * all.estimate;
    found.error = (squares * all.bound_95 * all.bound_95 - found.squared) / 1.645;
    return found;
  }
};

const Bench& bench() {
  static const Bench made;
  return made;
}

TEST(MeasuredNoise, FindsNoiseAndBiasThatWereAdded) {
  // (L + d - O1)(L + d - O2) has the mean of L's own squared error and of d^2; d and the error of
  // L know nothing of each other.
  const Found own = bench().measure(bench().frame);
  const double sigma = 0.2 * own.luminance, bias = 0.1 * own.luminance;
  for (const auto& [noisy, off] : {std::pair{1.0, 0.0}, {0.0, 1.0}, {0.0, -1.0}, {1.0, 1.0}}) {
    raytrace::Frame changed = bench().frame;
    tests::Normal normal(3);
    double added = 0.0;
    for (std::size_t p = 0; p < changed.image.pixel_count(); ++p) {
      const double d = noisy * sigma * normal.next() + off * bias;
      for (int c = 0; c < 3; ++c) changed.image.channels[c].values[p] += static_cast<float>(d);
      added += d * d / double(changed.image.pixel_count());
    }
    const Found found = bench().measure(changed);
    EXPECT_NEAR(found.squared, own.squared + added, 4.0 * std::hypot(found.error, own.error))
        << noisy << off;
    EXPECT_LT(found.error, 0.2 * found.squared);  // or there would be nothing to see
    EXPECT_GE(found.noise.correction.bound_95, found.noise.correction.estimate);
  }
}

TEST(MeasuredNoise, OfAnExactPictureIsNone) {
  // Sixteen times the samples of the closer looks leave nothing that these could see.
  raytrace::RenderOptions options = small_picture();
  options.shared.on = false;
  options.gather_rays = 1 << 13;
  options.seed = 77;
  raytrace::Frame exact = bench().room.picture(options);
  exact.report.rays.camera += 6'000'000;
  const Found found = bench().measure(exact), own = bench().measure(bench().frame);
  EXPECT_LT(found.squared, 4.0 * found.error + 1e-4 * own.luminance * own.luminance);
  EXPECT_LT(found.squared, 0.3 * own.squared);
}

TEST(MeasuredNoise, CorrectsAPictureThatStatesTheWrongError) {
  // The same pixels are looked at, and the error is the same: three times as much stated is
  // corrected by a third.
  const Found right = bench().measure(bench().frame);
  raytrace::Frame boastful = bench().frame;
  for (float& square : boastful.squared_error) {
    if (square != raytrace::shows_source) square *= 9.0F;
  }
  const Found wrong = bench().measure(boastful);
  EXPECT_NEAR(wrong.noise.correction.estimate / right.noise.correction.estimate, 1.0 / 3.0, 1e-4);
  EXPECT_NEAR(wrong.noise.correction.bound_95 / right.noise.correction.bound_95, 1.0 / 3.0, 1e-4);
  EXPECT_NEAR(wrong.squared / right.squared, 1.0, 1e-4);
}

TEST(MeasuredNoise, IsSharedOutByCause) {
  const Found found = bench().measure(bench().frame);
  const raytrace::RenderReport& report = bench().frame.report;
  const double all = std::sqrt(found.squared) / found.luminance;
  EXPECT_NEAR(found.noise.gather.estimate / all, report.gather_noise / report.relative_noise, 1e-6);
  EXPECT_GT(found.noise.lamps.estimate, 0.0);
  EXPECT_GT(found.noise.camera.estimate, 0.0);
  EXPECT_EQ(found.noise.pixels,
            pixel_means(bench().frame, bench().seen, bench().seen.all()).pixels);
  EXPECT_GT(found.noise.rays, 1000U);
}

TEST(MeasuredNoise, OfPathsIsWhatTheyState) {
  raytrace::Frame paths = bench().frame;
  paths.squared_error.clear();
  paths.report.relative_noise = 0.03;
  const MeasuredNoise noise = bench().measure(paths).noise;
  EXPECT_EQ(noise.camera.estimate, 0.03);
  EXPECT_GE(noise.camera.bound_95, 0.03);
  EXPECT_EQ(noise.gather.estimate + noise.lamps.estimate, 0.0);
  EXPECT_EQ(noise.pixels, bench().seen.all().size());
  EXPECT_EQ(noise.rays, 0U);
  paths.report.relative_noise = 0.0;  // black
  EXPECT_EQ(bench().measure(paths).noise.pixels, 0U);
}

void expect_nothing(const MeasuredNoise& noise) {
  EXPECT_EQ(noise.pixels, 0U);
  EXPECT_EQ(noise.rays, 0U);
  EXPECT_EQ((noise.gather + noise.lamps + noise.camera).bound_95, 0.0);
  EXPECT_EQ(noise.correction.estimate, 1.0);
}

TEST(MeasuredNoise, BlackAndDazzledPicturesHaveNone) {
  raytrace::Frame black = bench().frame;
  for (base::Channel& channel : black.image.channels) {
    std::fill(channel.values.begin(), channel.values.end(), 0.0F);
  }
  expect_nothing(bench().measure(black).noise);
  raytrace::Frame sources = bench().frame;
  std::fill(sources.squared_error.begin(), sources.squared_error.end(), raytrace::shows_source);
  expect_nothing(bench().measure(sources).noise);
}

TEST(MeasuredNoise, SkyAloneHasNone) {
  const tests::SmallRoom& room = bench().room;
  scenes::Camera away = room.camera;
  away.position = Vec3(0, 0, 9);
  away.look_at = Vec3(0, 0, 99);
  away.up = Vec3(0, 1, 0);
  const raytrace::RenderOptions options = small_picture();
  const raytrace::Frame sky =
      raytrace::render(room.scene, room.prepared.groups, room.prepared.effects, room.prepared.query,
                       room.solution, away, options);
  const SurfacePixels none(room.study(), away, options);
  EXPECT_TRUE(none.all().empty());
  expect_nothing(measure_noise(room.study(), room.solution, {&away, options}, sky, none));
}

TEST(MeasuredNoise, OfOnePixelIsWhatItStates) {
  // Two looks are the fewest that tell of their own chance.
  const tests::SmallRoom& room = bench().room;
  raytrace::RenderOptions options = small_picture();
  options.columns = options.rows = 1;
  scenes::Camera close = room.camera;
  close.fov_deg = 5.0;
  const raytrace::Frame frame =
      raytrace::render(room.scene, room.prepared.groups, room.prepared.effects, room.prepared.query,
                       room.solution, close, options);
  const SurfacePixels seen(room.study(), close, options);
  const MeasuredNoise noise =
      measure_noise(room.study(), room.solution, {&close, options}, frame, seen);
  EXPECT_EQ(noise.pixels, 1U);
  EXPECT_NEAR((noise.gather + noise.lamps + noise.camera).estimate, frame.report.relative_noise,
              1e-6 * frame.report.relative_noise);
  EXPECT_EQ(noise.correction.estimate, 1.0);
  EXPECT_GT(noise.correction.bound_95, 1.0);
}

TEST(PixelMeans, LeaveSourcesOut) {
  raytrace::Frame frame = bench().frame;
  const std::vector<std::uint32_t> two{bench().seen.all()[0], bench().seen.all()[1]};
  frame.squared_error[bench().seen.in_window(two[0])] = raytrace::shows_source;
  frame.squared_error[bench().seen.in_window(two[1])] = 4.0F;
  for (int c = 0; c < 3; ++c) {
    frame.image.channels[c].values[bench().seen.in_window(two[0])] = 100.0F;
    frame.image.channels[c].values[bench().seen.in_window(two[1])] = 7.0F;
  }
  const PixelMeans means = pixel_means(frame, bench().seen, two);
  EXPECT_EQ(means.pixels, 1U);
  EXPECT_NEAR(means.luminance, 7.0, 1e-6);
  EXPECT_EQ(means.squared_error, 4.0);
  EXPECT_EQ(pixel_means(frame, bench().seen, {}).pixels, 0U);
}

}  // namespace
}  // namespace earthshine::studies
