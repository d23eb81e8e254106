// SPDX-License-Identifier: Apache-2.0
// The twin against noisy pictures.
#include "degrade/twin.h"

#include <gtest/gtest.h>

#include <cmath>

#include "degrade/settings/presets.h"
#include "tests/degrade/fields.h"

namespace earthshine::degrade {
namespace {

constexpr int frame_count = 400;

// 64 x 48 resels: ramps, an edge, a bright bar, deep shadow.
base::Image scene() {
  return test::painted(64, 48, [](double x, double y) {
    if (y < 0.25) return 20.0 * x;
    if (x > 0.7 && x < 0.74) return 400.0;
    return x < 0.35 ? 2.0 : 60.0 + 40.0 * y;
  });
}

Monitor small(Spread spread = Spread::Gaussian) {
  Monitor monitor;
  monitor.rows = 48;
  monitor.columns = 64;
  monitor.spread = spread;
  return monitor;
}

// Exposure with white at 100 cd/m^2.
CctvCamera exposed() {
  CctvCamera camera;
  camera.iris = IrisMode::Fixed;
  camera.f_number = 1.0;
  camera.transmittance = 1.0;
  camera.white_lux = 25.0 * 3.14159265358979323846;
  camera.noise = NoiseMode::Law;
  camera.noise_a = 1e-4;
  camera.noise_b = 2e-3;
  camera.noise_c = 4e-4;
  return camera;
}

// Mean and variance over the frames, of the line signal and of the screen.
struct Sampled {
  std::vector<double> sum, squares;
  void add(const std::vector<float>& values) {
    sum.resize(values.size());
    squares.resize(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
      sum[i] += static_cast<double>(values[i]);
      squares[i] += static_cast<double>(values[i]) * static_cast<double>(values[i]);
    }
  }
  [[nodiscard]] double mean(std::size_t i) const { return sum[i] / frame_count; }
  [[nodiscard]] double variance(std::size_t i) const {
    return (squares[i] - sum[i] * mean(i)) / (frame_count - 1);
  }
};

struct Both {
  Sampled signal, viewed;
};

Both sample(const CctvCamera& camera, const Monitor& monitor) {
  Both both;
  Options options;
  for (int frame = 0; frame < frame_count; ++frame) {
    options.frame = static_cast<std::uint64_t>(frame);
    const Result result = degrade(scene(), camera, monitor, options);
    both.signal.add(result.signal.channels[0].values);
    both.viewed.add(result.viewed.channels[0].values);
  }
  return both;
}

// z of a mean is (mean - stated) / sqrt(stated variance / frame_count). z of a variance is
// (s^2 / stated - 1) / sqrt((kurtosis - 1) / frame_count), with sqrt(2 / frame_count) for Gaussian
// noise. Over all pixels the mean of z^2 must be 1. Neighbours are correlated over some `grain`
// pixels, so that the mean of z^2 over M pixels has the standard error sqrt(2 grain / M).
struct Pull {
  double mean2 = 0.0, variance2 = 0.0, bias = 0.0, ratio = 0.0;
  std::size_t pixels = 0;
};

template <class Skip>
Pull pull(const Sampled& seen, const Plane& mean, const Plane& variance, Skip skip) {
  Pull p;
  for (std::size_t i = 0; i < mean.size(); ++i) {
    const double v = static_cast<double>(variance[i]);
    if (skip(i) || !(v > 0.0)) continue;
    const double z = (seen.mean(i) - static_cast<double>(mean[i])) / std::sqrt(v / frame_count);
    const double w = (seen.variance(i) / v - 1.0) / std::sqrt(2.0 / frame_count);
    p.mean2 += z * z;
    p.bias += z;
    p.variance2 += w * w;
    p.ratio += seen.variance(i) / v;
    ++p.pixels;
  }
  const double n = static_cast<double>(p.pixels);
  p.mean2 /= n;
  p.bias /= n;
  p.variance2 /= n;
  p.ratio /= n;
  return p;
}

void expect_honest(const Pull& p, double grain, const std::string& what) {
  const double n = static_cast<double>(p.pixels) / grain;
  EXPECT_GT(p.pixels, 1000U) << what;
  EXPECT_NEAR(p.mean2, 1.0, 4.0 * std::sqrt(2.0 / n)) << what;
  EXPECT_NEAR(p.bias, 0.0, 4.0 / std::sqrt(n)) << what;
  EXPECT_NEAR(p.ratio, 1.0, 4.0 * std::sqrt(2.0 / frame_count / n)) << what;
}

constexpr auto nowhere = [](std::size_t) { return false; };

// Every linear stage without clamp and gamma: the twin is exact.
TEST(Twin, MomentsOfLinearStagesAreThoseOfTheNoisyPictures) {
  CctvCamera camera = exposed();
  camera.gamma = 1.0;
  camera.black_clamp = false;
  camera.white_clip = 0.0;
  camera.blur_h = 0.5;
  camera.blur_v = 0.35;
  camera.lag = 0.4;
  camera.bandwidth_mhz = 0.5;
  camera.aperture_correction = 0.3;
  camera.glare = 0.02;
  camera.shading_percent = 20.0;
  Monitor monitor = small();
  monitor.gamma = 1.0;
  for (const bool interlace : {false, true}) {
    camera.interlace = interlace;
    const Both seen = sample(camera, monitor);
    const Twin stated = twin(scene(), camera, monitor);
    const std::string what = interlace ? "interlaced" : "progressive";
    expect_honest(pull(seen.signal, stated.mean.planes[0], stated.variance.planes[0], nowhere), 4.0,
                  what);
    // The screen clamps at white and black: compared only where the signal is 5 sigma off both.
    const auto clipped = [&](std::size_t i) {
      const std::size_t x = i % 192 / 3, y = i / 192 / 3;
      for (std::size_t v = y < 4 ? 0 : y - 4; v < std::min<std::size_t>(48, y + 5); ++v) {
        for (std::size_t u = x < 4 ? 0 : x - 4; u < std::min<std::size_t>(64, x + 5); ++u) {
          const double s = stated.mean.planes[0][v * 64 + u];
          const double sigma = std::sqrt(stated.variance.planes[0][v * 64 + u]);
          if (s < 5.0 * sigma || s > 1.0 - 5.0 * sigma) return true;
        }
      }
      return false;
    };
    expect_honest(
        pull(seen.viewed, stated.viewed_mean.planes[0], stated.viewed_variance.planes[0], clipped),
        40.0, what + " screen");
  }
}

// The mean of the frames is the noise-free twin where nothing is clipped: within 4 sigma / 20.
TEST(Twin, MeanOfManyFramesIsTheNoiseFreeTwinWhereNothingClips) {
  CctvCamera camera = exposed();
  camera.gamma = 1.0;
  camera.blur_h = camera.blur_v = 0.4;
  const Both seen = sample(camera, small());
  const Twin stated = twin(scene(), camera, small());
  std::size_t compared = 0, outside = 0;
  for (std::size_t i = 0; i < stated.signal.pixel_count(); ++i) {
    const double s = stated.signal.planes[0][i], sigma = std::sqrt(stated.variance.planes[0][i]);
    if (s < 6.0 * sigma || s > 1.1 - 6.0 * sigma) continue;
    ++compared;
    if (std::abs(seen.signal.mean(i) - s) > 4.0 * sigma / 20.0) ++outside;
  }
  EXPECT_GT(compared, 1000U);
  EXPECT_LE(outside, 2U);  // 6e-5 of them are expected
}

// With clamps, gamma, gain and 6 bits the noise is not Gaussian, but the stated mean and variance
// of every pixel hold, also in black and white.
TEST(Twin, MomentsBehindClampsGammaAndQuantisationAreThoseOfTheNoisyPictures) {
  CctvCamera camera = exposed();
  camera.blur_h = camera.blur_v = 0.4;
  camera.gain_db = 6.0;
  camera.noise_a = 4e-4;
  camera.noise_b = 2e-4;  // many counts, so that the light's noise is Gaussian
  camera.bits = 6;
  const Both seen = sample(camera, small());
  const Twin stated = twin(scene(), camera, small());
  const Pull line = pull(seen.signal, stated.mean.planes[0], stated.variance.planes[0],
                         [&](std::size_t i) { return stated.variance.planes[0][i] < 1e-6F; });
  EXPECT_NEAR(line.mean2, 1.0, 4.0 * std::sqrt(2.0 * 4.0 / static_cast<double>(line.pixels)));
  EXPECT_NEAR(line.ratio, 1.0,
              4.0 * std::sqrt(2.0 / frame_count * 4.0 / static_cast<double>(line.pixels)));
}

TEST(Twin, IsTheChainWithoutNoiseBitForBit) {
  for (const Preset& preset : presets()) {
    Options quiet;
    quiet.off = {"signal-noise", "read-noise"};
    const Result bare = degrade(scene(), preset.camera, small(), quiet);
    const Twin stated = twin(scene(), preset.camera, small());
    for (std::size_t p = 0; p < stated.viewed.planes.size(); ++p) {
      EXPECT_EQ(stated.viewed.planes[p], bare.viewed.channels[p].values) << preset.name;
      EXPECT_EQ(stated.signal.planes[p], bare.signal.channels[p].values) << preset.name;
    }
  }
}

// Without noise: mean = twin, variance 0, and every difference from the surround is detected.
TEST(Twin, CameraWithoutNoiseHasNoVarianceAndSeesEveryDifference) {
  CctvCamera camera = exposed();
  camera.noise = NoiseMode::None;
  camera.blur_h = 0.4;
  const Twin stated = twin(scene(), camera, small());
  for (std::size_t i = 0; i < stated.signal.pixel_count(); ++i) {
    ASSERT_EQ(stated.variance.planes[0][i], 0.0F);
    ASSERT_NEAR(stated.mean.planes[0][i], stated.signal.planes[0][i], 1e-5);
  }
  EXPECT_EQ(stated.detection.probability[24 * 64 + 22], 1.0F);  // at the edge
}

// Masks: only the bar of four times white is white. The noise of black is 1 % of white; smaller
// signals are crushed.
TEST(Twin, MasksAreWhiteAndTheNoiseOfBlack) {
  const CctvCamera camera = exposed();
  const Twin stated = twin(scene(), camera, small());
  for (std::size_t i = 0; i < stated.signal.pixel_count(); ++i) {
    const double x = (static_cast<double>(i % 64) + 0.5) / 64,
                 y = (static_cast<double>(i / 64) + 0.5) / 48;
    const double s = y < 0.25                ? 0.2 * x
                     : (x > 0.7 && x < 0.74) ? 4.0
                     : x < 0.35              ? 0.02
                                             : 0.6 + 0.4 * y;
    EXPECT_EQ(stated.saturated[i], s >= 0.995 ? 1.0F : 0.0F) << i;
    EXPECT_EQ(stated.crushed[i], s <= 0.01 ? 1.0F : 0.0F) << i;
  }
}

// A darker square of 5 x 5 resels, contrast 3 %: the probability of detection falls with the noise
// and is one half at SNR_D = 2.8.
TEST(Twin, ProbabilityOfDetectionFallsWithTheNoise) {
  const base::Image square = test::painted(64, 48, [](double x, double y) {
    const bool inside = x * 64 >= 30 && x * 64 < 35 && y * 48 >= 20 && y * 48 < 25;
    return inside ? 48.5 : 50.0;
  });
  CctvCamera camera = exposed();
  camera.gamma = 1.0;
  camera.noise_b = camera.noise_c = 0.0;
  const std::size_t middle = 22 * 64 + 32;
  // White noise sigma: SNR_D = 0.015 sqrt(N) / sigma with 1 / N = 1 / 25 + 1 / 96.
  const double root_n = std::sqrt(1.0 / (1.0 / 25.0 + 1.0 / 96.0));
  double last = 2.0;
  for (const double snr : {20.0, 5.0, 2.8, 1.0}) {
    const double sigma = 0.015 * root_n / snr;
    camera.noise_a = sigma * sigma;
    const Twin stated = twin(square, camera, small());
    EXPECT_NEAR(stated.detection.snr[middle], snr, 1e-3 * snr);
    EXPECT_NEAR(stated.detection.probability[middle], 0.5 * std::erfc((2.8 - snr) / std::sqrt(2.0)),
                2e-3);
    EXPECT_LT(stated.detection.probability[middle], last);
    last = stated.detection.probability[middle];
  }
}

}  // namespace
}  // namespace earthshine::degrade
