// SPDX-License-Identifier: Apache-2.0
#include "degrade/carry.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/units.h"
#include "tests/degrade/fields.h"

namespace earthshine::degrade {
namespace {

// Noise about black with a share rho that is equal in all frames, clamped. The total variance is
// that of half a Gaussian, 1/2 - 1/2 pi. The covariance of two frames is rho / 4 + rho^2 / 4 pi
// (terms of rho^4 / 48 pi and less are neglected); the rest differs between frames.
TEST(Carry, ClampKeepsPatternAndGrainApart) {
  for (const double rho : {0.0, 0.3, 0.8}) {
    Moments m = still(test::flat(5, 4, 0.0F));
    m.grain[0] = white(5, 4, Plane(20, static_cast<float>(1.0 - rho)));
    m.pattern[0] = white(5, 4, Plane(20, static_cast<float>(rho)));
    m.pending.limit_below(0.0);
    m.is_pending = true;
    m = settled(std::move(m));
    EXPECT_FALSE(m.is_pending);
    EXPECT_NEAR(m.mean.planes[0][7], 1.0 / std::sqrt(2.0 * base::pi), 1e-6);
    EXPECT_NEAR(variance(m, 0)[7], 0.5 - 0.5 / base::pi, 1e-6);
    EXPECT_NEAR(m.pattern[0].variance()[7], rho / 4.0 + rho * rho / (4.0 * base::pi), 1e-6);
  }
}

}  // namespace
}  // namespace earthshine::degrade
