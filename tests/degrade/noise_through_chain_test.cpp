// SPDX-License-Identifier: Apache-2.0
// V35: frames of the whole chain against the moments predicted without drawing any noise.
#include <gtest/gtest.h>

#include <cmath>

#include "base/units.h"
#include "degrade/chain.h"
#include "degrade/line.h"
#include "degrade/noise_moments.h"
#include "degrade/point_moments.h"
#include "tests/degrade/covariances.h"
#include "tests/degrade/fields.h"

namespace earthshine::degrade {
namespace {

constexpr int columns = 40, rows = 30, frames = 300;

// A tube: grain of light through lag, target and line, amplifier noise, clamp, clip and gamma, two
// fields. Luminance 1 is signal 1.
Setup tube() {
  Setup setup;
  setup.monitor.columns = columns;
  setup.monitor.rows = rows;
  CctvCamera& camera = setup.camera;
  camera.iris = IrisMode::Fixed;
  camera.white_lux = base::pi * camera.transmittance / (4.0 * camera.f_number * camera.f_number);
  camera.noise = NoiseMode::Law;
  camera.noise_a = 4e-4;
  camera.noise_b = 1.6e-3;
  camera.blur_h = camera.blur_v = 0.5;
  camera.lag = 0.4;
  camera.bandwidth_mhz = 0.3;  // 40 resels to a line: cycles of 2.5 resels
  camera.interlace = true;
  return setup;
}

Plane after(const Plane& plane, const AxisMap& along, const AxisMap& across) {
  return apply({along.in, across.in, {plane}}, along, across).planes.front();
}

struct Prediction {
  Plane line_mean, line_variance, seen_mean, seen_variance;
};

Prediction predict(const Plane& signal, const Setup& setup) {
  const CctvCamera& camera = setup.camera;
  const Monitor& monitor = setup.monitor;
  const AxisMap blur_h = gaussian_blur(columns, camera.blur_h);
  const AxisMap blur_v = gaussian_blur(rows, camera.blur_v);
  const AxisMap line = line_filter(columns, camera.bandwidth_mhz, 0.0, columns);
  const AxisMap no_change = gaussian_blur(rows, 0.0);
  Plane variance = signal;
  for (float& value : variance) value *= static_cast<float>(camera.noise_b);
  // A recursion of white noise is smaller by (1 - lag) / (1 + lag), and keeps the share lag from
  // field to field; the amplifier's noise keeps nothing.
  const Covariance light = times(filtered(white(columns, rows, variance), blur_h, blur_v),
                                 (1.0 - camera.lag) / (1.0 + camera.lag));
  const Covariance amplifier =
      white(columns, rows, Plane(signal.size(), static_cast<float>(camera.noise_a)));
  const Covariance noise =
      filtered(plus(weave(light, camera.lag), weave(amplifier, 0.0)), line, no_change);
  const Plane mean = after(after(signal, blur_h, blur_v), line, no_change);

  PointMap to_line, to_screen;
  to_line.limit_below(0.0).limit_above(camera.white_clip).power(1.0 / camera.gamma);
  to_screen = to_line;
  to_screen.screen(monitor.black_luminance, monitor.white_luminance, monitor.gamma);
  const MomentPlanes on_line = through(to_line, mean, noise.variance());
  const MomentPlanes on_screen = through(to_screen, mean, noise.variance());
  const Covariance light_noise = mapped(noise, on_screen);
  const AxisMap wide = spread_map(monitor.spread, monitor.spread_width, columns, 3);
  const AxisMap high = spread_map(monitor.spread, monitor.spread_width, rows, 3);
  Plane seen_mean = after(on_screen.mean, wide, high);
  for (float& value : seen_mean) value += static_cast<float>(room_luminance(monitor));
  return {on_line.mean, on_line.variance, seen_mean, variance_after(light_noise, wide, high)};
}

// Mean and variance over the frames at places far enough apart to be independent, against the
// prediction: the sum of squared standardised errors of the M means is chi-squared with M degrees
// of freedom; the mean of the M sample variances over the predicted ones has the standard error
// sqrt(2 / (M N)) times the mean's 1.
class Comparison {
 public:
  Comparison(int width, int height, int step) {
    for (int y = 0; y < height; y += step) {
      for (int x = 0; x < width; x += step) places_.push_back(test::at(x, y, width));
    }
    sum_.assign(places_.size(), 0.0);
    squares_ = sum_;
  }

  void add(const Plane& frame, const Plane& mean) {
    for (std::size_t k = 0; k < places_.size(); ++k) {
      const double error =
          static_cast<double>(frame[places_[k]]) - static_cast<double>(mean[places_[k]]);
      sum_[k] += error;
      squares_[k] += error * error;
    }
  }

  void expect(const Plane& variance) const {
    double chi2 = 0.0, ratio = 0.0;
    const double count = static_cast<double>(places_.size());
    for (std::size_t k = 0; k < places_.size(); ++k) {
      const double predicted = static_cast<double>(variance[places_[k]]);
      chi2 += sum_[k] * sum_[k] / frames / predicted;
      ratio += (squares_[k] - sum_[k] * sum_[k] / frames) / (frames - 1) / predicted / count;
    }
    EXPECT_NEAR(chi2, count, 4.0 * std::sqrt(2.0 * count));
    EXPECT_NEAR(ratio, 1.0, 4.0 * std::sqrt(2.0 / (count * frames)));
  }

 private:
  std::vector<std::size_t> places_;
  std::vector<double> sum_, squares_;
};

void expect_predicted(const base::Image& scene, const Setup& setup) {
  const Prediction predicted = predict(scene.channels[0].values, setup);
  Comparison line(columns, rows, 7), seen(3 * columns, 3 * rows, 25);
  for (std::uint64_t k = 0; k < frames; ++k) {
    // Every other frame: the charge of the field before the first is part of a frame's noise.
    const Options options{.seed = 4, .frame = 2 * k + 1, .off = {}};
    const Result result = degrade(scene, setup.camera, setup.monitor, options);
    line.add(result.signal.channels[0].values, predicted.line_mean);
    seen.add(result.viewed.channels[0].values, predicted.seen_mean);
  }
  line.expect(predicted.line_variance);
  seen.expect(predicted.seen_variance);
}

TEST(NoiseThroughChain, LineAndScreenOfAGreyWedgeAreAsPredicted) {
  expect_predicted(
      test::painted(columns, rows, [](double x, double y) { return 0.1 + 0.4 * x + 0.3 * y; }),
      tube());
}

// Half of the amplifier's noise is clamped at black and much of white is clipped: no small-noise
// expansion holds there.
TEST(NoiseThroughChain, LineAndScreenOfClampedBlackAndClippedWhiteAreAsPredicted) {
  expect_predicted(
      test::painted(columns, rows,
                    [](double x, double y) { return x < 0.5 ? 0.02 * y : 1.05 + 0.1 * y; }),
      tube());
}

}  // namespace
}  // namespace earthshine::degrade
