// SPDX-License-Identifier: Apache-2.0
// Strips of light thinner than a pixel, and the witness' statement where samples find none.
#include "raytrace/witness/strips.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "raytrace/render.h"
#include "raytrace/shade/shading_setup.h"
#include "raytrace/witness/witness.h"
#include "tests/support/scene_builder.h"

namespace earthshine::raytrace {
namespace {

constexpr int slot_px = 48;  // width and height of the pictures

// A floor of 4 m under a lid with a slot along y, in a Sun without extent.
struct Slot {
  tests::SceneBuilder builder;
  scenes::Camera camera;
  double low, high;

  explicit Slot(double width) : low(2.0 - 0.5 * width), high(2.0 + 0.5 * width) {
    const std::uint32_t m = builder.material(tests::grey(0.6));
    builder.quad(m, {0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0});
    builder.quad(m, {0, 0, 0.5}, {low, 0, 0.5}, {low, 4, 0.5}, {0, 4, 0.5});
    builder.quad(m, {high, 0, 0.5}, {4, 0, 0.5}, {4, 4, 0.5}, {high, 4, 0.5});
    scenes::Sun sun;
    sun.direction = glm::normalize(Vec3(0.0, -0.3, 1.0));
    sun.angular_radius_deg = 0.0;
    builder.scene.sun = sun;
    camera.position = Vec3(0.3, 0.3, 0.3);
    camera.look_at = Vec3(3.0, 3.0, 0.1);
    camera.fov_deg = 50.0;
  }
  // Direct light at a film position, cd/m^2.
  [[nodiscard]] double light(const CameraModel& model, double x, double y) const {
    const Ray ray = model.ray(x, y, 0.5, 0.5);
    if (ray.direction.z >= 0.0) return 0.0;
    const Vec3 at = ray.origin - ray.origin.z / ray.direction.z * ray.direction;
    const scenes::Sun& sun = *builder.scene.sun;
    const Vec3 in_slot = at + 0.5 / sun.direction.z * sun.direction;
    const bool lit = at.x >= 0.0 && at.x <= 4.0 && at.y >= 0.0 && at.y <= 4.0 && in_slot.x > low &&
                     in_slot.x < high && in_slot.y > 0.0 && in_slot.y < 4.0;
    return lit ? 0.6 * sun.illuminance_lx.g * sun.direction.z / base::pi : 0.0;
  }
};

// "A line of sunlight on the floor, 2 cm wide: a pixel whose samples all missed it counts as
// finished." Truth: 128 x 128 positions of each pixel, from the slot's position toward the Sun. 8
// seeds with a few tens of pixels each give the mean square to 1/4.
TEST(LightStrips, ALineOfSunlightIsKnownToTheWantedError) {
  for (const double width : {0.02, 0.005}) {
    const Slot slot(width);
    const tests::Prepared prepared(slot.builder.scene);
    radiosity::SolveOptions solve;
    solve.patch_edge_m = 1.0;
    solve.form_factor_rays = 16;
    const radiosity::Solution solution = prepared.solve(solve);
    const CameraModel model = make_camera_model(slot.camera, slot_px, slot_px);
    constexpr int fine = 128;
    std::vector<double> truth;
    double mean = 0.0;
    for (int p = 0; p < slot_px * slot_px; ++p) {
      double sum = 0.0;
      for (int k = 0; k < fine * fine; ++k) {
        sum += slot.light(model, p % slot_px + (k % fine + 0.5) / fine,
                          p / slot_px + (k / fine + 0.5) / fine);
      }
      truth.push_back(sum / (fine * fine));
      mean += truth.back() / (slot_px * slot_px);
    }
    constexpr int seeds = 8;
    double squares = 0.0;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
      RenderOptions options;
      options.columns = options.rows = slot_px;
      options.indirect = Indirect::None;
      options.error = 0.05;
      options.seed = seed;
      const Frame frame = render(prepared, solution, slot.camera, options);
      EXPECT_EQ(frame.report.unexplained_pixels, 0U);
      const std::vector<float>& light = frame.image.find("G")->values;
      for (std::size_t p = 0; p < truth.size(); ++p) {
        const double off = error_weight(truth[p], mean) * (double(light[p]) - truth[p]) / mean;
        squares += off * off / (seeds * slot_px * slot_px);
      }
    }
    EXPECT_LT(std::sqrt(squares), 0.05 * std::sqrt(1.0 + 4.0 / 4.0)) << width;
  }
}

// A cube has 12 edges; its diagonals are within faces. Seen from beyond a corner 6 edges are
// outlines, from in front of a face 4.
TEST(SceneEdges, OutlinesOfACube) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.room({m, m, m, m, m, m});
  const std::vector<SceneEdge> edges = find_edges(builder.scene);
  EXPECT_EQ(edges.size(), 12U);
  const auto outlines = [&](const Vec3& from, bool is_distant) {
    return std::ranges::count_if(
        edges, [&](const SceneEdge& edge) { return edge.is_outline(from, is_distant); });
  };
  EXPECT_EQ(outlines(Vec3(3.0, 4.0, 5.0), false), 6);
  EXPECT_EQ(outlines(glm::normalize(Vec3(3.0, 4.0, 5.0)), true), 6);
  EXPECT_EQ(outlines(Vec3(0.5, 0.5, 5.0), false), 4);
}

// Pixels divide a spot's light among them and lose none.
TEST(SpotMap, DividesASpotAmongPixels) {
  scenes::Camera camera;
  camera.look_at = Vec3(1, 0, 0);
  const CameraModel model = make_camera_model(camera, 8, 8);
  for (const double radius : {0.0, 0.2, 0.45}) {
    SpotMap map(model, 1.0);
    Spot spot;
    spot.film = {4.0, 3.4};
    spot.radius_px = radius;
    spot.area_px2 = 0.02;
    spot.luminance = 50.0;
    map.add(spot);
    double light = 0.0;
    for (int p = 0; p < 64; ++p) light += map.at(p % 8, p / 8).light;
    EXPECT_NEAR(light, 0.02 * 50.0, 1e-9) << radius;
  }
}

// A lamp of 1 cm in front of black walls; its pixel has 64 samples or more that find nothing, or
// its light.
TEST(Witness, LightThatNoSampleFindsIsStated) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.0));
  builder.room({m, m, m, m, m, m});
  scenes::Lamp lamp;
  lamp.name = lamp.group = "lamp";
  lamp.kind = scenes::LampKind::Disk;
  lamp.position = Vec3(0.9, 0.507, 0.483);
  lamp.axis = Vec3(-1, 0, 0);
  lamp.radius_m = 0.005;
  lamp.exitance = Rgb(1000.0 * base::pi);
  builder.scene.lamps.push_back(lamp);
  scenes::Camera camera;
  camera.position = Vec3(0.2, 0.5, 0.5);
  camera.look_at = Vec3(1.0, 0.5, 0.5);
  camera.fov_deg = 60.0;
  const tests::Prepared prepared(builder.scene);
  RenderOptions options;
  options.columns = options.rows = slot_px;
  const radiosity::Solution solution = prepared.solve({});
  ShadingSetup setup(prepared, solution, camera, options);
  const Witness witness(setup.shared(), setup.camera(), {0.05, 0.0, 0.0, false, {}});
  PixelSums sums(Window{0, 0, slot_px, slot_px}, 1, false);
  sums.samples = witness.wanted(sums);
  const auto pixel =
      static_cast<std::size_t>(std::ranges::max_element(sums.samples) - sums.samples.begin());
  ASSERT_GT(sums.samples[pixel], 64U);
  const std::vector<float> none(sums.samples.size(), 0.0F);
  const std::vector<float> missing = witness.unexplained(sums, none);
  ASSERT_FALSE(missing.empty());
  // L = 1000 cd/m^2 times the image: pi (0.005 px / 0.7)^2, px pixels for a tangent of 1.
  const double px = slot_px / 2.0 / std::tan(base::radians(30.0));
  const double light = 1000.0 * base::pi * std::pow(0.005 * px / 0.7, 2);
  double sum = 0.0;
  for (const float one : missing) sum += double(one);
  EXPECT_NEAR(sum, light, 0.02 * light);
  for (std::size_t p = 0; p < sums.samples.size(); ++p) {
    sums.luminance[p] = light * sums.samples[p];
  }
  EXPECT_TRUE(witness.unexplained(sums, none).empty());
}

// The Sun shines through a hole of 4 mm into a room, and no sample finds the reflection of the spot.
// The four edges of the hole report a quarter of its light each.
TEST(Witness, ReflectedLightThatNoPathFindsIsStated) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.6));
  scenes::Material sheet = tests::grey(0.6);
  sheet.two_sided = true;
  const std::uint32_t lid = builder.material(sheet);
  const std::array<double, 4> at = {0.0, 0.998, 1.002, 2.0};
  builder.quad(m, {0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0});
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (i == 1 && j == 1) continue;
      builder.quad(lid, {at[i], at[j], 2}, {at[i + 1], at[j], 2}, {at[i + 1], at[j + 1], 2},
                   {at[i], at[j + 1], 2});
    }
  }
  scenes::Sun sun;
  sun.direction = Vec3(0, 0, 1);
  sun.angular_radius_deg = 0.0;
  builder.scene.sun = sun;
  scenes::Camera camera;  // sees the lid's inner side about (0.6, 0.6), in pictures of 8 and 80 px
  camera.position = Vec3(0.5, 0.5, 0.5);
  camera.look_at = Vec3(0.6, 0.6, 2.0);
  camera.up = Vec3(1, 0, 0);
  camera.fov_deg = 5.0;
  // From the spot at (1, 1, 0) to the lid at (0.6, 0.6, 2): d^2 = 4.32, both cosines 2 / d.
  const double intensity =
      0.6 * sun.illuminance_lx.g / base::pi * (at[2] - at[1]) * (at[2] - at[1]);
  const double light = intensity * (4.0 / 4.32) / 4.32 * 0.6 / base::pi;
  for (const int px : {8, 80}) {
    const auto pixels = static_cast<std::size_t>(px) * static_cast<std::size_t>(px);
    const tests::Prepared prepared(builder.scene);
    RenderOptions options;
    options.columns = options.rows = px;
    const radiosity::Solution solution = prepared.solve({});
    ShadingSetup setup(prepared, solution, camera, options);
    const Witness witness(setup.shared(), setup.camera(), {0.05, 1e-6, 0.0, false, {}});
    const PixelSums sums(Window{0, 0, px, px}, 1, false);
    const std::vector<float> missing = witness.unexplained(sums, std::vector<float>(pixels, 0.0F));
    ASSERT_EQ(missing.size(), pixels);
    double square = 0.0;
    for (const float one : missing) square += double(one) * double(one);
    EXPECT_NEAR(std::sqrt(square / double(pixels)) / light, 1.0, 0.05) << px;
    const std::vector<float> half(pixels, static_cast<float>(0.5 * light));
    EXPECT_TRUE(witness.unexplained(sums, half).empty()) << px;
    // A crop has its own pixels of the picture.
    const PixelSums crop(Window{px / 2, 0, px / 2, px}, 1, false);
    EXPECT_EQ(witness.unexplained(crop, std::vector<float>(pixels / 2, 0.0F)).size(), pixels / 2);
  }
}

}  // namespace
}  // namespace earthshine::raytrace
