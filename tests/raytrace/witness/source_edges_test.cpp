// SPDX-License-Identifier: Apache-2.0
// Edges of sources that the camera sees: a pixel's mean is the mean of the source's radiance over
// the pixel, by 64 x 64 rays.
#include "raytrace/witness/source_edges.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "raytrace/render.h"
#include "scenes/sky/sky.h"
#include "tests/support/scene_builder.h"

namespace earthshine::raytrace {
namespace {

constexpr int across = 32, down = 24;
constexpr double shown_cd_m2 = 1000.0;  // of every source here, cd/m^2

using Shows = std::function<bool(const Ray&)>;  // whether a ray meets the source

struct Errors {
  double rms = 0.0, worst = 0.0;
  int pixels = 0;
};

// Error of the share of a pixel that the source fills, over partly filled pixels.
Errors errors_of(const scenes::Scene& scene, const scenes::Camera& camera, const Shows& shows,
                 const RenderOptions& how) {
  const tests::Prepared prepared(scene);
  RenderOptions options = how;
  options.columns = across, options.rows = down;
  options.gather_rays = 16;
  radiosity::SolveOptions solve;
  solve.patch_edge_m = 1.0;
  solve.form_factor_rays = 16;
  const Frame frame = render(prepared, prepared.solve(solve), camera, options);
  const std::vector<float>& light = frame.image.find("G")->values;
  const CameraModel model = make_camera_model(camera, across, down);
  Errors errors;
  constexpr int fine = 64;
  for (int y = 0; y < down; ++y) {
    for (int x = 0; x < across; ++x) {
      int met = 0;
      for (int k = 0; k < fine * fine; ++k) {
        const double u = (k % fine + 0.5) / fine, v = (k / fine + 0.5) / fine;
        met += shows(model.ray(x + u, y + v, 0.5, 0.5)) ? 1 : 0;
      }
      if (met == 0 || met == fine * fine) continue;
      const double share = double(met) / (fine * fine);
      const double off = double(light[std::size_t(y * across + x)]) / shown_cd_m2 - share;
      errors.rms += off * off;
      errors.worst = std::max(errors.worst, std::abs(off));
      ++errors.pixels;
    }
  }
  errors.rms = std::sqrt(errors.rms / std::max(1, errors.pixels));
  return errors;
}

struct Way {
  const char* name;
  double error;  // wanted, also for the edges
};
constexpr Way ways[] = {{"of 5 %", 0.05}, {"of 1 %", 0.01}, {"of 0.35 %", 0.0035}};

void expect_shares(const scenes::Scene& scene, const scenes::Camera& camera, const Shows& shows) {
  for (const Way& way : ways) {
    RenderOptions options;
    options.error = way.error;
    const Errors errors = errors_of(scene, camera, shows, options);
    ASSERT_GT(errors.pixels, 20);
    // 0.27 / 64^(3/4) = 0.012; the RMS over some tens of pixels has a relative error of a fifth,
    // times two.
    const double allowed = std::max(0.0035, std::min(way.error, 0.012));
    EXPECT_LT(errors.rms, 1.4 * allowed) << way.name;
    EXPECT_LT(errors.worst, 5.0 * allowed) << way.name;
  }
}

scenes::Camera along_x(double roll_deg) {
  scenes::Camera camera;
  camera.look_at = Vec3(1.0, 0.0, 0.0);
  camera.up = Vec3(0.0, std::sin(base::radians(roll_deg)), std::cos(base::radians(roll_deg)));
  camera.fov_deg = 40.0;
  return camera;
}

// A lit grey box beside the view, so that the picture has reflected light.
tests::SceneBuilder with_earth() {
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 0.2, -0.5, true);
  scenes::Earth earth;
  earth.direction = Vec3(0.0, 0.0, -1.0);
  earth.half_angle_deg = 84.0;  // the limb is 6 degrees below the middle of the picture
  earth.model = scenes::EarthModel::Uniform;
  earth.radiance = Rgb(shown_cd_m2);
  builder.scene.earth = earth;
  return builder;
}

TEST(SourceEdges, TheLimbOfTheEarthHasItsShareOfEveryPixel) {
  const tests::SceneBuilder builder = with_earth();
  const scenes::EarthRadiance earth(builder.scene);
  for (const double roll_deg : {0.0, 3.0, 31.0, 90.0}) {
    expect_shares(builder.scene, along_x(roll_deg),
                  [&](const Ray& ray) { return earth.covers(ray.direction); });
  }
}

TEST(SourceEdges, TheSunsDiscDoes) {
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 0.2, -0.5, true);
  scenes::Sun sun;
  sun.direction = glm::normalize(Vec3(1.0, 0.02, 0.03));
  sun.angular_radius_deg = 9.0;
  const double sine = std::sin(base::radians(sun.angular_radius_deg));
  sun.illuminance_lx = Rgb(shown_cd_m2 * base::pi * sine * sine);
  builder.scene.sun = sun;
  expect_shares(builder.scene, along_x(10.0), [&](const Ray& ray) {
    return glm::dot(ray.direction, sun.direction) >= std::cos(base::radians(9.0));
  });
}

// Bodies in front of the Earth have edges, too.
TEST(SourceEdges, ABlackPlateBeforeTheEarthDoes) {
  tests::SceneBuilder builder = with_earth();
  const std::uint32_t black = builder.material(tests::grey(0.0));
  builder.quad(black, {2.0, -0.4, -1.0}, {2.0, -0.5, -0.4}, {2.0, 0.3, -0.3}, {2.0, 0.4, -0.9});
  const scenes::EarthRadiance earth(builder.scene);
  const scenes::RayQuery query(builder.scene);
  expect_shares(builder.scene, along_x(0.0), [&](const Ray& ray) {
    return earth.covers(ray.direction) && query.closest(ray.origin, ray.direction).missed();
  });
}

TEST(SourceEdges, EmittersAndLampsDo) {
  const auto in_disc = [](const Ray& ray) {
    const double t = 2.0 / ray.direction.x;
    return glm::length(Vec3(2.0, 0.1, 0.05) - t * ray.direction) <= 0.35;
  };
  tests::SceneBuilder lamps;
  lamps.plate(lamps.material(tests::grey(0.5)), 0.2, -0.5, true);
  scenes::Lamp lamp;
  lamp.name = lamp.group = "lamp";
  lamp.kind = scenes::LampKind::Disk;
  lamp.position = Vec3(2.0, 0.1, 0.05);
  lamp.axis = Vec3(-1.0, 0.0, 0.0);
  lamp.radius_m = 0.35;
  lamp.exitance = Rgb(shown_cd_m2 * base::pi);
  lamps.scene.lamps.push_back(lamp);
  expect_shares(lamps.scene, along_x(0.0), in_disc);

  tests::SceneBuilder emitters;
  emitters.plate(emitters.material(tests::grey(0.5)), 0.2, -0.5, true);
  const std::uint32_t bright = emitters.material(tests::grey(0.0, shown_cd_m2 * base::pi));
  emitters.quad(bright, {2.0, 0.4, -0.3}, {2.0, -0.3, -0.4}, {2.0, -0.4, 0.3}, {2.0, 0.3, 0.4});
  const scenes::RayQuery query(emitters.scene);
  expect_shares(emitters.scene, along_x(0.0), [&](const Ray& ray) {
    const scenes::Hit hit = query.closest(ray.origin, ray.direction);
    return !hit.missed() && emitters.scene.triangles[hit.triangle].material == bright;
  });
}

// 0.27 n^-3/4, in powers of two from 64 to 1024.
TEST(SourceEdges, SamplesFollowTheWantedError) {
  EXPECT_EQ(samples_for_edges(0.0), 64U);
  EXPECT_EQ(samples_for_edges(0.5), 64U);
  EXPECT_EQ(samples_for_edges(0.01), 128U);
  EXPECT_EQ(samples_for_edges(0.005), 256U);
  EXPECT_EQ(samples_for_edges(1e-6), 1024U);
}

// The even light of a source, and edges of surfaces far from any, need no more samples.
TEST(SourceEdges, OnlyEdgesOfSourcesTakeMore) {
  PixelSums sums({0, 0, 12, 6}, 1, false);
  std::fill(sums.samples.begin(), sums.samples.end(), 4U);
  const auto set = [&](int x, int y, double source, double reflected) {
    const std::size_t p = sums.window.index(x, y);
    sums.source[p].luminance = 4.0 * source;
    sums.source[p].luminance2 = 4.0 * source * source;
    sums.luminance[p] = 4.0 * (source + reflected);
    sums.luminance2[p] = 4.0 * (source * source + reflected * reflected);
  };
  for (int y = 0; y < 6; ++y) {
    for (int x = 0; x < 12; ++x) {
      if (x < 4) set(x, y, 10.0 + 0.5 * x, 0.0);      // a source, smooth
      if (x >= 4) set(x, y, 0.0, x < 8 ? 1.0 : 5.0);  // beside it a surface with an edge
    }
  }
  const auto wanted = wanted_for_source_edges(sums, 256, 1e9);
  for (int x = 0; x < 12; ++x)
    EXPECT_EQ(wanted[sums.window.index(x, 3)], x == 3 || x == 4 ? 256U : 4U) << x;
  // 12 pixels: 12 * 124 is too much, 12 * 60 not.
  const auto bound = wanted_for_source_edges(sums, 256, 1000.0);
  EXPECT_EQ(bound[sums.window.index(4, 3)], 64U);
  EXPECT_EQ(wanted_for_source_edges(sums, 256, 1.0)[sums.window.index(4, 3)], 64U);
}

}  // namespace
}  // namespace earthshine::raytrace
