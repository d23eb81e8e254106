// SPDX-License-Identifier: Apache-2.0
// Parts of the twin that have a closed form.
#include <gtest/gtest.h>

#include <cmath>

#include "base/units.h"
#include "degrade/twin.h"
#include "tests/degrade/fields.h"

namespace earthshine::degrade {
namespace {

using test::grey;

// 1 cd/m^2 is white; linear, without limits.
CctvCamera linear() {
  CctvCamera camera = test::linear_camera();
  camera.black_clamp = false;
  return camera;
}

// Without filters the variance is the law, including patterns and dark counts.
TEST(TwinParts, VarianceOfABareSensorIsTheLaw) {
  CctvCamera camera = linear();
  camera.noise = NoiseMode::Photon;
  camera.electrons_at_white = 500.0;
  camera.read_electrons = 4.0;
  camera.excess_noise = 1.5;
  camera.prnu_percent = 2.0;
  camera.dark_electrons = 20.0;
  camera.dsnu_percent = 1.0;
  const double n = 500.0;
  for (const double s : {0.0, 0.1, 0.5, 0.9}) {
    const double law = 16.0 / (n * n) + 1.5 * (s / n + 20.0 / (n * n)) + 4e-4 * s * s + 1e-4;
    const Twin stated = twin(grey(40, 30, static_cast<float>(s)), camera, {});
    EXPECT_NEAR(stated.variance.planes[0][777] / law, 1.0, 1e-5) << s;
    EXPECT_NEAR(stated.mean.planes[0][777], s, 1e-6) << s;
  }
}

// Steady light with lag: only noise that is new in each field is reduced, by (1 - l^2) / (1 + l^2)
// for frames of two fields.
TEST(TwinParts, LagShrinksGrainAndLeavesPatterns) {
  CctvCamera camera = linear();
  camera.noise = NoiseMode::Photon;
  camera.electrons_at_white = 500.0;
  camera.prnu_percent = 2.0;
  camera.lag = 0.5;
  const Twin stated = twin(grey(40, 30, 0.5F), camera, {});
  const double expected = 0.5 / 500.0 * (0.75 / 1.25) + 4e-4 * 0.25;
  EXPECT_NEAR(stated.variance.planes[0][777] / expected, 1.0, 1e-5);
}

// Without noise, the mean after bloom and saturation is the picture.
TEST(TwinParts, MeanBehindBloomIsTheNoiseFreePicture) {
  CctvCamera camera = linear();
  camera.saturation = 1.0;
  camera.bloom = 0.4;
  camera.bloom_radius = 3.0;
  const base::Image scene =
      test::painted(400, 300, [](double x, double y) { return x < 0.1 && y < 0.2 ? 5.0 : 0.3; });
  const Twin stated = twin(scene, camera, {});
  for (std::size_t i = 0; i < stated.mean.pixel_count(); ++i) {
    ASSERT_NEAR(stated.mean.planes[0][i], stated.signal.planes[0][i], 1e-5) << i;
  }
}

// The planes of a colour camera have independent noise: the variance of luminance is 0.2126^2 +
// 0.7152^2 + 0.0722^2 = 0.5619 of one plane's variance (squared weights of Rec. 709).
TEST(TwinParts, LuminanceOfThreePlanesIsLessNoisyThanOne) {
  CctvCamera camera = linear();
  camera.colour = true;
  camera.noise = NoiseMode::Law;
  camera.noise_a = 1e-4;
  base::Image white = base::make_rgb_image(40, 30);
  for (base::Channel& channel : white.channels) channel.values.assign(white.pixel_count(), 0.5F);
  const Twin stated = twin(white, camera, {});
  const double weights2 = 0.2126 * 0.2126 + 0.7152 * 0.7152 + 0.0722 * 0.0722;
  EXPECT_NEAR(stated.snr[777], 0.5 / (0.01 * std::sqrt(weights2)), 0.01);
}

// Crushed: not above the amplified noise of black. With gain 4 and sigma 1 % this is a signal of
// 0.04 after the gain, 0.01 before it.
TEST(TwinParts, CrushedIsJudgedBehindTheGain) {
  CctvCamera camera = linear();
  camera.gain_db = 20.0 * std::log10(4.0);
  camera.noise = NoiseMode::Law;
  camera.noise_a = 1e-4;
  EXPECT_EQ(twin(grey(40, 30, 0.0098F), camera, {}).crushed[777], 1.0F);
  EXPECT_EQ(twin(grey(40, 30, 0.0102F), camera, {}).crushed[777], 0.0F);
}

// A twin with its own memory has the same iris as the noisy camera.
TEST(TwinParts, FollowsTheIrisOfASequence) {
  CctvCamera camera = linear();
  camera.iris = IrisMode::Peak;
  camera.iris_slew = 0.5;
  camera.f_number_min = 0.5;
  camera.f_number_max = 1e3;
  camera.white_lux = 1e-3;
  Memory noisy, still;
  for (const float light : {1.0F, 100.0F, 100.0F}) {
    const Result result = degrade(grey(40, 30, light), camera, {}, {}, noisy);
    const Twin stated = twin(grey(40, 30, light), camera, {}, {}, {}, still);
    EXPECT_EQ(*stated.memory.f_number, *result.memory.f_number);
    EXPECT_EQ(stated.signal.planes[0], result.signal.channels[0].values);
    noisy = result.memory;
    still = stated.memory;
  }
}

// A luminance camera uses a colour picture's luminance, also if no stage of the lens runs.
TEST(TwinParts, WithoutALensThePictureIsStillTheCameras) {
  base::Image grey_in_colour = base::make_rgb_image(40, 30);
  for (base::Channel& channel : grey_in_colour.channels) channel.values.assign(1200, 0.5F);
  Options options;
  options.off = {"sensor-grid", "iris", "lens", "conversion"};
  const Twin stated = twin(grey_in_colour, linear(), {}, options);
  ASSERT_EQ(stated.mean.planes.size(), 1U);
  EXPECT_EQ(stated.viewed_mean.planes.size(), 1U);
  EXPECT_NEAR(stated.mean.planes[0][777], 0.5F, 1e-6F);
}

}  // namespace
}  // namespace earthshine::degrade
