// SPDX-License-Identifier: Apache-2.0
// Sources smaller than a pixel, in black rooms: the sum of the picture over its pixels is the
// source's luminance times its image's area in px^2. With n independent samples that each hit it
// with probability 64 / n, the relative error is at most 1 / 8; stratified samples have less.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numeric>

#include "raytrace/render.h"
#include "scenes/light/lamp_light.h"
#include "tests/support/scene_builder.h"

namespace earthshine::raytrace {
namespace {

constexpr int pixels_across = 32, source_seeds = 16;
constexpr double source_exitance = 1000.0, distance_m = 0.7, side_m = 0.01;

scenes::Camera into_room() {
  scenes::Camera camera;
  camera.position = Vec3(0.2, 0.5, 0.5);
  camera.look_at = Vec3(1.0, 0.5, 0.5);
  camera.fov_deg = 60.0;
  return camera;
}

tests::SceneBuilder black_room() {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.0));
  builder.room({m, m, m, m, m, m});
  return builder;
}

// 0.7 m in front of the camera, facing it, off the centre of a pixel.
const Vec3 source_place(0.9, 0.507, 0.483);

void add_lamp(scenes::Scene& scene, scenes::LampKind kind) {
  scenes::Lamp lamp;
  lamp.name = lamp.group = "lamp";
  lamp.kind = kind;
  lamp.position = source_place;
  lamp.axis = Vec3(-1, 0, 0);
  lamp.edge_u = Vec3(0, 0, side_m);
  lamp.edge_v = Vec3(0, side_m, 0);
  lamp.radius_m = side_m / std::sqrt(base::pi);
  lamp.exitance = Rgb(source_exitance);
  scene.lamps.push_back(lamp);
}

// cells x cells emitting quads of that edge.
void add_emitters(tests::SceneBuilder& builder, int cells, double edge) {
  const std::uint32_t m = builder.material(tests::grey(0.0, source_exitance));
  for (int k = 0; k < cells * cells; ++k) {
    const Vec3 a = source_place + Vec3(0, k % cells * edge, k / cells * edge);
    const Vec3 y(0, edge, 0), z(0, 0, edge);
    builder.quad(m, a, a + z, a + y + z, a + y);
  }
}

RenderOptions options_of(std::uint64_t seed) {
  RenderOptions options;
  options.columns = options.rows = pixels_across;
  options.gather_rays = 16;
  options.seed = seed;
  return options;
}

Frame source_picture(const scenes::Scene& scene, const scenes::Camera& camera,
                     const RenderOptions& options) {
  const tests::Prepared prepared(scene);
  radiosity::SolveOptions solve;
  solve.patch_edge_m = 1.0;
  solve.form_factor_rays = 16;
  return render(prepared, prepared.solve(solve), camera, options);
}

double sum_of(const Frame& frame) {
  const std::vector<float>& light = frame.image.find("G")->values;
  return std::accumulate(light.begin(), light.end(), 0.0);
}

void expect_sum(const scenes::Scene& scene, const scenes::Camera& camera, double expected,
                const std::function<void(RenderOptions&)>& how, double hits = 64.0) {
  std::vector<double> sums;
  for (std::uint64_t seed = 1; seed <= source_seeds; ++seed) {
    RenderOptions options = options_of(seed);
    how(options);
    sums.push_back(sum_of(source_picture(scene, camera, options)));
  }
  const double mean = std::accumulate(sums.begin(), sums.end(), 0.0) / source_seeds;
  double squares = 0.0;
  for (const double sum : sums) squares += (sum - mean) * (sum - mean);
  const double deviation = std::sqrt(squares / (source_seeds - 1));
  EXPECT_NEAR(mean, expected, 4.0 * deviation / std::sqrt(double(source_seeds)));
  // A standard deviation from 16 values has the relative error 1 / sqrt(2 * 15).
  EXPECT_LT(deviation, expected / std::sqrt(hits) * (1.0 + 4.0 / std::sqrt(30.0)));
}

// Of a square of side_m at distance_m, in a flat picture plane.
double image_px2() {
  const double px = pixels_across / 2.0 / std::tan(base::radians(30.0));
  return std::pow(side_m * px / distance_m, 2);
}

const std::vector<std::function<void(RenderOptions&)>>& every_way() {
  static const std::vector<std::function<void(RenderOptions&)>> ways = {
      [](RenderOptions& options) { options.camera_samples = 4; },
      [](RenderOptions& options) { options.error = 0.05; }};
  return ways;
}

TEST(SmallSources, LampsAndEmittersSendWhatTheirImagesHold) {
  ASSERT_LT(image_px2(), 0.2);
  const double expected = source_exitance / base::pi * image_px2();
  for (const auto& how : every_way()) {
    for (const auto kind : {scenes::LampKind::Disk, scenes::LampKind::Rectangle}) {
      tests::SceneBuilder builder = black_room();
      add_lamp(builder.scene, kind);
      expect_sum(builder.scene, into_room(), expected, how);
    }
    tests::SceneBuilder builder = black_room();
    add_emitters(builder, 1, side_m);
    expect_sum(builder.scene, into_room(), expected, how);
  }
}

// A spot of a fifth of a degree or less lights a few mm of a wall 0.8 m in front of the camera,
// with an image of at most a hundredth of a pixel. A flux Phi is reflected with the intensity rho
// Phi / pi toward the camera, and px^2 per square metre are constant in the picture.
TEST(SmallSources, NarrowBeamsSendWhatTheirSpotsHold) {
  const double px_per_m = pixels_across / 2.0 / std::tan(base::radians(30.0)) / 0.8;
  for (const double field_deg : {0.05, 0.2}) {
    tests::SceneBuilder builder;
    const std::uint32_t black = builder.material(tests::grey(0.0)),
                        white = builder.material(tests::grey(0.5));
    builder.room({black, white, black, black, black, black});
    scenes::Lamp spot;
    spot.name = spot.group = "spot";
    spot.kind = scenes::LampKind::Spot;
    spot.position = Vec3(0.3, 0.8, 0.6);
    spot.axis = glm::normalize(Vec3(1.0, 0.507, 0.483) - spot.position);
    spot.beam_deg = 0.5 * field_deg;
    spot.field_deg = field_deg;
    spot.intensity_cd = Rgb(1e6);
    builder.scene.lamps.push_back(spot);
    const double expected = 0.5 * scenes::lamp_flux_lm(spot).g / base::pi * px_per_m * px_per_m;
    for (const auto& how : every_way()) expect_sum(builder.scene, into_room(), expected, how);
  }
}

TEST(SmallSources, ALensSpreadsTheSame) {
  tests::SceneBuilder builder = black_room();
  add_lamp(builder.scene, scenes::LampKind::Disk);
  scenes::Camera camera = into_room();
  camera.focus_m = 0.4;
  camera.aperture_m = 0.15;
  // The blur's radius, px (depth_of_field_test.cpp); each of its pixels hits the lamp 64 times.
  const double blur = 0.5 * camera.aperture_m * std::sqrt(image_px2()) / side_m *
                      std::abs(distance_m - camera.focus_m) / camera.focus_m;
  EXPECT_GT(blur, 2.0);
  expect_sum(builder.scene, camera, source_exitance / base::pi * image_px2(), every_way().back(),
             64.0 * base::pi * blur * blur);
}

TEST(SmallSources, ASunIsOne) {
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.0)), 0.1, 10.0, true);
  scenes::Sun sun;
  sun.direction = glm::normalize(Vec3(1.0, 0.01, -0.02));
  builder.scene.sun = sun;
  // E = L times the solid angle, which near the axis is the area in a plane at unit distance.
  const double px = pixels_across / 2.0 / std::tan(base::radians(30.0));
  expect_sum(builder.scene, into_room(), sun.illuminance_lx.g * px * px, every_way().back());
}

TEST(SmallSources, HiddenOnesAndPartsOfLargeOnesTakeNoMoreSamples) {
  const auto samples = [](const tests::SceneBuilder& builder) {
    RenderOptions options = options_of(1);
    options.error = 0.05;
    return source_picture(builder.scene, into_room(), options).report.most_camera_samples;
  };
  tests::SceneBuilder lamp = black_room();
  add_lamp(lamp.scene, scenes::LampKind::Disk);
  EXPECT_GT(samples(lamp), 256);
  tests::SceneBuilder hidden = black_room();
  add_lamp(hidden.scene, scenes::LampKind::Disk);
  const std::uint32_t m = hidden.material(tests::grey(0.0));
  hidden.quad(m, {0.8, 0.4, 0.4}, {0.8, 0.4, 0.6}, {0.8, 0.6, 0.6}, {0.8, 0.6, 0.4});
  EXPECT_LE(samples(hidden), 64);
  tests::SceneBuilder mesh = black_room();
  add_emitters(mesh, 20, side_m);
  EXPECT_LE(samples(mesh), 64);
}

// The following cases are those of "rare light": pictures of up to 24 x 24 pixels that missed all
// of such light in every seed, with stated errors of 5 %.

// The Sun in a flat mirror: its image has the Sun's solid angle; near the axis, where the camera
// looks, E times the mirror's reflectance is its luminance times its area in a plane at unit
// distance. Four pixels share it.
TEST(SmallSources, TheSunsImageInAFlatMirrorIsOne) {
  tests::SceneBuilder builder;
  scenes::Material mirror = tests::grey(0.0);
  mirror.mirror = Rgb(0.8);
  builder.plate(builder.material(mirror), 1.0, 0.1, true);
  scenes::Sun sun;
  sun.direction = glm::normalize(Vec3(0.0, 2.0, 1.0));
  builder.scene.sun = sun;
  scenes::Camera camera;
  camera.position = Vec3(0.0, -2.0, 1.1);
  camera.look_at = Vec3(0.0, 0.0, 0.1);
  camera.fov_deg = 25.0;
  const double px = pixels_across / 2.0 / std::tan(base::radians(12.5));
  expect_sum(builder.scene, camera, 0.8 * sun.illuminance_lx.g * px * px, every_way().back());
}

// A plate whose lobe of exponent n mirrors the Sun within a hundredth of a pixel's solid angle:
// L = E cos k_s cos^n(alpha) / pi, over all directions 2 pi / (n + 1).
TEST(SmallSources, AHighlightSmallerThanAPixelIsOne) {
  tests::SceneBuilder builder;
  scenes::Material glossy = tests::grey(0.0);
  glossy.specular = Rgb(1000.0);
  glossy.shininess = 20000.0;
  builder.plate(builder.material(glossy), 1.0, 0.1, true);
  scenes::Sun sun;
  sun.direction = glm::normalize(Vec3(0.01, 2.0, 1.02));
  sun.angular_radius_deg = 0.0;
  builder.scene.sun = sun;
  scenes::Camera camera;
  camera.position = Vec3(0.0, -2.0, 1.1);
  camera.look_at = Vec3(0.0, 0.0, 0.1);
  camera.fov_deg = 60.0;
  const double px = pixels_across / 2.0 / std::tan(base::radians(30.0));
  const double expected = 2.0 * sun.illuminance_lx.g * sun.direction.z * 1000.0 / 20001.0 * px * px;
  expect_sum(builder.scene, camera, expected, every_way().back(), 16.0);
}

// Half a millimetre of an emitter is visible beside a sheet, a tenth of a pixel or less in all.
TEST(SmallSources, ASliverBesideASheetIsOne) {
  for (const double width : {0.0005, 0.002}) {
    tests::SceneBuilder builder;
    builder.quad(builder.material(tests::grey(0.0, source_exitance)), {-0.2, 0.5, 0.7},
                 {0.2, 0.5, 0.7}, {0.2, 0.5, 1.0}, {-0.2, 0.5, 1.0});
    const double edge = 0.2 - width;
    builder.quad(builder.material(tests::grey(0.0)), {-0.3, 0.499, 0.6}, {edge, 0.499, 0.6},
                 {edge, 0.499, 1.1}, {-0.3, 0.499, 1.1});
    scenes::Camera camera;
    camera.position = Vec3(0.2, -2.0, 0.85);  // sees the edge of the sheet end on
    camera.look_at = Vec3(0.2, 0.5, 0.85);
    camera.fov_deg = 25.0;
    const double px_per_m = pixels_across / 2.0 / std::tan(base::radians(12.5)) / 2.5;
    // The camera is in the plane of the emitter's edge: the sheet is 1 mm nearer, and its edge
    // hides 0.4 per mille more than its width there.
    const double seen = 0.2 - (0.2 - width * 2.5 / 2.499);
    const double expected = source_exitance / base::pi * seen * 0.3 * px_per_m * px_per_m;
    expect_sum(builder.scene, camera, expected, every_way().back());
  }
}

// The border of the picture cuts an emitter: 0.05 px of it are inside, over a height of 0.3 m.
TEST(SmallSources, ASliverAtTheBorderOfThePictureIsOne) {
  tests::SceneBuilder builder;
  const double half = 2.5 * std::tan(base::radians(12.5));  // m, half of the picture at 2.5 m
  const double px_per_m = pixels_across / 2.0 / half;
  const double low = half - 0.05 / px_per_m;
  builder.quad(builder.material(tests::grey(0.0, source_exitance)), {low, 0.5, 0.7},
               {low + 0.5, 0.5, 0.7}, {low + 0.5, 0.5, 1.0}, {low, 0.5, 1.0});
  scenes::Camera camera;
  camera.position = Vec3(0.0, -2.0, 0.85);
  camera.look_at = Vec3(0.0, 0.5, 0.85);
  camera.fov_deg = 25.0;
  const double expected = source_exitance / base::pi * 0.05 * 0.3 * px_per_m;
  expect_sum(builder.scene, camera, expected, every_way().back());
}

// An emitter that faces away from the camera is seen in a mirror at y = 0.5; a sheet
// 1 mm before it hides all but 1 mm. The image is 3.5 m away: 2.5 m to the mirror and 1 m back.
TEST(SmallSources, ASliverInAFlatMirrorIsOne) {
  tests::SceneBuilder builder;
  scenes::Material silvered = tests::grey(0.0);
  silvered.mirror = Rgb(0.7);
  builder.quad(builder.material(silvered), {-1, 0.5, 0}, {1, 0.5, 0}, {1, 0.5, 2}, {-1, 0.5, 2});
  builder.quad(builder.material(tests::grey(0.0, source_exitance)), {0.5, -0.5, 0.7},
               {0.25, -0.5, 0.7}, {0.25, -0.5, 1.0}, {0.5, -0.5, 1.0});
  scenes::Material black = tests::grey(0.0);
  black.two_sided = true;
  const double edge = 0.499;
  builder.quad(builder.material(black), {0.24, -0.499, 0.6}, {edge, -0.499, 0.6},
               {edge, -0.499, 1.1}, {0.24, -0.499, 1.1});
  scenes::Camera camera;
  camera.position = Vec3(0.0, -2.0, 0.85);
  camera.look_at = Vec3(0.0, 0.5, 0.85);
  camera.fov_deg = 25.0;
  const double px_per_m = pixels_across / 2.0 / std::tan(base::radians(12.5)) / 3.5;
  // From the mirrored camera the edge of the sheet, 3.499 m away, hides up to 0.499 * 3.5 / 3.499.
  const double seen = 0.5 - edge * 3.5 / 3.499;
  const double expected = 0.7 * source_exitance / base::pi * seen * 0.3 * px_per_m * px_per_m;
  expect_sum(builder.scene, camera, expected, every_way().back());
}

}  // namespace
}  // namespace earthshine::raytrace
