// SPDX-License-Identifier: Apache-2.0
// Measured luminaires as lamps of a scene.
#include <gtest/gtest.h>

#include <cmath>

#include "base/numbers/random.h"
#include "scenes/light/lamp_light.h"
#include "scenes/light/photometry.h"
#include "tests/scenes/scene_text.h"
#include "tests/support/ies_text.h"

namespace earthshine::scenes {
namespace {

using tests::IesText;
using tests::steps;

double cosine_of(double deg) { return std::cos(base::radians(deg)); }

const std::string luminaire =
    "format = 1\n[[light]]\nname = \"a\"\ntype = \"ies\"\nfile = \"a.ies\"\nposition = [1, 2, 3]\n"
    "aim = [1, 2, 0]\n";

Lamp read(const std::string& ies, const std::string& keys = {}) {
  const test::SceneFolder folder;
  folder.put("a.ies", ies);
  return folder.read(luminaire + keys).lamps.at(0);
}

std::string lamp_refusal(const std::string& ies, const std::string& keys = {}) {
  const test::SceneFolder folder;
  folder.put("a.ies", ies);
  return folder.refusal(luminaire + keys);
}

TEST(IesLamp, GivesTheFilesCandelasByInverseSquare) {
  // 45 deg off the aim, 5 m away: E = I(45) / 25.
  IesText file;
  file.candela = [](double theta, double) { return 1000.0 - 10.0 * theta; };
  const Lamp lamp = read(file.text());
  const Vec3 point = lamp.position + 5.0 * Vec3(0, std::sqrt(0.5), -std::sqrt(0.5));
  const LightSample sample = sample_lamp(lamp, point, 0.5, 0.5);
  EXPECT_NEAR(sample.normal_illuminance_lx.g, 550.0 / 25.0, 1e-9);
  EXPECT_NEAR(sample.distance_m, 5.0, 1e-12);
  EXPECT_EQ(sample_lamp(lamp, lamp.position + Vec3(0, 0.1, 1), 0, 0).normal_illuminance_lx.g, 0.0);
  EXPECT_FALSE(hit_lamp(lamp, point, sample.direction));
  EXPECT_EQ(lamp.source, "a.ies");
}

TEST(IesLamp, PlanesLieAsSeenFromAbove) {
  // Type C: horizontal angles increase counter-clockwise for a viewer behind the lamp who looks
  // along the axis; C0 is toward `up`. Aimed along -z with up = +y: C90 is +y rotated by 90 deg
  // about +z, -x.
  IesText file;
  file.horizontal = steps(0.0, 360.0, 90.0);
  file.candela = [](double, double phi) { return 100.0 + phi; };
  const Lamp lamp = read(file.text(), "up = [0, 5, 1]\n");
  const auto toward = [&](const Vec3& across) {
    const Vec3 way = across - Vec3(0, 0, 1);  // 45 deg off the axis
    return sample_lamp(lamp, lamp.position + way, 0, 0).normal_illuminance_lx.g *
           glm::dot(way, way);
  };
  EXPECT_NEAR(toward({0, 1, 0}), 100.0, 1e-6);
  EXPECT_NEAR(toward({-1, 0, 0}), 190.0, 1e-6);
  EXPECT_NEAR(toward({0, -1, 0}), 280.0, 1e-6);
  EXPECT_NEAR(toward({1, 0, 0}), 370.0, 1e-6);
  EXPECT_EQ(read(file.text()).c0, Vec3(1, 0, 0));  // default of the scene
}

TEST(IesLamp, FluxRescalesAndColorTints) {
  IesText file;  // 100 cd below: 200 pi lm
  EXPECT_NEAR(lamp_flux_lm(read(file.text())).r, 200.0 * base::pi, 1e-9);
  const Rgb flux = lamp_flux_lm(read(file.text(), "flux = [500, 250, 0]\n"));
  EXPECT_NEAR(flux.r, 500.0, 1e-9);
  EXPECT_NEAR(flux.g, 250.0, 1e-9);
  EXPECT_EQ(flux.b, 0.0);
  // The luminous flux does not depend on the hue.
  const Rgb tinted = lamp_flux_lm(read(file.text(), "color = [4, 2, 1]\n"));
  EXPECT_NEAR(base::luminance(tinted), 200.0 * base::pi, 1e-9);
  EXPECT_NEAR(tinted.r / tinted.b, 4.0, 1e-12);
}

TEST(IesLamp, TiltFactorDimsIt) {
  IesText file;
  file.tilt = "TILT=INCLUDE\n1\n2\n0 90\n1.0 0.8\n";
  EXPECT_NEAR(read(file.text()).intensity_cd.g, 100.0, 1e-12);
  EXPECT_NEAR(read(file.text(), "tilt_deg = 45\n").intensity_cd.g, 90.0, 1e-12);
}

TEST(IesLamp, WhatDoesNotFitIsRefused) {
  const std::string good = IesText().text();
  EXPECT_TRUE(test::holds(lamp_refusal(good, "up = [0, 0, 2]\n"), {"scene.toml:8:1", "parallel"}));
  EXPECT_TRUE(test::holds(lamp_refusal(good, "tilt_deg = 3\n"), {"scene.toml:8:1", "TILT=NONE"}));
  EXPECT_TRUE(
      test::holds(lamp_refusal(good, "flux = 1\ncolor = 1\n"), {"scene.toml:9:1", "\"flux\""}));
  EXPECT_TRUE(test::holds(lamp_refusal(good, "color = 0\n"), {"scene.toml:8:1", "black"}));
  EXPECT_TRUE(test::holds(lamp_refusal(good, "intensity = 3\n"), {"scene.toml:8:1", "\"ies\""}));
  EXPECT_TRUE(test::holds(lamp_refusal("IESNA91\n"), {"a.ies", "TILT="}));
  const test::SceneFolder empty;
  EXPECT_TRUE(test::holds(empty.refusal(luminaire), {"scene.toml:5:1", "a.ies", "No such file"}));
}

TEST(IesLamp, CosineDistributionIsALambertDiskFromAfar) {
  // A disk of area A and exitance M has I = (M A / pi) cos theta if its radius is small against the
  // distance: 1 cm at 10 m has an error of 1e-6. The table's steps of 1 deg have an error of
  // (pi/180)^2 / 8 = 4e-5 of the peak.
  IesText file;
  file.vertical = steps(0.0, 90.0, 1.0);
  file.candela = [](double theta, double) { return 50.0 * cosine_of(theta); };
  const Lamp measured = read(file.text());
  Lamp disk;
  disk.kind = LampKind::Disk;
  disk.position = measured.position;
  disk.axis = measured.axis;
  disk.radius_m = 0.01;
  disk.exitance = Rgb(50.0 / (0.01 * 0.01));
  EXPECT_NEAR(lamp_flux_lm(measured).g / lamp_flux_lm(disk).g, 1.0, 4e-5);
  for (const double theta : {0.0, 20.5, 45.0, 70.3, 89.5}) {
    const Vec3 way(std::sin(base::radians(theta)), 0.0, -cosine_of(theta));
    const Vec3 point = measured.position + 10.0 * way;
    const double a = sample_lamp(measured, point, 0.5, 0.5).normal_illuminance_lx.g;
    const double b = sample_lamp(disk, point, 0.0, 0.5).normal_illuminance_lx.g;  // its centre
    EXPECT_NEAR(a, b, 0.5 * 4e-5) << theta;
  }
}

TEST(IesLamp, EmittedRaysFollowTheIntensity) {
  // Mean direction of the rays against the mean of the intensity, Lambertian about the axis: 2/3
  // along it, 0 across. Independent rays of unit length: standard error below 1 / sqrt(N).
  IesText file;
  file.vertical = steps(0.0, 90.0, 1.0);
  file.candela = [](double theta, double) { return 50.0 * cosine_of(theta); };
  const Lamp lamp = read(file.text(), "up = [0, 1, 0]\n");
  base::Rng rng(base::Key(1, base::Stream::Test, 66));
  const int count = 100000;
  Vec3 mean(0.0);
  for (int n = 0; n < count; ++n) {
    const double x = rng.next(), y = rng.next();
    const EmittedRay ray = emit_from_lamp(lamp, 0.0, 0.0, x, y);
    ASSERT_EQ(ray.weight, 1.0);
    ASSERT_EQ(ray.origin, lamp.position);
    mean += ray.direction / double(count);
  }
  EXPECT_NEAR(glm::length(mean - 2.0 / 3.0 * lamp.axis), 0.0, 4.0 / std::sqrt(double(count)));
}

}  // namespace
}  // namespace earthshine::scenes
