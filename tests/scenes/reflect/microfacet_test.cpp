// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "base/units.h"
#include "scenes/reflect/energy.h"
#include "scenes/reflect/specular.h"

namespace earthshine::scenes {
namespace {

TEST(Microfacet, RoughestFacetsReflectWhatTheIntegralSays) {
  // a = 1: D = 1/pi, V = 1/(2 (1 + n v)) for light along the normal, so that
  // integral f cos = 2 pi integral_0^1 c / (2 pi (1 + c)) dc = 1 - ln 2.
  EXPECT_NEAR(ggx_albedo(1.0), 1.0 - std::log(2.0), 1e-6);
}

TEST(Microfacet, ValueOffTheHighlightIsTheOneWorkedByHand) {
  // a^2 = 1/3, light along the normal, view at 60 degrees, half way at 30: D = a^2 / (pi (1 - 3/4
  // 2/3)^2) = 4 / (3 pi), divided by (1 + 1) (1/2 + sqrt(1/3 + 2/3 1/4)) = 1 + sqrt 2.
  EXPECT_NEAR(ggx_brdf(std::sqrt(1.0 / 3.0), 1.0, 0.5, std::sqrt(0.75)),
              4.0 / (3.0 * base::pi * (1.0 + std::sqrt(2.0))), 1e-12);
}

TEST(Microfacet, SmoothFacetsReflectAll) {
  EXPECT_NEAR(ggx_albedo(0.0025), 1.0, 1e-4);
  double last = 1.0;
  for (const double a : {0.01, 0.1, 0.3, 0.6, 1.0}) {
    EXPECT_LT(ggx_albedo(a), last);
    last = ggx_albedo(a);
  }
}

TEST(Microfacet, LobeHasThePeakAndTheAlbedoOfTheFacets) {
  for (const double a : {0.0025, 0.04, 0.25, 0.6}) {
    const PhongLobe lobe = phong_of_ggx(a);
    EXPECT_NEAR(lobe.peak, base::pi * ggx_brdf(a, 1.0, 1.0, 1.0), 1e-9 * lobe.peak);
    EXPECT_NEAR(2.0 * lobe.peak / (lobe.shininess + 2.0), ggx_albedo(a), 1e-9);
  }
}

TEST(Energy, WhatReflectsTooMuchIsDividedByItsLargestSum) {
  Material material;
  material.diffuse = {1.0, 0.5, 0.0};
  material.specular = Rgb(1.0);
  material.shininess = 10.0;  // albedo of the lobe: 2/12
  material.mirror = Rgb(0.25);
  material.transmit = Rgb(1.0 / 12.0);
  EXPECT_DOUBLE_EQ(conserve_energy(material), 1.5);  // 1 + 1/6 + 1/4 + 1/12
  EXPECT_DOUBLE_EQ(base::max_component(reflected_share(material)), 1.0);
  EXPECT_DOUBLE_EQ(material.diffuse.r, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(material.diffuse.g, 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(material.specular.b, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(material.mirror.b, 1.0 / 6.0);
  EXPECT_DOUBLE_EQ(material.transmit.b, 1.0 / 18.0);
  EXPECT_EQ(conserve_energy(material), 1.0);
}

}  // namespace
}  // namespace earthshine::scenes
