// SPDX-License-Identifier: Apache-2.0
// Lamps closer to a surface than the width of a pixel: the picture has all of their light.
#include "raytrace/light/footprint.h"

#include <gtest/gtest.h>

#include "tests/raytrace/light/lit_floor.h"

namespace earthshine::raytrace {
namespace {

using namespace lit_floor;

constexpr int side_px = 12, seed_count = 16;

struct NearLampRoom {
  tests::SceneBuilder scene;
  scenes::Camera camera;

  // 4 m of floor seen at 45 degrees; pixels of about 0.1 m.
  explicit NearLampRoom(const Vec3& lamp) {
    scene.plate(scene.material(tests::grey(rho)), 4.0, 0.0, true);
    scene.scene.lamps.push_back(point_lamp(lamp, 1.0));
    camera.position = Vec3(0.2, -2, 2);
    camera.look_at = Vec3(0.0);
    camera.fov_deg = 24.0;
  }
};

struct DrawnMean {
  double value = 0.0, std_error = 0.0;
};

DrawnMean drawn(const scenes::Scene& scene, const scenes::Camera& camera) {
  const tests::Prepared prepared(scene);
  radiosity::SolveOptions solve;
  solve.patch_edge_m = 100.0;
  const radiosity::Solution solution = prepared.solve(solve);
  RenderOptions options;
  options.columns = options.rows = side_px;
  options.indirect = Indirect::None;
  double sum = 0.0, sum2 = 0.0;
  for (int seed = 1; seed <= seed_count; ++seed) {
    options.seed = static_cast<std::uint64_t>(seed);
    double mean = 0.0;
    const base::Image image = render(prepared, solution, camera, options).image;
    for (const float g : image.find("G")->values) mean += double(g) / (side_px * side_px);
    sum += mean;
    sum2 += mean * mean;
  }
  const double mean = sum / seed_count;
  return {mean, std::sqrt(std::max(0.0, sum2 / seed_count - mean * mean) / (seed_count - 1))};
}

// The integral over the film of L = rho E / pi, E = I cos / r^2 on the floor: over the lamp's
// directions with intensity I, where they meet the visible floor.
double drawn_exactly(const Vec3& lamp, const scenes::Camera& camera) {
  const CameraModel model = make_camera_model(camera, side_px, side_px);
  constexpr int steps = 2000;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    // Even in the logarithm of the tangent, the distance on the floor over the height.
    const double low = std::log(1e-3), high = std::log(4.0 / lamp.z);
    const double tangent = std::exp(low + (i + 0.5) * (high - low) / steps);
    const double cosine = 1.0 / std::sqrt(1.0 + tangent * tangent);
    // d(cosine) = sine^2 cosine d(log tangent)
    const double ring = (1.0 - cosine * cosine) * cosine * (high - low) / steps;
    for (int k = 0; k < steps; ++k) {
      const double phi = 2.0 * base::pi * (k + 0.5) / steps;
      const Vec3 met(lamp.x + lamp.z * tangent * std::cos(phi),
                     lamp.y + lamp.z * tangent * std::sin(phi), 0.0);
      const glm::dvec2 at = model.film_from(model.position, met);
      if (at.x < 0.0 || at.y < 0.0 || at.x > side_px || at.y > side_px) continue;
      sum += ring * model.film_per_m2(model.position, met, Vec3(0, 0, 1));
    }
  }
  return sum * 2.0 * base::pi / steps * rho / base::pi / (side_px * side_px);
}

// One of some thousand camera samples hits the light of a lamp 1 mm above the floor.
TEST(Footprint, PictureHasAllTheLightOfALampThatIsNearerThanAPixelIsWide) {
  for (const double height : {1e-3, 0.02, 0.1, 0.3}) {
    const NearLampRoom room(Vec3(0.03, 0.05, height));
    const DrawnMean found = drawn(room.scene.scene, room.camera);
    // 1e-6: the sum has no rings closer to the foot of the lamp.
    EXPECT_NEAR(found.value, drawn_exactly(Vec3(0.03, 0.05, height), room.camera),
                4.0 * found.std_error + 2e-6 * found.value)
        << height << " m, " << found.std_error;
  }
}

// Each pixel against the sum of 32 x 32 pixels of a picture whose pixels are small relative to the
// lamp's distance.
TEST(Footprint, PixelIsTheMeanOfItsFilter) {
  NearLampRoom room(Vec3(0.03, 0.05, 0.05));
  room.camera.filter = scenes::FilterShape::Triangle;
  room.camera.filter_width_px = 2.0;
  const tests::Prepared prepared(room.scene.scene);
  const radiosity::Solution none;
  RenderOptions options;
  options.indirect = Indirect::None;
  constexpr int finer = 32;
  options.columns = options.rows = side_px * finer;
  scenes::Camera fine_camera = room.camera;
  fine_camera.filter = scenes::FilterShape::Box;
  fine_camera.filter_width_px = 1.0;
  const base::Image fine = render(prepared, none, fine_camera, options).image;
  std::vector<double> sum(side_px * side_px, 0.0), sum2(sum), expected(sum);
  options.columns = options.rows = side_px;
  for (int seed = 1; seed <= seed_count; ++seed) {
    options.seed = static_cast<std::uint64_t>(seed);
    const base::Image image = render(prepared, none, room.camera, options).image;
    for (std::size_t k = 0; k < sum.size(); ++k) {
      const double g = image.find("G")->values[k];
      sum[k] += g / seed_count;
      sum2[k] += g * g / seed_count;
    }
  }
  const PixelFilter filter(room.camera);
  for (int y = 1; y + 1 < side_px; ++y) {
    for (int x = 1; x + 1 < side_px; ++x) {
      double mean = 0.0;
      for (int j = (y - 1) * finer; j < (y + 2) * finer; ++j) {
        for (int i = (x - 1) * finer; i < (x + 2) * finer; ++i) {
          const glm::dvec2 off((i + 0.5) / finer - x - 0.5, (j + 0.5) / finer - y - 0.5);
          mean += filter.density(off) / (finer * finer) *
                  double(fine.find("G")->values[std::size_t(j) * side_px * finer + std::size_t(i)]);
        }
      }
      const auto k = std::size_t(y) * side_px + std::size_t(x);
      const double std_error =
          std::sqrt(std::max(0.0, sum2[k] - sum[k] * sum[k]) / (seed_count - 1));
      // The probability that one of 100 pixels exceeds 5 standard errors of 16 values is about 1 %.
      EXPECT_NEAR(sum[k], mean, 5.0 * std_error + 0.01 * mean) << x << ", " << y;
    }
  }
}

}  // namespace
}  // namespace earthshine::raytrace
