// SPDX-License-Identifier: Apache-2.0
// The noise of means over resels: against the analytic twin of the whole picture, against the
// closed forms of the camera's noise, and against noisy frames.
#include <gtest/gtest.h>

#include <cmath>

#include "degrade/parts/transfer_law.h"
#include "degrade/settings/presets.h"
#include "degrade/twin.h"
#include "studies/sight/target_signal.h"
#include "tests/studies/discs.h"

namespace earthshine::studies {
namespace {

constexpr int side_px = 96;

std::vector<std::uint32_t> all_of(int columns, int rows) {
  std::vector<std::uint32_t> resels(static_cast<std::size_t>(columns) *
                                    static_cast<std::size_t>(rows));
  for (std::size_t i = 0; i < resels.size(); ++i) resels[i] = static_cast<std::uint32_t>(i);
  return resels;
}

// Dark, grey and bright discs, one cut by the border.
tests::DiscPicture busy_picture() {
  return tests::discs_on(50.0,
                         {{30.0, 30.0, 14.0, 90.0},
                          {70.0, 28.0, 9.0, 8.0},
                          {92.0, 75.0, 15.0, 160.0},
                          {30.0, 72.0, 6.0, 0.0}},
                         side_px, side_px);
}

degrade::Setup small_monitor(const degrade::Preset& preset) {
  degrade::Setup setup{preset.camera, preset.monitor, {}};
  setup.monitor.rows = side_px;
  setup.monitor.columns = side_px;
  return setup;
}

// Three pixels on two resels: the middle one covers parts of both.
TEST(SightNoise, PixelsCountInEachReselByTheirArea) {
  const WeightedResels middle = weigh({1}, 3, 1, 2, 1);
  ASSERT_EQ(middle.resel.size(), 2U);
  EXPECT_NEAR(middle.weight[0], 0.5, 1e-12);
  EXPECT_NEAR(middle.area, 2.0 / 3.0, 1e-12);
  const WeightedResels left = weigh({0, 1}, 3, 1, 2, 1);
  EXPECT_NEAR(left.weight[0], 0.75, 1e-12);
  EXPECT_NEAR(left.area, 4.0 / 3.0, 1e-12);
  EXPECT_NEAR(weigh({0}, 1, 1, 4, 3).area, 12.0, 1e-12);  // and the reverse
}

// Mean and variance of every resel, and the screen, as in the twin of the whole picture. Saturation
// changes the mean by less than its noise, and all presets clip below it.
TEST(SightNoise, EveryReselIsThatOfTheTwin) {
  const auto picture = busy_picture();
  for (const degrade::Preset& preset : degrade::presets()) {
    const degrade::Setup setup = small_monitor(preset);
    const CctvSignal line = pass_through(picture.image, setup);
    const std::vector<std::uint32_t> all = all_of(side_px, side_px);
    const ShownMoments moments = moments_at(line, all, all, 1);
    const degrade::Twin twin =
        degrade::twin(picture.image, setup.camera, setup.monitor, setup.options);
    const degrade::Plane mean = luminance_plane(twin.mean);
    for (std::size_t i = 0; i < all.size(); ++i) {
      double variance = 0.0;
      for (std::size_t p = 0; p < line.planes.size(); ++p) {
        variance += std::pow(line.luminance_share[p], 2.0) *
                    static_cast<double>(twin.variance.planes[p][i]);
      }
      ASSERT_NEAR(moments.mean[i], mean[i], 1e-4) << preset.name;
      ASSERT_NEAR(moments.variance[i], variance, 1e-3 * variance + 1e-9) << preset.name << " " << i;
      ASSERT_NEAR(moments.variance_in_time[i], moments.variance[i], 1e-5 * variance + 1e-12);
      EXPECT_EQ(twin.saturated[i] > 0.0F, line.level[i] >= 0.995F);
    }
    // A disc's light on the screen, with spread.
    const SightTarget& target = picture.plan.targets[0];
    const WeightedResels disc = weigh(target.view.measured, side_px, side_px, side_px, side_px);
    const degrade::Plane viewed = luminance_plane(twin.viewed_mean);
    const std::size_t step = static_cast<std::size_t>(setup.monitor.pixels_per_resel);
    double sum = 0.0;
    for (std::size_t k = 0; k < disc.resel.size(); ++k) {
      const std::size_t x = disc.resel[k] % side_px, y = disc.resel[k] / side_px;
      for (std::size_t j = 0; j < step * step; ++j) {
        sum += disc.weight[k] *
               static_cast<double>(
                   viewed[(y * step + j / step) * step * side_px + x * step + j % step]);
      }
    }
    EXPECT_NEAR(
        screen_mean(line, moments, screen_sources({line.spread_along, line.spread_across}, disc)),
        sum / static_cast<double>(step * step), 1e-4 * sum)
        << preset.name;
  }
}

// The twin's standard deviation of the difference of two boxes around one resel, from the
// covariances of all pairs. First-order noise only: within 1 % where clamps distort the noise.
TEST(SightNoise, DifferenceOfMeansScattersAsInTheTwin) {
  const auto picture = busy_picture();
  for (const degrade::Preset& preset : degrade::presets()) {
    const degrade::Setup setup = small_monitor(preset);
    const CctvSignal line = pass_through(picture.image, setup);
    const std::vector<std::uint32_t> all = all_of(side_px, side_px);
    const ShownMoments moments = moments_at(line, all, all, 1);
    const degrade::Twin twin =
        degrade::twin(picture.image, setup.camera, setup.monitor, setup.options);
    for (const auto& [cx, cy] :
         {std::pair{30, 30}, {44, 30}, {70, 28}, {90, 75}, {30, 72}, {3, 2}}) {
      std::vector<std::uint32_t> inside, around;
      for (int y = std::max(0, cy - 5); y <= std::min(side_px - 1, cy + 5); ++y) {
        for (int x = std::max(0, cx - 5); x <= std::min(side_px - 1, cx + 5); ++x) {
          const bool in = std::abs(x - cx) <= 2 && std::abs(y - cy) <= 2;
          (in ? inside : around).push_back(static_cast<std::uint32_t>(y * side_px + x));
        }
      }
      const MeanNoise noise =
          mean_noise(line, moments, weigh(inside, side_px, side_px, side_px, side_px),
                     weigh(around, side_px, side_px, side_px, side_px), 1);
      const double sigma = std::sqrt(noise.variance_a + noise.variance_b - 2.0 * noise.covariance);
      const double twins = twin.detection.noise[static_cast<std::size_t>(cy * side_px + cx)];
      EXPECT_NEAR(sigma, twins, 0.01 * twins + 1e-9) << preset.name << " " << cx << " " << cy;
    }
  }
}

// Flat field S = 0.5, linear camera: Var mean = sum over offsets of pairs(d) C(d) / N^2, with C of
// degrade/parts/transfer_law.h, which shares no code with the chain; 20 resels from the border.
TEST(SightNoise, FlatFieldsHaveTheNoiseOfTheClosedForms) {
  const auto picture = tests::discs_on(50.0, {{48.0, 48.0, 12.0, 50.0}}, side_px, side_px);
  degrade::Setup setup = tests::plain_cctv(side_px, side_px, 100.0);
  degrade::CctvCamera& camera = setup.camera;
  camera.noise = degrade::NoiseMode::Photon;
  camera.electrons_at_white = 400.0;
  camera.read_electrons = 8.0;
  camera.prnu_percent = 2.0;
  camera.dark_electrons = 20.0;
  camera.dsnu_percent = 0.5;
  camera.lag = 0.4;
  camera.blur_h = 0.8;
  camera.blur_v = 0.6;
  camera.bandwidth_mhz = 0.6;
  for (const bool interlace : {false, true}) {
    camera.interlace = interlace;
    const CctvSignal line = pass_through(picture.image, setup);
    const std::vector<std::uint32_t>& seen = picture.plan.targets[0].seen;
    const ShownMoments moments = moments_at(line, seen, seen, 1);
    const WeightedResels disc = weigh(seen, side_px, side_px, side_px, side_px);
    const degrade::LineNoise law = degrade::line_noise(camera, setup.monitor);
    double sum = 0.0;
    for (const std::uint32_t p : seen) {
      for (const std::uint32_t q : seen) {
        sum += law.total(0.5, static_cast<int>(q % side_px) - static_cast<int>(p % side_px),
                         static_cast<int>(q / side_px) - static_cast<int>(p / side_px));
      }
    }
    const double count = static_cast<double>(seen.size());
    // Without interlace, the law has the lag of one frame between the fields of a frame.
    EXPECT_NEAR(mean_noise(line, moments, disc, disc, 1).variance_a, sum / (count * count),
                1e-4 * sum / (count * count))
        << interlace;
  }
}

// Noise common to target and surround cancels in their difference.
TEST(SightNoise, SharedNoiseLeavesTheDifference) {
  degrade::Setup setup = tests::with_noise(tests::plain_cctv(side_px, side_px, 100.0), 0.0, 0.01);
  setup.camera.blur_h = setup.camera.blur_v = 3.0;
  const auto picture = tests::discs_on(50.0, {{48.0, 48.0, 2.5, 90.0}}, side_px, side_px);
  const SightTarget& target = picture.plan.targets[0];
  const CctvSignal line = pass_through(picture.image, setup);
  const std::vector<std::uint32_t> all = all_of(side_px, side_px);
  const MeanNoise noise = mean_noise(
      line, moments_at(line, all, all, 6), weigh(target.seen, side_px, side_px, side_px, side_px),
      weigh(target.view.surround, side_px, side_px, side_px, side_px), 6);
  EXPECT_GT(noise.covariance, 0.3 * noise.variance_a);
  const SignalSight signal = *tests::sight_of(picture, setup).signal;
  const double expected = (signal.mean - *signal.surround) /
                          std::sqrt(noise.variance_a + noise.variance_b - 2.0 * noise.covariance);
  EXPECT_NEAR(*signal.snr_d, expected, 1e-4 * expected);
}

TEST(SightNoise, FramesOfALaggingTubeAreAlike) {
  EXPECT_NEAR(time_factors(0.0, true, 6).same, 1.0 / 6.0, 1e-12);
  EXPECT_EQ(time_factors(0.0, true, 6).other, 0.0);
  EXPECT_EQ(time_factors(0.4, true, 1).other, 0.4);
  // Two frames of two fields: same (2 + 2 * 0.4^2) / 4, other (2 * 0.4 + 0.4^3 + 0.4) / 4.
  EXPECT_NEAR(time_factors(0.4, true, 2).same, (2.0 + 2.0 * 0.16) / 4.0, 1e-12);
  EXPECT_NEAR(time_factors(0.4, true, 2).other, (3.0 * 0.4 + 0.064) / 4.0, 1e-12);
  EXPECT_EQ(time_factors(0.4, false, 2).other, 0.0);
}

// Means over a disc and over its surround in 400 independent noisy frames of the tube, each with
// its own seed and hence its own fixed pattern: mean within 4 s / sqrt(M), variance with a relative
// error of 4 sqrt(2 / (M - 1)).
TEST(SightNoise, NoisyFramesScatterAsForetold) {
  constexpr int frames = 400;
  const auto picture = busy_picture();
  const degrade::Setup setup = small_monitor(*degrade::find_preset("sit-monochrome"));
  const CctvSignal line = pass_through(picture.image, setup);
  const std::vector<std::uint32_t> all = all_of(side_px, side_px);
  const ShownMoments moments = moments_at(line, all, all, 1);
  struct Sample {
    WeightedResels disc, surround;
    double sum = 0.0, squares = 0.0, light = 0.0, light_squares = 0.0;
  };
  std::vector<Sample> samples;
  for (const SightTarget& target : picture.plan.targets) {
    samples.push_back({weigh(target.seen, side_px, side_px, side_px, side_px),
                       weigh(target.view.surround, side_px, side_px, side_px, side_px)});
  }
  const auto mean_over = [](const std::vector<float>& values, const WeightedResels& set) {
    double sum = 0.0;
    for (std::size_t i = 0; i < set.resel.size(); ++i) {
      sum += set.weight[i] * static_cast<double>(values[set.resel[i]]);
    }
    return sum;
  };
  for (int frame = 0; frame < frames; ++frame) {
    degrade::Options options;
    options.seed = 1000 + static_cast<std::uint64_t>(frame);
    const degrade::Result result =
        degrade::degrade(picture.image, setup.camera, setup.monitor, options);
    const degrade::Plane& v = result.signal.channels.front().values;
    const degrade::Plane& light = result.viewed.channels.front().values;
    const std::size_t step = static_cast<std::size_t>(setup.monitor.pixels_per_resel);
    std::vector<float> mean_light(v.size(), 0.0F);
    for (std::size_t i = 0; i < light.size(); ++i) {
      const std::size_t x = i % (step * side_px) / step, y = i / (step * side_px) / step;
      mean_light[y * side_px + x] += light[i] / static_cast<float>(step * step);
    }
    for (Sample& s : samples) {
      const double value = mean_over(v, s.disc) - mean_over(v, s.surround);
      s.sum += value;
      s.squares += value * value;
      const double shown = mean_over(mean_light, s.disc);
      s.light += shown;
      s.light_squares += shown * shown;
    }
  }
  for (const Sample& s : samples) {
    const MeanNoise noise = mean_noise(line, moments, s.disc, s.surround, 1);
    const double foretold = noise.variance_a + noise.variance_b - 2.0 * noise.covariance;
    const double mean = s.sum / frames,
                 variance = (s.squares - frames * mean * mean) / (frames - 1);
    EXPECT_NEAR(mean, mean_over(moments.mean, s.disc) - mean_over(moments.mean, s.surround),
                4.0 * std::sqrt(foretold / frames));
    EXPECT_NEAR(variance, foretold, 4.0 * std::sqrt(2.0 / (frames - 1)) * foretold);
    const double light = s.light / frames;
    const double light_variance = (s.light_squares - frames * light * light) / (frames - 1);
    EXPECT_NEAR(
        light,
        screen_mean(line, moments, screen_sources({line.spread_along, line.spread_across}, s.disc)),
        4.0 * std::sqrt(light_variance / frames) + 1e-4 * light);
  }
}

}  // namespace
}  // namespace earthshine::studies
