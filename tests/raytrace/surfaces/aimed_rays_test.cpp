// SPDX-License-Identifier: Apache-2.0
// Some of a solve's gather rays are aimed at bright patches.
#include <gtest/gtest.h>

#include <cmath>

#include "radiosity/fill_solution.h"
#include "raytrace/surfaces/surface_light.h"
#include "tests/studies/room.h"

namespace earthshine::raytrace {
namespace {

// Mean illuminance of patch 0 by gather rays over all passes, its standard error, and the standard
// deviation of one pass.
struct Brought {
  double mean = 0.0, error = 0.0, deviation = 0.0;
};

// From patch 1, of 1000 lm/m2, above a dark ground.
Brought from_the_square(tests::SceneBuilder& builder, std::uint32_t ground, double ground_m,
                        const SampleBudget& budget) {
  builder.plate(ground, 2.0, ground_m, true);
  scenes::Lamp lamp;  // provides a group for the light
  lamp.name = lamp.group = "lamp";
  lamp.position = Vec3(0.0, 0.0, 0.3);
  lamp.intensity_cd = Rgb(1.0);
  builder.scene.lamps.push_back(lamp);
  const tests::Prepared prepared(builder.scene);
  radiosity::SolveOptions options;
  options.patch_edge_m = 2.0;
  options.form_factor_rays = 64;
  radiosity::FormFactors factors;
  radiosity::Solution solved = radiosity::solve_keeping(
      prepared, options, radiosity::subdivide(builder.scene, 2.0), {}, factors);
  SurfaceLight light =
      LightOnSurfaces(prepared, std::move(solved), std::move(factors), 64.0).light();
  std::vector<float>& b = light.solution.radiosity;
  std::fill(b.begin(), b.end(), 0.0F);
  std::fill_n(&b[light.columns()], 3, 1000.0F);
  const std::vector<std::uint32_t> which = {0};
  const std::vector<SampleBudget> efforts = {budget};
  double sum = 0.0, squares = 0.0;
  constexpr std::uint32_t passes = 256;
  for (std::uint32_t pass = 1; pass <= passes; ++pass) {
    const SurfaceSamples samples =
        SurfaceSampler(prepared, 1).sample(light, which, efforts, pass, 1.0, nullptr);
    const double lx = samples.gathered[1];  // grey
    sum += lx / passes;
    squares += lx * lx / passes;
  }
  const double deviation = std::sqrt(squares - sum * sum);
  return {sum, deviation / std::sqrt(passes - 1.0), deviation};
}

constexpr double square_edge = 0.05, plate_edge = 0.04;

// A square of area A at height h gives the place beneath it B A / (pi h^2), and at horizontal
// distance x (h^2 / (h^2 + x^2))^2 of it, on average 1 - 2 <x^2> / h^2 with <x^2> = (a^2 + b^2) / 6
// for squares of edges a and b. One of 1257 cosine-distributed rays finds it: the 32 of a sample
// alone have a standard deviation of sqrt(1257 / 32) = 6 times that, with four aimed rays a tenth.
TEST(AimedRays, WhatASmallBrightPatchSendsIsFound) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.plate(m, plate_edge, 0.0, true);
  builder.plate(m, square_edge, 1.0, false);
  const double area = square_edge * square_edge;
  const double exact = 1000.0 * area / base::pi * (1.0 - (area + plate_edge * plate_edge) / 3.0);
  const Brought found = from_the_square(builder, m, -1.0, {2, 8});
  EXPECT_NEAR(found.mean, exact, 4.0 * found.error);
  EXPECT_LT(found.deviation, 0.1 * exact);
}

// Glass that reflects more than it transmits acts as a mirror: no aimed ray reaches by it a square
// 0.3 m beside the plate, and cosine-distributed rays have full weight. By the image, 1 m above,
// with cosines 1 / d and d^2 = 1.09: B A / (pi d^4).
TEST(AimedRays, WhatAMirrorShowsThatIsGlassTooIsLeftToCosineRays) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.plate(m, plate_edge, 0.0, true);
  const double h = square_edge / 2;
  builder.quad(m, {0.3 - h, -h, 0}, {0.3 + h, -h, 0}, {0.3 + h, h, 0}, {0.3 - h, h, 0});
  scenes::Material pane = tests::grey(0.0);
  pane.mirror = Rgb(0.6);
  pane.transmit = Rgb(0.4);
  pane.two_sided = true;
  builder.plate(builder.material(pane), 2.0, 0.5, true);
  const double exact = 1000.0 * square_edge * square_edge / (base::pi * 1.09 * 1.09);
  const Brought found = from_the_square(builder, m, -0.001, {16, 32});
  EXPECT_NEAR(found.mean, exact, 4.0 * found.error);
  EXPECT_LT(found.error, 0.1 * exact);
}

}  // namespace
}  // namespace earthshine::raytrace
