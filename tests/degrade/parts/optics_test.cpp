// SPDX-License-Identifier: Apache-2.0
#include "degrade/parts/optics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/units.h"
#include "degrade/chain.h"
#include "tests/degrade/fields.h"

namespace earthshine::degrade {
namespace {

using test::flat;

// A pixel's angle off the axis: tan theta = (distance in half heights) tan(fov / 2). The light of a
// uniform scene falls as cos^4 theta. For 90 degrees, the middle of the upper border has theta = 45
// degrees up to half a pixel, and cos^4 = 1/4.
TEST(FallOff, IsThePowerOfTheCosineOfTheFieldAngle) {
  constexpr int n = 101;
  const Picture e = fall_off_from_axis(flat(n, n, 1.0F), 4.0, 90.0);
  const auto at = [&](int x, int y) {
    return static_cast<double>(e.planes[0][static_cast<std::size_t>(y * n + x)]);
  };
  EXPECT_FLOAT_EQ(static_cast<float>(at(50, 50)), 1.0F);
  for (const auto& [x, y] : {std::pair{0, 50}, {50, 0}, {0, 0}, {20, 77}}) {
    const double u = (x - 50) / 50.5, v = (y - 50) / 50.5;
    const double tan2 = u * u + v * v;  // tan 45 degrees = 1
    EXPECT_NEAR(at(x, y), 1.0 / ((1.0 + tan2) * (1.0 + tan2)), 1e-6) << x << ' ' << y;
  }
  const double edge = 50.0 / 50.5;
  EXPECT_NEAR(at(50, 0), std::pow(std::cos(std::atan(edge)), 4.0), 1e-6);
}

TEST(FallOff, WithoutAFieldOfViewIsRefusedWithWhatToDo) {
  CctvCamera camera;
  camera.fall_off = 4.0;
  try {
    static_cast<void>(degrade(test::grey(4, 3, 1.0F), camera, {}));
    FAIL();
  } catch (const base::Error& error) {
    EXPECT_NE(std::string(error.what()).find("--fov"), std::string::npos) << error.what();
  }
  Options options;
  options.fov_deg = 60.0;
  const Result result = degrade(test::grey(400, 300, 1.0F), camera, {}, options);
  EXPECT_LT(result.signal.channels[0].values[0], result.signal.channels[0].values[150 * 400 + 200]);
}

// E falls by (1 + m)^2: to a quarter at m = 1.
TEST(Lens, CloseUpsAreDarkerByTheirMagnification) {
  CctvCamera camera;
  const double far = lens_transfer(camera, 2.0);
  camera.magnification = 1.0;
  EXPECT_DOUBLE_EQ(lens_transfer(camera, 2.0), far / 4.0);
  EXPECT_DOUBLE_EQ(lens_transfer(camera, 2.0), base::pi * 0.8 / (4.0 * 16.0));
}

TEST(Shading, CentreKeepsItsSignalAndCornersLoseTheDroop) {
  const Picture s = shade(flat(401, 301, 0.5F), 0.2);
  EXPECT_FLOAT_EQ(s.planes[0][150 * 401 + 200], 0.5F);
  // The centre of the corner pixel is half a pixel inside: r^2 = (400^2 + 300^2) / (401^2 + 301^2).
  const double r2 = (400.0 * 400.0 + 300.0 * 300.0) / (401.0 * 401.0 + 301.0 * 301.0);
  for (const std::size_t corner : {std::size_t{0}, std::size_t{400}, s.pixel_count() - 1}) {
    EXPECT_NEAR(static_cast<double>(s.planes[0][corner]), 0.5 * (1.0 - 0.2 * r2), 1e-6);
  }
}

// Linear stages commute: spreading and converting light gives the same in either order.
TEST(LensSpread, ActsOnLightLikeTheBlurActsOnSignal) {
  CctvCamera lens;
  lens.iris = IrisMode::Fixed;
  lens.white_lux = 100.0;
  lens.gamma = 1.0;
  CctvCamera tube = lens;
  lens.lens_blur = 0.8;
  tube.blur_h = tube.blur_v = 0.8;
  const base::Image scene =
      test::painted(400, 300, [](double x, double y) { return x > 0.5 ? 900.0 * y : 3.0; });
  const auto a = degrade(scene, lens, {}).signal.channels[0].values;
  const auto b = degrade(scene, tube, {}).signal.channels[0].values;
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i], b[i], 1e-6);
}

}  // namespace
}  // namespace earthshine::degrade
