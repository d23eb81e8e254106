// SPDX-License-Identifier: Apache-2.0
// V35: frames of the whole chain against the moments predicted without drawing any noise.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

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
  setup.monitor.spread_width = 2.0;  // over several lines: what the fields share counts
  CctvCamera& camera = setup.camera;
  camera.iris = IrisMode::Fixed;
  camera.white_lux = base::pi * camera.transmittance / (4.0 * camera.f_number * camera.f_number);
  camera.noise = NoiseMode::Law;
  camera.noise_a = 4e-4;
  camera.noise_b = 1.6e-3;
  camera.blur_h = 0.5;
  camera.blur_v = 0.8;
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

// Mean and variance over the N frames at M places far enough apart to be independent, against the
// prediction: the sum of the squared standardised errors of the means is chi-squared with M degrees
// of freedom; each mean squared error has the variance (fourth moment - square of the second) / N,
// from the frames themselves, as clamped noise is not Gaussian.
class Comparison {
 public:
  Comparison(int width, int height, int step) {
    for (int y = 0; y < height; y += step) {
      for (int x = 0; x < width; x += step) places_.push_back({test::at(x, y, width)});
    }
  }

  void add(const Plane& frame, const Plane& mean) {
    for (Place& place : places_) {
      const double error =
          static_cast<double>(frame[place.pixel]) - static_cast<double>(mean[place.pixel]);
      place.first += error / frames;
      place.second += error * error / frames;
      place.fourth += error * error * error * error / frames;
    }
  }

  void expect(const Plane& variance) const {
    double chi2 = 0.0, ratio = 0.0, doubt = 0.0;
    const double count = static_cast<double>(places_.size());
    for (const Place& place : places_) {
      const double predicted = static_cast<double>(variance[place.pixel]);
      chi2 += place.first * place.first * frames / predicted;
      ratio += place.second / predicted / count;
      doubt += (place.fourth - place.second * place.second) / frames / (predicted * predicted);
    }
    EXPECT_NEAR(chi2, count, 4.0 * std::sqrt(2.0 * count));
    EXPECT_NEAR(ratio, 1.0, 4.0 * std::sqrt(doubt) / count);
    EXPECT_LT(4.0 * std::sqrt(doubt) / count, 0.1);
  }

 private:
  struct Place {
    std::size_t pixel = 0;
    double first = 0.0, second = 0.0, fourth = 0.0;
  };
  std::vector<Place> places_;
};

void expect_predicted(const base::Image& scene, const Setup& setup) {
  const Prediction predicted = predict(scene.channels[0].values, setup);
  Comparison line(columns, rows, 7), seen(3 * columns, 3 * rows, 17);
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
  auto setup = tube();
  setup.camera.noise_a = 4e-5;
  expect_predicted(
      test::painted(columns, rows, [](double x, double y) { return 0.1 + 0.4 * x + 0.3 * y; }),
      setup);
}

// Much of the noise is clamped at black and, by the screen, at white: no small-noise expansion
// holds there.
TEST(NoiseThroughChain, LineAndScreenOfClampedBlackAndClippedWhiteAreAsPredicted) {
  expect_predicted(
      test::painted(columns, rows,
                    [](double x, double y) { return x < 0.5 ? 0.02 * y : 0.97 + 0.06 * y; }),
      tube());
}

}  // namespace
}  // namespace earthshine::degrade
