// SPDX-License-Identifier: Apache-2.0
// Light through glass: direct light of patches, camera samples and the path tracer against closed
// forms.
#include <gtest/gtest.h>

#include "tests/raytrace/light/lit_floor.h"

namespace earthshine::raytrace {
namespace {

using namespace lit_floor;

TEST(ThrownLight, SheetOfGlassLetsItsShareThrough) {
  // ior bends nothing in a sheet; the ray's angle does not change the share.
  for (const Vec3& at : {Vec3(0, 0, 2), Vec3(1.5, 0.5, 2)}) {
    Floor scene;
    scene.plate(scene.material(glass(0.7, 1.5, true)), 8.0, 1.0, true);
    scene.scene.lamps.push_back(point_lamp(at, 100.0));
    expect_all(find(scene.scene), 0.7 * from_point(at, 100.0));
  }
}

TEST(ThrownLight, GlassKeepsColoursApart) {
  Floor scene;
  scenes::Material green = glass(0.0, 1.0, true);
  green.transmit = Rgb(0.1, 0.9, 0.4);
  scene.plate(scene.material(green), 8.0, 1.0, true);
  scene.scene.lamps.push_back(point_lamp({0, 0, 2}, 100.0));
  const tests::Prepared prepared(scene.scene);
  radiosity::SolveOptions solve;
  solve.patch_edge_m = 100.0;
  const Rgb lx = prepared.solve(solve).report.objects[0].illuminance_lx;
  EXPECT_NEAR(lx.r / lx.g, 1.0 / 9.0, 1e-9);
  EXPECT_NEAR(lx.b / lx.g, 4.0 / 9.0, 1e-9);
}

// Blue glass and a blue mirror block nothing of a blue lamp, whatever their luminance. A square of
// half edge a is seen from the height h above its centre under 4 atan(a^2 / (h sqrt(2 a^2 + h^2))):
// from the lamp at 2 m under a sixth of the sphere, from its image at 4 m under 0.0641.
TEST(ThrownLight, FluxIsFollowedInItsColour) {
  const auto share = [](double a, double h) {
    return std::atan(a * a / (h * std::sqrt(2.0 * a * a + h * h))) / base::pi;
  };
  const Rgb blue(0.0, 0.0, 1.0);
  for (const bool of_glass : {true, false}) {
    tests::SceneBuilder builder;
    builder.plate(builder.material(tests::grey(rho)), 4.0, 0.0, true);
    scenes::Material material = tests::grey(0.0);
    (of_glass ? material.transmit : material.mirror) = blue;
    material.two_sided = of_glass;
    builder.plate(builder.material(material), 8.0, of_glass ? 1.0 : 3.0, of_glass);
    builder.scene.lamps.push_back(point_lamp({0, 0, 2}, 100.0));
    builder.scene.lamps[0].intensity_cd *= blue;
    const tests::Prepared prepared(builder.scene);
    radiosity::SolveOptions options;
    options.patch_edge_m = 0.5;
    const radiosity::Solution solution = prepared.solve(options);
    const radiosity::SourceFlux& flux = solution.report.sources.at(0);
    const double exact = share(2.0, 2.0) + (of_glass ? 0.0 : share(2.0, 4.0));
    EXPECT_NEAR(flux.escaped_share, 1.0 - exact, 4.0 * flux.share_std_error) << of_glass;
    EXPECT_NEAR(flux.landed_lm.b / (400.0 * base::pi), exact, 4.0 * flux.share_std_error)
        << of_glass;
  }
}

TEST(ThrownLight, TwoPanesMultiplyAndAPlateOfTwoFacesIsTwo) {
  for (const bool sheets : {true, false}) {
    Floor scene;
    const std::uint32_t pane = scene.material(glass(0.6, 1.0, sheets));
    scene.plate(pane, 8.0, 1.0, false);
    scene.plate(pane, 8.0, 1.1, true);
    scene.scene.lamps.push_back(point_lamp({0.3, 0, 2}, 100.0));
    expect_all(find(scene.scene), 0.36 * from_point({0.3, 0, 2}, 100.0));
  }
}

// In one plane and in either order: an opaque plate stops light whatever lies on it.
TEST(ThrownLight, GlassOnAnOpaquePlateLetsNothingThrough) {
  for (const bool glass_first : {true, false}) {
    Floor scene;
    const std::uint32_t pane = scene.material(glass(0.9, 1.0, true)),
                        plate = scene.material(tests::grey(rho));
    for (const std::uint32_t m : {glass_first ? pane : plate, glass_first ? plate : pane}) {
      scene.plate(m, 8.0, 1.0, true);
    }
    scene.scene.lamps.push_back(point_lamp({0.3, 0, 2}, 100.0));
    expect_all(find(scene.scene), 0.0);
  }
}

TEST(ThrownLight, GlassThatBendsLightCastsAShadow) {
  Floor scene;
  const std::uint32_t pane = scene.material(glass(0.9, 1.5, false));
  scene.plate(pane, 8.0, 1.0, false);
  scene.plate(pane, 8.0, 1.1, true);
  scene.scene.lamps.push_back(point_lamp({0.3, 0, 2}, 100.0));
  expect_all(find(scene.scene), 0.0);
}

}  // namespace
}  // namespace earthshine::raytrace
