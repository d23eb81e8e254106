// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/units.h"
#include "degrade/chain.h"
#include "degrade/parts/electronics.h"
#include "degrade/parts/noise.h"
#include "tests/degrade/fields.h"

namespace earthshine::degrade {
namespace {

using test::flat;

// Gain of the filter for a cosine of `cycles` per resel, in the middle of the line (the phase of a
// symmetric filter is 0).
double transfer(const AxisMap& filter, double cycles) {
  const std::size_t middle = static_cast<std::size_t>(filter.out() / 2);
  double sum = 0.0;
  for (std::size_t k = filter.start[middle]; k < filter.start[middle + 1]; ++k) {
    const double distance = static_cast<double>(filter.source[k]) - static_cast<double>(middle);
    sum += filter.weight[k] * std::cos(2.0 * base::pi * cycles * distance);
  }
  return sum;
}

// -3 dB is half of the power, an amplitude of 1 / sqrt 2. A line of 52.66 us has the columns of the
// whole screen, so that B MHz is B 52.66 / columns cycles per resel for pictures of any width.
TEST(Bandwidth, IsThreeDecibelsDownAtItsFrequencyForEveryWidth) {
  for (const int screen : {400, 512, 1000}) {
    for (const double mhz : {1.0, 2.5, 3.5}) {
      const double cycles = mhz * 52.66 / screen;
      for (const int columns : {screen / 2, screen}) {
        EXPECT_NEAR(transfer(line_filter(columns, mhz, 0.0, screen), cycles), std::sqrt(0.5), 1e-6)
            << screen << ' ' << mhz;
      }
    }
  }
}

// From the Nyquist frequency of the resels on, no grid can have the -3 dB point: the filter is then
// the continuous Gaussian and vanishes with growing bandwidth.
TEST(Bandwidth, BeyondNyquistTheVarianceFallsAsTheInverseSquare) {
  EXPECT_NEAR(bandwidth_variance(8.0, 400) / bandwidth_variance(16.0, 400), 4.0, 1e-9);
  EXPECT_LT(bandwidth_variance(100.0, 400), 2e-4);
  double last = 1e9;
  for (double mhz = 0.5; mhz < 20.0; mhz += 0.25) {
    const double t = bandwidth_variance(mhz, 400);
    EXPECT_LT(t, last) << mhz;
    last = t;
  }
}

TEST(ApertureCorrection, TransferIsOnePlusKTimesOneMinusCosine) {
  for (const double f : {0.0, 0.1, 0.25, 0.5}) {
    EXPECT_NEAR(transfer(line_filter(101, 0.0, 0.6, 400), f),
                1.0 + 0.6 * (1.0 - std::cos(2.0 * base::pi * f)), 1e-9);
    EXPECT_NEAR(transfer(line_filter(101, 3.0, 0.6, 400), f),
                transfer(line_filter(101, 3.0, 0.0, 400), f) *
                    (1.0 + 0.6 * (1.0 - std::cos(2.0 * base::pi * f))),
                1e-9);
  }
}

TEST(LineFilter, FlatLineStaysFlatUpToTheBorder) {
  const AxisMap filter = line_filter(37, 2.0, 1.0, 400);
  const Picture out = apply(flat(37, 3, 0.7F), filter, symmetric_filter(3, {1.0}));
  for (float value : out.planes[0]) EXPECT_NEAR(value, 0.7F, 1e-6F);
}

TEST(Weave, TwoEqualFieldsAreThePicture) {
  const Picture picture = add_read_noise(flat(12, 9, 0.5F), {.a = 0.01}, {});
  EXPECT_EQ(weave(picture, picture).planes[0], picture.planes[0]);
}

// A bar that moves v columns per frame is v / 2 further in the second field: the teeth of the comb.
TEST(Weave, MotionOfAFrameMakesACombOfHalfOfIt) {
  const auto bar = [](int x) {
    Picture picture = flat(20, 6, 0.0F);
    for (int y = 0; y < 6; ++y) picture.planes[0][static_cast<std::size_t>(y * 20 + x)] = 1.0F;
    return picture;
  };
  const Picture comb = weave(bar(4), bar(4 + 6 / 2));
  for (int y = 0; y < 6; ++y) {
    for (int x = 0; x < 20; ++x) {
      EXPECT_EQ(comb.planes[0][static_cast<std::size_t>(y * 20 + x)],
                x == (y % 2 == 0 ? 4 : 7) ? 1.0F : 0.0F);
    }
  }
}

// Fields have independent noise: the even lines are equal to those of a camera without fields, the
// odd ones are not. Without noise the interlaced picture is the progressive picture.
TEST(Interlace, FieldsShareThePictureButNotTheNoise) {
  CctvCamera camera;
  camera.gamma = 1.0;
  const base::Image scene =
      test::painted(400, 300, [](double x, double y) { return 50.0 * x + y; });
  const auto signal = [&](bool interlace) {
    camera.interlace = interlace;
    return degrade(scene, camera, {}).signal.channels[0].values;
  };
  EXPECT_EQ(signal(true), signal(false));
  camera.noise = NoiseMode::Spec;
  const std::vector<float> woven = signal(true), progressive = signal(false);
  std::size_t equal_odd = 0;
  for (std::size_t i = 0; i < woven.size(); ++i) {
    if (i / 400 % 2 == 0)
      ASSERT_EQ(woven[i], progressive[i]) << i;
    else if (woven[i] == progressive[i])
      ++equal_odd;
  }
  EXPECT_LT(equal_odd, 20U);  // of 60 000: clamped black and white, and coincidence
}

// Whole rows of one picture, then of the other: no stage before the interlace mixes them.
TEST(Interlace, FieldsOfTheirOwnPicturesAreWoven) {
  CctvCamera camera;
  camera.gamma = 1.0;
  camera.iris = IrisMode::Fixed;
  camera.f_number = 1e3;
  const auto bar = [](double at) {
    return test::painted(400, 300, [at](double x, double) { return x < at ? 1.0 : 0.0; });
  };
  const Result moved = degrade_fields(bar(0.5), bar(0.505), (camera.interlace = true, camera), {});
  const Result first = degrade(bar(0.5), camera, {}), second = degrade(bar(0.505), camera, {});
  const auto& woven = moved.signal.channels[0].values;
  for (std::size_t i = 0; i < woven.size(); ++i) {
    const Result& field = i / 400 % 2 == 0 ? first : second;
    ASSERT_EQ(woven[i], field.signal.channels[0].values[i]) << i;
  }
  camera.interlace = false;
  EXPECT_THROW(static_cast<void>(degrade_fields(bar(0.5), bar(0.5), camera, {})), base::Error);
}

// One iris per frame: the second field, twice as bright, has the exposure of the first. Shares of
// the frame are means over its fields.
TEST(Interlace, IrisFollowsTheFirstFieldAndSharesAreOfTheFrame) {
  CctvCamera camera;
  camera.gamma = 1.0;
  camera.interlace = true;
  camera.iris = IrisMode::Average;
  camera.iris_target = 0.6;
  const Result frame =
      degrade_fields(test::grey(400, 300, 10.0F), test::grey(400, 300, 20.0F), camera, {});
  const auto& signal = frame.signal.channels[0].values;
  EXPECT_NEAR(signal[0], 0.6F, 1e-5F);
  EXPECT_NEAR(signal[400], 1.1F, 1e-5F);  // 1.2 before the white clip
  EXPECT_DOUBLE_EQ(frame.report.levels.saturated_share, 0.5);
  EXPECT_NEAR(frame.report.exposure.metered, 10.0, 1e-4);
}

}  // namespace
}  // namespace earthshine::degrade
