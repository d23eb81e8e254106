// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "scenes/reflect/energy.h"
#include "scenes/reflect/ggx_lobes.h"

namespace earthshine::scenes {
namespace {

// Albedo of GGX facets of reflectance 1 for light at `angle` to the normal: the integral of D G1 G1
// (i h) / cos i over the facet normals h, for tan h = a tan u.
double ggx_albedo(double a, double angle) {
  constexpr int steps = 200, turns = 64;
  const double ci = std::cos(angle), si = std::sin(angle);
  double sum = 0.0;
  for (int k = 0; k < steps; ++k) {
    const double u = (k + 0.5) / steps * base::pi / 2.0, t = a * std::tan(u);
    const double ch = 1.0 / std::sqrt(1.0 + t * t), sh = t * ch;
    const double step = a / (std::cos(u) * std::cos(u)) / (1.0 + t * t) * base::pi / 2.0 / steps;
    for (int j = 0; j < turns; ++j) {
      const double ih = si * sh * std::cos(base::pi * (j + 0.5) / turns) + ci * ch;
      const double co = 2.0 * ih * ch - ci;
      if (ih <= 0.0 || co <= 0.0) continue;
      // f cos out, over the solid angle 4 (i h) dh of the outgoing directions.
      sum += ggx_brdf(a, ci, co, ch) * co * 4.0 * ih * 2.0 * base::pi * sh * step / turns;
    }
  }
  return sum;
}

// Albedo of the lobe, with directions uniform in cos^(n + 1) alpha.
double lobe_albedo(const PhongLobe& lobe, double angle) {
  constexpr int steps = 200, turns = 64;
  const double ci = std::cos(angle), si = std::sin(angle);
  double sum = 0.0;
  for (int k = 0; k < steps; ++k) {
    const double ca = std::pow((k + 0.5) / steps, 1.0 / (lobe.shininess + 1.0));
    const double sa = std::sqrt(1.0 - ca * ca);
    for (int j = 0; j < turns; ++j) {
      const double co = ca * ci - sa * si * std::cos(base::pi * (j + 0.5) / turns);
      if (co > 0.0) sum += co / std::max(ci, co) / steps / turns;
    }
  }
  return lobe.diffuse + lobe.peak * 2.0 / (lobe.shininess + 1.0) * sum;
}

TEST(Microfacet, RoughestFacetsReflectWhatTheIntegralSays) {
  // a = 1: D = 1/pi, V = 1/(2 (1 + n v)) for light along the normal, so that
  // integral f cos = 2 pi integral_0^1 c / (2 pi (1 + c)) dc = 1 - ln 2.
  EXPECT_NEAR(ggx_albedo(1.0, 0.0), 1.0 - std::log(2.0), 1e-4);
}

TEST(Microfacet, ValueOffTheHighlightIsTheOneWorkedByHand) {
  // a^2 = 1/3, light along the normal, view at 60 degrees, half vector at 30: D = a^2 / (pi (1 -
  // 3/4 2/3)^2) = 4 / (3 pi), divided by (1 + 1) (1/2 + sqrt(1/3 + 2/3 1/4)) = 1 + sqrt 2.
  EXPECT_NEAR(ggx_brdf(std::sqrt(1.0 / 3.0), 1.0, 0.5, std::sqrt(0.75)),
              4.0 / (3.0 * base::pi * (1.0 + std::sqrt(2.0))), 1e-12);
}

TEST(Microfacet, LobesKeepTheAlbedoOfTheFacets) {
  // Largest relative differences at these angles (tests/validation/metal_lobes.py). Rough facets
  // reflect more of oblique light, which no lobe about the mirror direction does.
  struct Bound {
    double up_to, at_0_60, at_80;
  };
  constexpr Bound bounds[] = {{0.66, 0.06, 0.16}, {0.81, 0.07, 0.16}, {1.0, 0.23, 0.29}};
  for (int k = 1; k <= 40; ++k) {
    const double roughness = std::max(0.05, 0.025 * k), a = roughness * roughness;
    const Bound* bound = bounds;
    while (roughness > bound->up_to) ++bound;
    const PhongLobe lobe = phong_of_ggx(a);
    for (const double degrees : {0.0, 20.0, 40.0, 60.0, 80.0}) {
      const double angle = base::radians(degrees), facets = ggx_albedo(a, angle);
      EXPECT_NEAR(lobe_albedo(lobe, angle) / facets, 1.0,
                  degrees > 60.0 ? bound->at_80 : bound->at_0_60)
          << roughness << ", " << degrees;
    }
    EXPECT_LE(lobe.diffuse + lobe.albedo(), 1.0 + 1e-3) << roughness;
    EXPECT_GE(lobe.shininess, 4.0 - 1e-9);
  }
}

TEST(Microfacet, LobesSendBackAllOfEvenLightThatTheFacetsDo) {
  for (const double roughness : {0.46, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0}) {
    const PhongLobe lobe = phong_of_ggx(roughness * roughness);
    double facets = 0.0, own = 0.0;
    for (int k = 0; k < 20; ++k) {
      const double angle = std::acos(std::sqrt((k + 0.5) / 20));
      facets += ggx_albedo(roughness * roughness, angle) / 20;
      own += lobe_albedo(lobe, angle) / 20;
    }
    EXPECT_NEAR(own / facets, 1.0, 0.01) << roughness;
    EXPECT_NEAR(lobe.diffuse + lobe.peak * mean_lobe_reflectance(lobe.shininess, true), own, 0.01);
  }
}

TEST(Microfacet, LobesChangeWithoutAStep) {
  PhongLobe last = phong_of_ggx(0.05 * 0.05);
  for (double roughness = 0.0502; roughness <= 1.0; roughness += 0.0002) {
    const PhongLobe lobe = phong_of_ggx(roughness * roughness);
    EXPECT_NEAR(lobe.diffuse, last.diffuse, 2e-3) << roughness;
    EXPECT_NEAR(lobe.peak, last.peak, 0.02 * last.peak + 1e-3) << roughness;
    EXPECT_NEAR(lobe.shininess, last.shininess, 0.02 * last.shininess) << roughness;
    last = lobe;
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
