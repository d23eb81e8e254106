// SPDX-License-Identifier: Apache-2.0
// Light that glass lets through: direct light of patches, camera samples and the path tracer
// against closed forms.
#include <gtest/gtest.h>

#include "tests/raytrace/light/lit_floor.h"

namespace earthshine::raytrace {
namespace {

using namespace lit_floor;

TEST(ThrownLight, SheetOfGlassLetsItsShareThrough) {
  // ior bends nothing in a sheet; the slant of the ray does not change the share.
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

// Of a blue lamp blue glass and a blue mirror hide nothing, whatever their luminance says: the flux
// that they pass on is what the samples found, and the scale that makes them agree is 1.
TEST(ThrownLight, FluxIsFollowedInItsColour) {
  const Rgb blue(0.0, 0.0, 1.0);
  for (const bool of_glass : {true, false}) {
    Floor scene;
    scenes::Material material = tests::grey(0.0);
    (of_glass ? material.transmit : material.mirror) = blue;
    material.two_sided = of_glass;
    scene.plate(scene.material(material), 8.0, of_glass ? 1.0 : 3.0, of_glass);
    scene.scene.lamps.push_back(point_lamp({0, 0, 2}, 100.0));
    scene.scene.lamps[0].intensity_cd *= blue;
    EXPECT_NEAR(find(scene.scene).scale, 1.0, 1e-3) << of_glass;
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
