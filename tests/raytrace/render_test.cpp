// SPDX-License-Identifier: Apache-2.0
#include "raytrace/render.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"
#include "tests/support/scene_builder.h"

namespace earthshine::raytrace {
namespace {

// A camera straight above the origin that sees a spot of about `size` metres there.
scenes::Camera above(double height_m, double size_m = 0.002) {
  scenes::Camera camera;
  camera.position = Vec3(0, 0, height_m);
  camera.look_at = Vec3(0.0);
  camera.up = Vec3(0, 1, 0);
  camera.fov_deg = base::degrees(2.0 * std::atan(size_m / 2 / height_m));
  return camera;
}

Frame picture(const scenes::Scene& scene, const scenes::Camera& camera,
              const RenderOptions& options, double patch_edge_m = 0.25) {
  const tests::Prepared prepared(scene);
  radiosity::Solution solution;
  if (options.indirect == Indirect::Radiosity) {
    radiosity::SolveOptions solve;
    solve.patch_edge_m = patch_edge_m;
    solution = prepared.solve(solve);
  }
  return render(prepared, solution, camera, options);
}

RenderOptions pixels(int columns, int rows, int gather_rays = 64) {
  RenderOptions options;
  options.columns = columns;
  options.rows = rows;
  options.gather_rays = gather_rays;
  return options;
}

double mean(const Frame& frame, const char* channel = "G") {
  const auto& values = frame.image.find(channel)->values;
  double sum = 0.0;
  for (const float v : values) sum += double(v);
  return sum / static_cast<double>(values.size());
}

scenes::Sun sun_at(double zenith_deg, double radius_deg = 0.0) {
  scenes::Sun sun;
  const double a = base::radians(zenith_deg);
  sun.direction = Vec3(std::sin(a), 0.0, std::cos(a));
  sun.angular_radius_deg = radius_deg;
  return sun;
}

TEST(Render, SunlitDiffusePlateHasRadianceRhoECosOverPi) {
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 1.0, 0.0, true);
  builder.scene.sun = sun_at(60.0);
  const double exact = 0.5 * 133100.0 * 0.5 / base::pi;
  EXPECT_NEAR(mean(picture(builder.scene, above(2.0), pixels(4, 4))) / exact, 1.0, 1e-6);
}

TEST(Render, PointLampOnAPlateIsExact) {
  // 500 cd at 2 m above the visible spot: L = rho I / (pi d^2); the spot of 2 mm changes it by
  // 1e-6.
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.8)), 1.0, 0.0, true);
  scenes::Lamp lamp;
  lamp.name = lamp.group = "lamp";
  lamp.position = Vec3(0, 0, 2);
  lamp.intensity_cd = Rgb(500.0);
  builder.scene.lamps.push_back(lamp);
  const double exact = 0.8 * 500.0 / 4.0 / base::pi;
  EXPECT_NEAR(mean(picture(builder.scene, above(1.5), pixels(4, 4))) / exact, 1.0, 3e-6);
}

TEST(Render, PhongHighlightAtTheMirrorAngleAddsKs) {
  // pi L / (E cos) = k_d + k_s in the mirror direction: camera and Sun both on the normal.
  tests::SceneBuilder builder;
  scenes::Material glossy = tests::grey(0.3);
  glossy.specular = Rgb(5.0);
  glossy.shininess = 50.0;
  builder.plate(builder.material(glossy), 1.0, 0.0, true);
  builder.scene.sun = sun_at(0.0);
  EXPECT_NEAR(mean(picture(builder.scene, above(2.0), pixels(4, 4))) * base::pi / 133100.0, 5.3,
              1e-3);
}

TEST(Render, PhongHighlightFallsWithTheCosinesPower) {
  // Sun 20 deg off the normal, camera on it: alpha = 20 deg.
  tests::SceneBuilder builder;
  scenes::Material glossy = tests::grey(0.3);
  glossy.specular = Rgb(0.6);
  glossy.shininess = 12.0;
  builder.plate(builder.material(glossy), 1.0, 0.0, true);
  builder.scene.sun = sun_at(20.0);
  const double c = std::cos(base::radians(20.0));
  const double exact = 133100.0 * c / base::pi * (0.3 + 0.6 * std::pow(c, 12.0));
  EXPECT_NEAR(mean(picture(builder.scene, above(2.0), pixels(4, 4))) / exact, 1.0, 1e-3);
}

TEST(Render, FurnaceLooksTheSameEverywhereInEveryPixel) {
  // Closed room of rho 0.8 and M = 0.2: radiance 1 / pi in every direction.
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.8, 0.2));
  builder.room({m, m, m, m, m, m});
  scenes::Camera camera;
  camera.position = Vec3(0.1, 0.4, 0.5);
  camera.look_at = Vec3(1, 0.5, 0.3);
  camera.fov_deg = 80.0;
  const Frame frame = picture(builder.scene, camera, pixels(16, 16, 16));
  for (const float v : frame.image.find("R")->values) EXPECT_NEAR(v * base::pi, 1.0, 1e-5);
}

TEST(Render, FurnaceWithMirrorAndGlassIsStillUniform) {
  // Every mechanism must conserve energy: a lobe of k_s = 0.2, n = 2 on k_d = 0.6 reflects less
  // near grazing, so that only mirror and clear glass keep the furnace exact.
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.8, 0.2));
  scenes::Material mirror = tests::grey(0.0);
  mirror.mirror = Rgb(1.0);
  const std::uint32_t silver = builder.material(mirror);
  scenes::Material window = tests::grey(0.0);
  window.transmit = Rgb(1.0);
  window.two_sided = true;
  const std::uint32_t glass = builder.material(window);
  builder.room({m, m, silver, m, m, m});
  builder.quad(glass, {0.6, 0.1, 0.1}, {0.6, 0.9, 0.1}, {0.6, 0.9, 0.9}, {0.6, 0.1, 0.9});
  scenes::Camera camera;
  camera.position = Vec3(0.1, 0.4, 0.5);
  camera.look_at = Vec3(1, 0.3, 0.3);
  camera.fov_deg = 90.0;
  const Frame frame = picture(builder.scene, camera, pixels(16, 16, 16));
  for (const float v : frame.image.find("R")->values) EXPECT_NEAR(v * base::pi, 1.0, 1e-4);
  EXPECT_GT(frame.report.rays.mirror, 0U);
}

TEST(Render, UniformEarthOnANadirPlateIsPiLTimesTheViewFactorTimesRhoOverPi) {
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 1.0, 0.0, true);
  scenes::Earth earth;
  earth.half_angle_deg = base::degrees(std::asin(6371.0 / 6796.0));
  earth.model = scenes::EarthModel::Uniform;
  earth.radiance = Rgb(1000.0);
  builder.scene.earth = earth;
  const double share = std::pow(6371.0 / 6796.0, 2);
  const Frame frame = picture(builder.scene, above(2.0), pixels(8, 8, 64));
  // 64 pixels x 64 rays, each escaping to the disc with probability `share`.
  const double std_error = std::sqrt(share * (1.0 - share) / 4096.0);
  EXPECT_NEAR(mean(frame) / 500.0, share, 4.0 * std_error);
}

TEST(Render, MirrorShowsTheLampSurfaceBehindTheCamera) {
  tests::SceneBuilder builder;
  scenes::Material mirror = tests::grey(0.0);
  mirror.mirror = Rgb(0.9);
  builder.plate(builder.material(mirror), 1.0, 0.0, true);
  scenes::Lamp lamp;
  lamp.name = lamp.group = "panel";
  lamp.kind = scenes::LampKind::Rectangle;
  lamp.position = Vec3(0, 0, 5);
  lamp.edge_u = Vec3(0, 1, 0);
  lamp.edge_v = Vec3(1, 0, 0);
  lamp.axis = Vec3(0, 0, -1);
  lamp.exitance = Rgb(100.0);
  builder.scene.lamps.push_back(lamp);
  const Frame frame = picture(builder.scene, above(2.0), pixels(2, 2));
  EXPECT_NEAR(mean(frame), 0.9 * 100.0 / base::pi, 1e-3);
}

TEST(Render, CameraSeesTheEarthsOwnRadiance) {
  scenes::Scene empty;
  scenes::Earth earth;
  earth.direction = Vec3(0, 0, -1);
  earth.half_angle_deg = 30.0;
  earth.model = scenes::EarthModel::Uniform;
  earth.radiance = Rgb(12000.0);
  empty.earth = earth;
  EXPECT_NEAR(mean(picture(empty, above(2.0), pixels(2, 2))), 12000.0, 1e-2);
}

TEST(Render, LightGroupLayersAddUpToTheBeautyImage) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.6));
  builder.room({m, m, m, m, m, m});
  for (int k = 0; k < 3; ++k) {
    scenes::Lamp lamp;
    lamp.name = lamp.group = "lamp" + std::to_string(k);
    lamp.position = Vec3(0.25 * (k + 1), 0.5, 0.7);
    lamp.intensity_cd = Rgb(10.0, 5.0 * k, 1.0);
    builder.scene.lamps.push_back(lamp);
  }
  scenes::Camera camera;
  camera.position = Vec3(0.1, 0.4, 0.5);
  camera.look_at = Vec3(1, 0.5, 0.3);
  RenderOptions options = pixels(16, 16, 16);
  options.denoise = false;  // which weights points by the noise of all light together
  const Frame together = picture(builder.scene, camera, options);
  options.per_light = true;
  const Frame apart = picture(builder.scene, camera, options);
  for (const char* channel : {"R", "G", "B"}) {
    for (std::size_t p = 0; p < 256; ++p) {
      double sum = 0.0;
      for (const char* group : {"light_lamp0.", "light_lamp1.", "light_lamp2."}) {
        sum += double(apart.image.find(std::string(group) + channel)->values[p]);
      }
      const double whole = apart.image.find(channel)->values[p];
      EXPECT_NEAR(sum / whole, 1.0, 1e-6);
      EXPECT_NEAR(together.image.find(channel)->values[p] / whole, 1.0, 1e-5);
    }
  }
}

TEST(Render, SameBytesOnOneAndTwoThreads) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.6, 0.1));
  builder.room({m, m, m, m, m, m});
  scenes::Camera camera;
  camera.position = Vec3(0.1, 0.4, 0.5);
  camera.look_at = Vec3(1, 0.5, 0.3);
  builder.scene.sun = sun_at(10.0);
  std::vector<Frame> frames;
  for (const int threads : {1, 2}) {
    const base::ThreadLimit limit(threads);
    frames.push_back(picture(builder.scene, camera, pixels(40, 24, 16)));
  }
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(frames[0].image.channels[c].values, frames[1].image.channels[c].values);
  }
}

TEST(Render, DirectLightAloneCastsGatherRaysOnlyForAWideEarth) {
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 1.0, 0.0, true);
  builder.scene.sun = sun_at(30.0);
  RenderOptions options = pixels(4, 4);
  options.indirect = Indirect::None;
  EXPECT_EQ(picture(builder.scene, above(2.0), options).report.rays.gather, 0U);
}

TEST(Render, DistributedLightsConvergeToTheEarthsDisc) {
  // N equal lights over the disc on an open plate: E = (pi L sin^2) within the error of the
  // Fibonacci lattice, which for a smooth integrand at N = 1024 is below 1e-3.
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 1.0, 0.0, true);
  scenes::Earth earth;
  earth.half_angle_deg = 70.0;
  earth.model = scenes::EarthModel::Uniform;
  earth.radiance = Rgb(1000.0);
  builder.scene.earth = earth;
  RenderOptions options = pixels(2, 2);
  options.indirect = Indirect::Distributed;
  options.distributed_lights = 1024;
  const double exact = 500.0 * std::pow(std::sin(base::radians(70.0)), 2);
  EXPECT_NEAR(mean(picture(builder.scene, above(2.0), options)) / exact, 1.0, 1e-3);
}

TEST(Render, AovsDescribeTheFirstSurfaceAlongThePixelsCentre) {
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 1.0, 0.0, true);
  RenderOptions options = pixels(3, 3);
  options.aovs = aov_names();
  const Frame frame = picture(builder.scene, above(2.0, 4.0), options);
  const auto at = [&](const char* channel, std::size_t pixel) {
    return frame.image.find(channel)->values[pixel];
  };
  EXPECT_NEAR(at("Z", 4), 2.0, 1e-6);
  EXPECT_NEAR(at("N.Z", 4), 1.0, 1e-6);
  EXPECT_NEAR(at("albedo.R", 4), 0.5, 1e-7);
  EXPECT_EQ(at("object", 4), 0.0F);
  EXPECT_EQ(at("object", 0), -1.0F);  // the corners are beside the plate
  EXPECT_TRUE(std::isinf(at("Z", 0)));
}

TEST(Render, UnknownAovNamesTheNearest) {
  RenderOptions options = pixels(1, 1);
  options.aovs = {"dept"};
  try {
    (void)picture(scenes::Scene{}, above(1.0), options);
    FAIL();
  } catch (const base::Error& error) {
    EXPECT_NE(std::string(error.what()).find("\"depth\""), std::string::npos);
  }
}

TEST(Render, DarkSceneIsBlackAndCastsOnlyCameraRays) {
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 1.0, 0.0, true);
  const Frame frame = picture(builder.scene, above(2.0), pixels(4, 4));
  EXPECT_EQ(mean(frame), 0.0);
  EXPECT_EQ(frame.report.rays.total(), frame.report.rays.camera);
}

}  // namespace
}  // namespace earthshine::raytrace
