// SPDX-License-Identifier: Apache-2.0
// V35: frames of a tube camera, with noise correlated between neighbours and between fields,
// against the twin.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/units.h"
#include "degrade/twin.h"
#include "tests/degrade/covariances.h"
#include "tests/degrade/fields.h"

namespace earthshine::degrade {
namespace {

constexpr int columns = 40, rows = 30, frames = 300;

// A tube: grain of the light through lag, target and line; amplifier noise, clamp, clip and gamma;
// two fields. Luminance 1 is signal 1.
Setup tube() {
  Setup setup;
  setup.monitor.columns = columns;
  setup.monitor.rows = rows;
  setup.monitor.spread_width = 2.0;  // covers several lines, so that the correlation of the fields
                                     // matters
  CctvCamera& camera = setup.camera;
  camera.iris = IrisMode::Fixed;
  camera.white_lux = base::pi * camera.transmittance / (4.0 * camera.f_number * camera.f_number);
  camera.noise = NoiseMode::Law;
  camera.noise_a = 4e-4;
  camera.noise_b = 1.6e-3;
  camera.blur_h = 0.5;
  camera.blur_v = 0.8;
  camera.lag = 0.4;
  camera.bandwidth_mhz = 0.3;  // 40 resels per line: cycles of 2.5 resels
  camera.interlace = true;
  return setup;
}

// Mean and variance over N frames at M positions, far enough apart to be independent, against the
// prediction. The sum of the squared standardised errors of the means is chi-squared with M degrees
// of freedom. Each mean squared error has the variance (fourth moment - square of the second) / N,
// measured from the frames, because clamped noise is not Gaussian.
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
    double chi2 = 0.0, ratio = 0.0, variance_of_ratio = 0.0;
    const double count = static_cast<double>(places_.size());
    for (const Place& place : places_) {
      const double predicted = static_cast<double>(variance[place.pixel]);
      chi2 += place.first * place.first * frames / predicted;
      ratio += place.second / predicted / count;
      variance_of_ratio +=
          (place.fourth - place.second * place.second) / frames / (predicted * predicted);
    }
    EXPECT_NEAR(chi2, count, 4.0 * std::sqrt(2.0 * count));
    EXPECT_NEAR(ratio, 1.0, 4.0 * std::sqrt(variance_of_ratio) / count);
    EXPECT_LT(4.0 * std::sqrt(variance_of_ratio) / count, 0.1);
  }

 private:
  struct Place {
    std::size_t pixel = 0;
    double first = 0.0, second = 0.0, fourth = 0.0;
  };
  std::vector<Place> places_;
};

void expect_stated(const base::Image& scene, const Setup& setup) {
  const Twin stated = twin(scene, setup.camera, setup.monitor);
  Comparison line(columns, rows, 7), seen(3 * columns, 3 * rows, 17);
  for (std::uint64_t k = 0; k < frames; ++k) {
    // Every other frame: the charge of the field before the first one is part of a frame's noise.
    const Options options{.seed = 4, .frame = 2 * k + 1, .off = {}};
    const Result result = degrade(scene, setup.camera, setup.monitor, options);
    line.add(result.signal.channels[0].values, stated.mean.planes[0]);
    seen.add(result.viewed.channels[0].values, stated.viewed_mean.planes[0]);
  }
  line.expect(stated.variance.planes[0]);
  seen.expect(stated.viewed_variance.planes[0]);
}

TEST(TwinFrames, LineAndScreenOfAGreyWedgeAreAsStated) {
  auto setup = tube();
  setup.camera.noise_a = 4e-5;
  expect_stated(
      test::painted(columns, rows, [](double x, double y) { return 0.1 + 0.4 * x + 0.3 * y; }),
      setup);
}

// Much of the noise is clamped at black and, by the screen, at white; expansions for small noise
// fail there.
TEST(TwinFrames, LineAndScreenOfClampedBlackAndClippedWhiteAreAsStated) {
  expect_stated(
      test::painted(columns, rows,
                    [](double x, double y) { return x < 0.5 ? 0.02 * y : 0.97 + 0.06 * y; }),
      tube());
}

}  // namespace
}  // namespace earthshine::degrade
