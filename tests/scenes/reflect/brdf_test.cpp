// SPDX-License-Identifier: Apache-2.0
#include "scenes/reflect/brdf.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/numbers/random.h"
#include "tests/support/scene_builder.h"

namespace earthshine::scenes {
namespace {

using base::pi;
using Term = Brdf::Term;

const Vec3 up(0, 0, 1);

Material glossy(double n, bool even) {
  Material material = tests::grey(0.2);
  material.specular = Rgb(0.1, 0.2, 0.3);
  material.shininess = n;
  material.even_lobe = even;
  return material;
}

Vec3 at_angle(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

Brdf seen_from(const Material& material, const Vec3& view) {
  return {material, material.diffuse, up, 2.0 * view.z * up - view, view.z};
}

// f(in, out) = f(out, in): alpha is the same from both sides, and so is the larger cosine.
TEST(Brdf, IsReciprocal) {
  const Vec3 a = at_angle(0.4, 0.3), b = at_angle(1.1, 3.3);
  for (const bool even : {false, true}) {
    const Material material = glossy(7.0, even);
    const Rgb there = seen_from(material, a).eval(b, b.z),
              back = seen_from(material, b).eval(a, a.z);
    ASSERT_GT(there.r, 0.2);
    EXPECT_NEAR(there.r, back.r, 1e-14);
    EXPECT_NEAR(there.b, back.b, 1e-14);
  }
}

// By definition f cos / pdf estimates the reflected light of a uniform unit sky.
TEST(Brdf, ASampleWeighsItsValueOverItsDensity) {
  base::Rng rng(base::Key(1, base::Stream::Test, 1));
  for (const bool even : {false, true}) {
    const Material material = glossy(7.0, even);
    const Brdf brdf = seen_from(material, at_angle(0.9, 0.3));
    for (int k = 0; k < 100; ++k) {
      const double u = rng.next(), v = rng.next();
      const auto [direction, weight] = brdf.sample(Term::Specular, u, v);
      if (direction.z <= 0.0) {
        EXPECT_EQ(weight, 0.0);
        continue;
      }
      const Rgb estimate = brdf.eval_specular(direction, direction.z) * direction.z /
                           (pi * brdf.pdf_per_sr(Term::Specular, direction));
      EXPECT_NEAR(estimate.b, 0.3 * weight, 1e-12);
      const auto diffuse = brdf.sample(Term::Diffuse, u, v);
      EXPECT_NEAR(diffuse.direction.z / (pi * brdf.pdf_per_sr(Term::Diffuse, diffuse.direction)),
                  diffuse.weight, 1e-12);
    }
  }
}

// Midpoints of 400 x 800 cells over all directions; the lobe is so oblique that part of it lies
// below the surface, which counts in its density.
TEST(Brdf, DensitiesIntegrateToOne) {
  const Material material = glossy(7.0, false);
  const Brdf brdf = seen_from(material, at_angle(0.9, 0.3));
  constexpr int rows = 400, columns = 800;
  double diffuse = 0.0, specular = 0.0;
  for (int i = 0; i < rows; ++i) {
    const double z = -1.0 + (2.0 * i + 1.0) / rows;
    for (int k = 0; k < columns; ++k) {
      const Vec3 direction = at_angle(std::acos(z), 2.0 * pi * (k + 0.5) / columns);
      diffuse += brdf.pdf_per_sr(Term::Diffuse, direction);
      specular += brdf.pdf_per_sr(Term::Specular, direction);
    }
  }
  constexpr double cell_sr = 4.0 * pi / (rows * columns);
  EXPECT_NEAR(diffuse * cell_sr, 1.0, 1e-4);
  EXPECT_NEAR(specular * cell_sr, 1.0, 1e-4);
}

// Viewed along the normal the larger cosine of an even lobe is 1, the view's, and the mean weight
// is the integral of cos^n cos / pi = 2 / (n + 2).
TEST(Brdf, SamplesAlongTheNormalReflectTheAlbedo) {
  constexpr int samples = 1 << 14;
  for (const bool even : {false, true}) {
    const Material material = glossy(7.0, even);
    const Brdf brdf = seen_from(material, up);
    base::Rng rng(base::Key(2, base::Stream::Test, even ? 1 : 0));
    double sum = 0.0, squares = 0.0;
    for (int k = 0; k < samples; ++k) {
      const double u = rng.next(), v = rng.next();
      const double weight = brdf.sample(Term::Specular, u, v).weight;
      sum += weight;
      squares += weight * weight;
    }
    const double mean = sum / samples;
    const double standard_error = std::sqrt((squares / samples - mean * mean) / samples);
    EXPECT_NEAR(mean, brdf.albedo(Term::Specular).g / 0.2, 4.0 * standard_error);
  }
}

// With density cos / pi the mean cosine is 2/3; midpoints of u: their error decreases as
// count^-1.5.
TEST(Brdf, CosineSamplesHaveAMeanCosineOfTwoThirds) {
  constexpr int count = 10000;
  double sum = 0.0;
  for (int k = 0; k < count; ++k) sum += cosine_sample((k + 0.5) / count, 0.3).z;
  EXPECT_NEAR(sum / count, 2.0 / 3.0, 1e-6);
  EXPECT_NEAR(glm::length(cosine_sample(0.3, 0.7)), 1.0, 1e-15);
  EXPECT_NEAR(glm::length(lobe_sample(20.0, 0.3, 0.7)), 1.0, 1e-15);
}

}  // namespace
}  // namespace earthshine::scenes
