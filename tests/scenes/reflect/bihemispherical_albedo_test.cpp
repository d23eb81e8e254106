// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "base/numbers/random.h"
#include "scenes/reflect/energy.h"
#include "tests/support/scene_builder.h"

namespace earthshine::scenes {
namespace {

// n = 0: the lobe is the half space about the mirrored direction. At angle t it contains (1 + cos
// t) / 2 of the hemisphere's cosines; the cosine-weighted mean is (1 + 2/3) / 2.
TEST(SpreadReflectance, OfALobeThatIsAHalfSpace) {
  EXPECT_NEAR(mean_lobe_reflectance(0.0), 5.0 / 6.0, 1e-3);
}

// A complete lobe has the solid angle 2 pi / (n + 1), and its mean direction (n + 1) / (n + 2) of
// the mirrored one's cosine: it reflects 2 cos t / (n + 2) of the light from t, in the
// cosine-weighted mean 2/3 of 2 / (n + 2). Lobes that the surface truncates, at angles within some
// n^-1/2 of grazing, have small cosines: a relative term of n^-3/2.
TEST(SpreadReflectance, OfNarrowLobes) {
  for (const double n : {400.0, 10000.0}) {
    EXPECT_NEAR(mean_lobe_reflectance(n) * (n + 2.0) * 0.75, 1.0, 1e-3 + 8.0 * std::pow(n, -1.5))
        << n;
  }
}

// By its definition with other points: pairs of cosine-distributed directions.
TEST(SpreadReflectance, IsTheMeanOverBothDirections) {
  base::Rng rng(base::Key(5, base::Stream::FormFactor, 1));
  for (const double n : {0.5, 2.0, 11.0}) {
    double sum = 0.0, squares = 0.0;
    constexpr int count = 400000;
    for (int k = 0; k < count; ++k) {
      const auto direction = [&] {
        const double sin2 = rng.next(), phi = 2.0 * base::pi * rng.next(), sine = std::sqrt(sin2);
        return Vec3(sine * std::cos(phi), sine * std::sin(phi), std::sqrt(1.0 - sin2));
      };
      const Vec3 in = direction(), out = direction();
      const double cos_alpha = glm::dot(out, Vec3(-in.x, -in.y, in.z));
      const double value = cos_alpha > 0.0 ? std::pow(cos_alpha, n) : 0.0;
      sum += value;
      squares += value * value;
    }
    const double mean = sum / count;
    const double error = std::sqrt((squares / count - mean * mean) / count);
    EXPECT_NEAR(mean_lobe_reflectance(n), mean, 4.0 * error + 1e-3 * mean) << n;
    EXPECT_LT(mean_lobe_reflectance(n), 2.0 / (n + 2.0));  // the limit at normal incidence
  }
}

TEST(SpreadReflectance, AddsTheLobeToWhatIsDiffuse) {
  tests::SceneBuilder builder;
  builder.material(tests::grey(0.3));
  Material glossy = tests::grey(0.1);
  glossy.specular = Rgb(0.2, 0.4, 0.0);
  glossy.shininess = 3.0;
  builder.material(glossy);
  const std::vector<Rgb> all = bihemispherical_albedos(builder.scene);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0], Rgb(0.3));
  const double lobe = mean_lobe_reflectance(3.0);
  EXPECT_EQ(all[1], Rgb(0.1) + Rgb(0.2, 0.4, 0.0) * lobe);
}

}  // namespace
}  // namespace earthshine::scenes
