// SPDX-License-Identifier: Apache-2.0
// Numerically difficult scenes. Most are in a closed furnace with M = 1 - rho everywhere: B = 1
// then solves B = M + rho F B for any shapes and reflectances if the form factors close.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/scene_builder.h"

namespace earthshine {
namespace {

using radiosity::Solution;
using radiosity::SolveOptions;
using tests::grey;

SolveOptions options(double edge_m = 0.25, int rays = 256) {
  SolveOptions o;
  o.patch_edge_m = edge_m;
  o.form_factor_rays = rays;
  return o;
}

std::uint32_t furnace(tests::SceneBuilder& builder, double rho, bool sheet = false) {
  scenes::Material m = grey(rho, 1.0 - rho);
  m.two_sided = sheet;
  return builder.material(m);
}

// Checks every patch and every object's mean. Values of patches are stored in single precision.
void expect_one_everywhere(const Solution& solution, double tolerance = 1e-8) {
  for (const float b : solution.radiosity) ASSERT_NEAR(b, 1.0, tolerance + 1e-7);
  for (const radiosity::ObjectLight& object : solution.report.objects) {
    ASSERT_NEAR(object.radiosity_lm_m2.g, 1.0, tolerance) << object.name;
  }
  for (const radiosity::GroupLedger& line : solution.report.groups) {
    EXPECT_LE(line.imbalance, 1e-12) << line.name;
  }
}

Solution solved(const tests::SceneBuilder& builder, const SolveOptions& how = options()) {
  return tests::Prepared(builder.scene).solve(how);
}

TEST(HardCase, AMillionReflectionsInAClosedRoom) {
  tests::SceneBuilder builder;
  const std::uint32_t m = furnace(builder, 0.999999);
  builder.room({m, m, m, m, m, m});
  expect_one_everywhere(solved(builder));
}

TEST(HardCase, NoReflectionAnywhere) {
  // B = M, and the floor's illuminance is F(floor, ceiling) M.
  tests::SceneBuilder builder;
  const std::uint32_t black = builder.material(grey(0.0)), lit = builder.material(grey(0.0, 5.0));
  builder.room({black, black, black, black, black, lit});
  const Solution s = solved(builder, options(0.25, 1024));
  EXPECT_NEAR(s.report.objects[5].radiosity_lm_m2.g, 5.0, 1e-12);
  EXPECT_EQ(s.report.objects[4].radiosity_lm_m2.g, 0.0);
  // 16 patches of 1024 rays, at most binomial errors: 4 * 5 * sqrt(0.2 * 0.8 / 16384).
  EXPECT_NEAR(s.report.objects[4].illuminance_lx.g, 5.0 * 0.19982489569838, 0.0625);
}

TEST(HardCase, BlackAndNearlyWhiteSideBySide) {
  tests::SceneBuilder builder;
  const std::uint32_t black = furnace(builder, 0.0), white = furnace(builder, 0.9999);
  builder.room({black, white, white, black, white, white});
  expect_one_everywhere(solved(builder));
}

TEST(HardCase, PatchAreasOverTenDecades) {
  // Plates from 2.5 um to 25 cm on a side in a room of 1 m. They reflect all light and emit none,
  // which a furnace allows; a few small emitters would be sampled instead of carried by F.
  tests::SceneBuilder builder;
  const std::uint32_t wall = furnace(builder, 0.8), plate = furnace(builder, 1.0, true);
  builder.room({wall, wall, wall, wall, wall, wall});
  double size = 0.25;
  for (int k = 0; k < 6; ++k, size /= 10.0) {
    const double x = 0.1 + 0.13 * k;
    builder.quad(plate, {x, 0.3, 0.5}, {x + size / 4, 0.3, 0.5}, {x + size / 4, 0.3 + size, 0.5},
                 {x, 0.3 + size, 0.5});
  }
  const Solution s = solved(builder, options(0.25, 1024));
  const auto [least, most] =
      std::minmax_element(s.patches.area_m2.begin(), s.patches.area_m2.end());
  EXPECT_GT(*most / *least, 1e10);
  expect_one_everywhere(s);
}

TEST(HardCase, PlatesATenThousandthOfTheirSizeApart) {
  // Facing unit squares at distance h = 1e-4, Howell C-11: F = 0.9998 to first order (each of four
  // edges loses h / 2). With M = 1 and rho = 0.9 on both, B = 1 / (1 - 0.9 F).
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(grey(0.9, 1.0));
  builder.plate(m, 1.0, 0.0, true);
  builder.plate(m, 1.0, 1e-4, false);
  const Solution s = solved(builder, options(0.25, 4096));
  const double x = 1e4, root = std::sqrt(1.0 + x * x);
  const double f = 2.0 / (base::pi * x * x) *
                   (0.5 * std::log(root * root * root * root / (1.0 + 2.0 * x * x)) +
                    2.0 * x * root * std::atan(x / root) - 2.0 * x * std::atan(x));
  EXPECT_NEAR(f, 0.9998, 1e-5);
  // dB / dF = 0.9 B^2 = 90; 32 patches of 4096 rays: binomial error of F at most 3.9e-5.
  EXPECT_NEAR(s.report.objects[0].radiosity_lm_m2.g, 1.0 / (1.0 - 0.9 * f), 4.0 * 90.0 * 3.9e-5);
}

TEST(HardCase, SheetsInOnePlaneThatOverlap) {
  tests::SceneBuilder builder;
  const std::uint32_t wall = furnace(builder, 0.9), sheet = furnace(builder, 0.3, true);
  builder.room({wall, wall, wall, wall, wall, wall});
  builder.quad(sheet, {0.2, 0.2, 0.5}, {0.6, 0.2, 0.5}, {0.6, 0.6, 0.5}, {0.2, 0.6, 0.5});
  builder.quad(sheet, {0.4, 0.4, 0.5}, {0.8, 0.4, 0.5}, {0.8, 0.8, 0.5}, {0.4, 0.8, 0.5});
  expect_one_everywhere(solved(builder));
}

TEST(HardCase, ABodyInsideABody) {
  // The outer body's faces point outward: the inner body sees only their black backs, so that its B
  // is its M. The room around them is still a furnace.
  tests::SceneBuilder builder;
  const std::uint32_t wall = furnace(builder, 0.7);
  builder.room({wall, wall, wall, wall, wall, wall});
  const auto body = [&builder](std::uint32_t m, double half) {
    tests::SceneBuilder box;
    box.room({m, m, m, m, m, m});
    for (std::size_t q = 0; q < 6; ++q) {
      std::array<Vec3, 4> c{};
      for (std::size_t k = 0; k < 4; ++k) {
        c[k] = Vec3(0.5) + 2.0 * half * (box.scene.vertices[4 * q + k] - Vec3(0.5));
      }
      builder.quad(m, c[0], c[3], c[2], c[1]);
    }
  };
  body(wall, 0.25);
  body(builder.material(grey(0.5, 3.0)), 0.1);
  const Solution s = solved(builder);
  for (std::size_t o = 0; o < 18; ++o) {
    EXPECT_NEAR(s.report.objects[o].radiosity_lm_m2.g, o < 12 ? 1.0 : 3.0, 1e-8) << o;
  }
  // All rays from the 6 patches of the inner body hit a back.
  const double inner = 6.0 / double(s.patches.count());
  EXPECT_NEAR(s.report.back_share, inner, 1e-12);
}

TEST(HardCase, NeedleTriangles) {
  tests::SceneBuilder builder;
  const std::uint32_t wall = furnace(builder, 0.9), sheet = furnace(builder, 1.0, true);
  builder.room({wall, wall, wall, wall, wall, wall});
  for (int k = 0; k < 5; ++k) {
    const double z = 0.3 + 0.1 * k, width = std::pow(10.0, -3 - k);
    // Four corners, two of which nearly coincide: two needles.
    builder.quad(sheet, {0.1, 0.5, z}, {0.9, 0.5, z}, {0.9, 0.5 + width, z + width},
                 {0.5, 0.5 + 0.9 * width, z + width});
  }
  expect_one_everywhere(solved(builder, options(0.1)));
}

TEST(HardCase, FarFromTheOriginAndVerySmall) {
  // A furnace at a thousand kilometres, and one of a millimetre.
  tests::SceneBuilder builder;
  const std::uint32_t dark = furnace(builder, 0.2), bright = furnace(builder, 0.999);
  builder.room({dark, bright, bright, bright, dark, bright});
  tests::SceneBuilder far = builder, small = builder;
  for (Vec3& p : far.scene.vertices) p += Vec3(1e6, -1e6, 1e6);
  for (Vec3& p : small.scene.vertices) p *= 1e-3;
  expect_one_everywhere(solved(far));
  expect_one_everywhere(solved(small, options(0.25e-3)));
}

scenes::Lamp lamp_at(const Vec3& where, double cd) {
  scenes::Lamp lamp;
  lamp.name = lamp.group = "lamp";
  lamp.position = where;
  lamp.intensity_cd = Rgb(cd);
  return lamp;
}

TEST(HardCase, ABillionBetweenTheSunAndANightLamp) {
  // Light groups are independent: the lamp's light, solved together with a Sun 1e9 times brighter,
  // is equal to its light alone.
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(grey(0.8));
  builder.room({m, m, m, m, m, m});
  builder.scene.triangles.resize(10);
  builder.scene.objects.pop_back();
  builder.scene.lamps.push_back(lamp_at({0.5, 0.5, 0.8}, 1e-4));
  const Solution alone = solved(builder);
  scenes::Sun sun;
  sun.direction = Vec3(0, 0, 1);
  sun.illuminance_lx = Rgb(133100.0);
  builder.scene.sun = sun;
  const tests::Prepared both(builder.scene);
  const Solution together = both.solve(options());
  std::size_t lamp = 0;
  while (both.groups.names[lamp] != "lamp") ++lamp;
  const std::size_t columns = together.columns;
  for (std::size_t i = 0; i < alone.patches.count(); ++i) {
    EXPECT_NEAR(together.radiosity[i * columns + 3 * lamp] / alone.radiosity[3 * i], 1.0, 1e-6);
  }
  for (const auto& line : together.report.groups) EXPECT_LE(line.imbalance, 1e-12) << line.name;
}

TEST(HardCase, ARoomWithAPinhole) {
  // A hole of 1 cm in a room with rho = 0.9999: all light ends in the walls or in the hole. B is
  // uniform within a per cent, except near the hole, so that M A = B A (1 - rho) + B A_hole gives
  // B = M / (1 - rho + A_hole / A).
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(grey(0.9999, 1.0));
  builder.room({m, m, m, m, m, m});
  builder.scene.vertices[21] = Vec3(0, 1, 1);
  builder.scene.vertices[22] = Vec3(0.99, 1, 1);  // the ceiling ends at x = 0.99
  builder.scene.vertices[23] = Vec3(0.99, 0, 1);
  builder.quad(m, {0.99, 0, 1}, {0.99, 0.99, 1}, {1, 0.99, 1}, {1, 0, 1});
  const Solution s = solved(builder, options(0.25, 16384));
  const double area = 6.0 - 1e-4, expected = 1.0 / (1e-4 + 1e-4 / area);
  EXPECT_NEAR(s.report.objects[4].radiosity_lm_m2.g / expected, 1.0, 0.02);
  EXPECT_GT(s.report.groups[0].escaped_lm.g, 0.0);
  EXPECT_LE(s.report.groups[0].imbalance, 1e-12);
}

TEST(HardCase, EveryFaceTwice) {
  tests::SceneBuilder builder;
  const std::uint32_t m = furnace(builder, 0.9);
  builder.room({m, m, m, m, m, m});
  builder.room({m, m, m, m, m, m});
  expect_one_everywhere(solved(builder));
}

TEST(HardCase, AFaceTheWrongWayRoundIsReportedWithTheShareOfRaysThatMetItsBack) {
  // The ceiling is reversed. From the floor and the walls a share F = 1/5 of the rays hits its
  // back; rays from the ceiling see the sky. Five of six faces send 0.2 of their rays to a back.
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(grey(0.5, 1.0));
  builder.room({m, m, m, m, m, m});
  std::swap(builder.scene.vertices[21], builder.scene.vertices[23]);
  const Solution s = solved(builder, options(0.25, 1024));
  EXPECT_NEAR(s.report.back_share, 5.0 * 0.2 / 6.0, 4.0 * std::sqrt(0.16 / (96.0 * 1024.0)));
  ASSERT_EQ(s.report.objects.size(), 6U);
  // All rays to the ceiling hit its back.
  EXPECT_EQ(s.report.objects[5].back_share, 1.0);
  EXPECT_EQ(s.report.objects[4].back_share, 0.0);
  EXPECT_LE(s.report.groups[0].imbalance, 1e-12);
}

TEST(HardCase, OnlySkyToSee) {
  // One patch under a vertical Sun: B = rho E, and all of it escapes.
  tests::SceneBuilder builder;
  builder.plate(builder.material(grey(0.5)), 1.0, 0.0, true);
  scenes::Sun sun;
  sun.direction = Vec3(0, 0, 1);
  sun.illuminance_lx = Rgb(1000.0);
  builder.scene.sun = sun;
  const Solution s = solved(builder, options(4.0));
  ASSERT_EQ(s.patches.count(), 1U);
  EXPECT_NEAR(s.radiosity[0], 500.0, 500.0 * 1e-4);  // cosine of the Sun's radius
  EXPECT_NEAR(s.report.groups[0].escaped_lm.g, s.report.objects[0].radiosity_lm_m2.g, 1e-9);
}

TEST(HardCase, NoLight) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(grey(1.0));
  builder.room({m, m, m, m, m, m});
  const Solution s = solved(builder);
  EXPECT_EQ(s.report.form_factor_rays, 0U);
  EXPECT_TRUE(s.radiosity.empty());
}

TEST(HardCase, ClosedRoomThatReflectsEverythingIsRefusedByName) {
  tests::SceneBuilder builder;
  scenes::Material perfect = grey(1.0);
  perfect.name = "perfect-white";
  const std::uint32_t m = builder.material(perfect);
  builder.room({m, m, m, m, m, m});
  builder.scene.lamps.push_back(lamp_at({0.5, 0.5, 0.8}, 1.0));
  try {
    solved(builder);
    FAIL() << "light can never end";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.blame(), base::Blame::Input);
    EXPECT_NE(std::string(error.what()).find("perfect-white"), std::string::npos) << error.what();
  }
  // Diffuse and mirror reflectance add up to 1: no light is absorbed or lost, also where rays end
  // after 64 steps (0.95^64 of them).
  tests::SceneBuilder mirrors = builder;
  for (const double mirror : {0.5, 0.95}) {
    mirrors.scene.materials[0].diffuse = Rgb(1.0 - mirror);
    mirrors.scene.materials[0].mirror = Rgb(mirror);
    EXPECT_THROW((void)solved(mirrors, options(0.25, 16)), base::Error) << mirror;
  }
  // With an opening the same material is valid.
  builder.scene.triangles.resize(10);
  builder.scene.objects.pop_back();
  EXPECT_LE(solved(builder).report.groups[0].imbalance, 1e-12);
}

}  // namespace
}  // namespace earthshine
