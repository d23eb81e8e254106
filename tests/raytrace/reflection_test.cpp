// SPDX-License-Identifier: Apache-2.0
// Reflected light: bright patches, glossy surfaces.
#include <gtest/gtest.h>

#include <cmath>

#include "raytrace/render.h"
#include "tests/support/scene_builder.h"

namespace earthshine::raytrace {
namespace {

double mean_green(const scenes::Scene& scene, const scenes::Camera& camera, double patch_edge_m) {
  const tests::Prepared prepared(scene);
  radiosity::SolveOptions solve;
  solve.patch_edge_m = patch_edge_m;
  RenderOptions options;
  options.columns = options.rows = 8;
  options.gather_rays = 64;
  const Frame frame = render(prepared, prepared.solve(solve), camera, options);
  double sum = 0.0;
  for (const float v : frame.image.find("G")->values) sum += double(v);
  return sum / 64.0;
}

TEST(Reflection, SmallBrightPatchLightsAPlateByItsFormFactor) {
  // A ceiling plate of 0.1 m, 1 m above the visible point, lit from 0.3 m below by a narrow spot
  // lamp that the floor does not see: L = rho B F / pi, F from a point to a parallel square on its
  // axis. One gather ray in 300 finds it by chance; it must be neither lost nor counted twice by
  // the rays aimed at it.
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 0.002, 0.0, true);
  builder.plate(builder.material(tests::grey(0.5)), 0.1, 1.0, false);
  builder.plate(builder.material(tests::grey(0.0)), 20.0, -1.0,
                true);  // all other surfaces are black
  scenes::Lamp lamp;
  lamp.name = lamp.group = "spot";
  lamp.kind = scenes::LampKind::Spot;
  lamp.position = Vec3(0.3, 0.0, 0.7);
  lamp.axis = glm::normalize(Vec3(0, 0, 1) - lamp.position);
  lamp.intensity_cd = Rgb(1000.0);
  lamp.beam_deg = lamp.field_deg = 40.0;
  builder.scene.lamps.push_back(lamp);
  scenes::Camera camera;
  camera.position = Vec3(0.0, 0.5, 0.5);
  camera.look_at = Vec3(0.0);
  camera.up = Vec3(0, 0, 1);
  camera.fov_deg = 0.05;

  const tests::Prepared prepared(builder.scene);
  radiosity::SolveOptions solve;
  solve.patch_edge_m = 0.1;
  const double b = prepared.solve(solve).report.objects[1].radiosity_lm_m2.g;
  const double x = 0.05 / std::sqrt(1.0 + 0.05 * 0.05);
  const double form_factor = 4.0 * x * std::atan(x) / base::pi;
  // The aimed rays' integrand varies by less than 1 % over the small plate; 64 pixels with 8 of
  // them each.
  EXPECT_NEAR(mean_green(builder.scene, camera, 0.1) / (0.5 * b * form_factor / base::pi), 1.0,
              4.0 * 0.01);
}

// A small glossy plate in a large furnace of radiance 1 / pi, seen along its normal:
// pi L = k_d + (2 k_s / (n + 2)), the second term the integral of (k_s / pi) cos^(n+1) over the
// hemisphere.
void expect_glossy_albedo(double exponent, double specular) {
  tests::SceneBuilder builder;
  const std::uint32_t wall = builder.material(tests::grey(0.7, 0.3));
  builder.room({wall, wall, wall, wall, wall, wall});
  for (Vec3& p : builder.scene.vertices) p = 20.0 * (p - Vec3(0.5));
  scenes::Material glossy = tests::grey(0.2);
  glossy.specular = Rgb(specular);
  glossy.shininess = exponent;
  builder.plate(builder.material(glossy), 0.01, 0.0, true);
  scenes::Camera camera;
  camera.position = Vec3(0, 0, 2);
  camera.look_at = Vec3(0.0);
  camera.up = Vec3(0, 1, 0);
  camera.fov_deg = 0.1;
  const double expected = 0.2 + 2.0 * specular / (exponent + 2.0);
  // 2048 lobe rays whose weights 2 k_s cos / (n + 1) have a standard deviation of about their
  // mean / (n + 2).
  const double std_error = 2.0 * specular / (exponent + 2.0) / (exponent + 2.0) / std::sqrt(2048.0);
  EXPECT_NEAR(base::pi * mean_green(builder.scene, camera, 5.0), expected, 4.0 * std_error + 1e-5);
}

TEST(Reflection, BroadLobeReflectsItsAlbedoOfAUniformSurrounding) {
  expect_glossy_albedo(10.0, 3.0);
}

TEST(Reflection, SharpLobeReflectsItsAlbedoOfAUniformSurrounding) {
  expect_glossy_albedo(400.0, 120.0);
}

TEST(Reflection, TheAmbientTermIsInMirrorsAndInNoLobe) {
  // A floor that only reflects, under a ceiling of k_d 0.5 lit only by the ambient term of 10
  // cd/m2: a mirror of 0.4 shows 0.4 x 5, a lobe of any exponent nothing.
  for (const double shininess : {0.0, 50.0, 200.0}) {
    tests::SceneBuilder builder;
    scenes::Material floor = tests::grey(0.0);
    floor.mirror = Rgb(shininess > 0.0 ? 0.0 : 0.4);
    floor.specular = Rgb(shininess > 0.0 ? 0.4 : 0.0);
    floor.shininess = shininess;
    builder.plate(builder.material(floor), 1.0, 0.0, true);
    builder.plate(builder.material(tests::grey(0.5)), 4.0, 1.0, false);
    builder.scene.ambient_radiance = Rgb(10.0);
    scenes::Lamp lamp;  // above the ceiling, so that rays are cast at all
    lamp.name = lamp.group = "lamp";
    lamp.position = Vec3(0.0, 0.0, 1.5);
    lamp.intensity_cd = Rgb(1.0);
    builder.scene.lamps.push_back(lamp);
    scenes::Camera camera;
    camera.position = Vec3(0.0, 0.4, 0.5);
    camera.look_at = Vec3(0.0);
    camera.fov_deg = 10.0;
    EXPECT_NEAR(mean_green(builder.scene, camera, 1.0), shininess > 0.0 ? 0.0 : 2.0, 1e-6)
        << shininess;
  }
}

}  // namespace
}  // namespace earthshine::raytrace
