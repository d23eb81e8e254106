// SPDX-License-Identifier: Apache-2.0
#include "raytrace/light/light_sampler.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/numbers/random.h"
#include "raytrace/render.h"
#include "scenes/health/mend.h"
#include "tests/raytrace/path_picture.h"
#include "tests/support/scene_builder.h"

namespace earthshine::raytrace {
namespace {

// A plate under a grid of n x n lamps, every second one a panel; a screen hides some of them.
tests::SceneBuilder under_lamps(int n) {
  tests::SceneBuilder builder;
  const std::uint32_t grey = builder.material(tests::grey(0.5));
  builder.plate(grey, 4.0, 0.0, true);
  builder.plate(grey, 1.0, 0.5, false);
  for (int i = 0; i < n * n; ++i) {
    scenes::Lamp lamp;
    lamp.name = "lamp-" + std::to_string(i);
    lamp.group = i % 3 == 0 ? "a" : "b";
    lamp.kind = i % 2 == 0 ? scenes::LampKind::Point : scenes::LampKind::Rectangle;
    lamp.position = Vec3(6.0 * ((i % n) + 0.5) / n - 3.0, 6.0 * ((i / n) + 0.5) / n - 3.0, 2.0);
    lamp.axis = Vec3(0, 0, -1);
    lamp.edge_u = Vec3(0, 0.2, 0);
    lamp.edge_v = Vec3(0.2, 0, 0);
    if (lamp.kind == scenes::LampKind::Point) lamp.intensity_cd = Rgb(1.0 + i % 7);
    if (lamp.kind == scenes::LampKind::Rectangle) lamp.exitance = Rgb(100.0 * (1.0 + i % 5));
    builder.scene.lamps.push_back(lamp);
  }
  return builder;
}

scenes::Camera above() {
  scenes::Camera camera;
  camera.position = Vec3(0, 0, 1.9);  // under the lamps, above the screen
  camera.look_at = Vec3(0.0);
  camera.up = Vec3(0, 1, 0);
  camera.fov_deg = 80.0;
  return camera;
}

TEST(LightSampler, FewLampsAreAllTakenWhole) {
  const tests::SceneBuilder builder = under_lamps(5);
  const tests::Prepared prepared(builder.scene);
  const LightSampler lights(prepared, Indirect::None, 1);
  std::vector<scenes::LightChoice> chosen;
  lights.choose({}, 0.5, chosen);
  ASSERT_EQ(chosen.size(), 25U);
  for (std::size_t k = 0; k < 25; ++k) {
    EXPECT_EQ(chosen[k].light, k);
    EXPECT_EQ(chosen[k].weight, 1.0);
  }
}

TEST(LightSampler, DistributedLightsAreNeverLeftToChance) {
  const tests::SceneBuilder builder = under_lamps(10);
  const tests::Prepared prepared(builder.scene);
  const LightSampler lights(prepared, Indirect::Distributed, 4);
  std::vector<scenes::LightChoice> chosen;
  lights.choose({}, 0.5, chosen);
  EXPECT_EQ(chosen.size(), 50U + 4 * 50U);
  // The report's lights are fixed points: the same from every receiver.
  for (std::size_t k = 0; k < lights.count(); ++k) {
    const auto place = [&](const Vec3& point, double u) {
      const scenes::LightSample sample = lights.sample(k, point, u, u);
      return point + sample.distance_m * sample.direction;
    };
    const Vec3 first = place({0.1, 0.2, 0.0}, 0.2);
    EXPECT_NEAR(glm::length(first - place({1.0, -0.5, 1.9}, 0.8)), 0.0, 1e-9);
  }
}

TEST(LightSampler, PictureOfManyLampsIsThatOfAllOfThem) {
  // 100 lamps by random choice against the same lamps in groups so small that all are sampled: the
  // mean over seeds of each quarter of the picture, within four standard errors of the difference.
  // Includes shadows of the screen.
  const tests::SceneBuilder builder = under_lamps(10);
  scenes::Scene apart = builder.scene;
  for (std::size_t k = 0; k < apart.lamps.size(); ++k) {
    apart.lamps[k].group = "g" + std::to_string(k / 20);
  }
  RenderOptions options;
  options.columns = options.rows = 8;
  options.indirect = Indirect::None;
  struct Mean {
    double sum = 0.0, squares = 0.0;
    std::uint64_t rays = 0;
  };
  const int seeds = 24;
  const auto quarters = [&](const scenes::Scene& scene, bool per_light) {
    std::array<Mean, 4> means;
    const tests::Prepared prepared(scene);
    options.per_light = per_light;
    for (int seed = 1; seed <= seeds; ++seed) {
      options.seed = static_cast<std::uint64_t>(seed);
      const Frame frame = render(prepared, {}, above(), options);
      const auto& values = frame.image.find("G")->values;
      std::array<double, 4> value{};
      for (std::size_t p = 0; p < 64; ++p) {
        value[2 * (p / 32) + (p % 8) / 4] += double(values[p]) / 16.0;
      }
      for (std::size_t q = 0; q < 4; ++q) {
        means[q].sum += value[q] / seeds;
        means[q].squares += value[q] * value[q] / seeds;
        means[q].rays += frame.report.rays.shadow;
      }
    }
    return means;
  };
  const auto chosen = quarters(builder.scene, false), all = quarters(apart, true);
  EXPECT_LT(chosen[0].rays * 3, all[0].rays);
  for (std::size_t q = 0; q < 4; ++q) {
    double variance = 0.0;
    for (const Mean& m : {chosen[q], all[q]}) {
      variance += std::max(0.0, m.squares - m.sum * m.sum) / (seeds - 1);
    }
    EXPECT_NEAR(chosen[q].sum, all[q].sum, 4.0 * std::sqrt(variance)) << q;
    EXPECT_LT(std::sqrt(variance), 0.01 * all[q].sum);
  }
}

TEST(LightSampler, NearestLampOnARayIsSeen) {
  const tests::SceneBuilder builder = under_lamps(20);
  const tests::Prepared prepared(builder.scene);
  const LightSampler lights(prepared, Indirect::None, 1);
  base::Rng rng(base::Key(1, base::Stream::Test, 80));
  int seen_count = 0;
  for (int n = 0; n < 2000; ++n) {
    const Vec3 origin(0.0, 0.0, 4.0 * rng.next());
    const double x = rng.next(), y = rng.next(), z = rng.next();
    const Vec3 direction = glm::normalize(Vec3(x - 0.5, y - 0.5, 1.6 * z - 0.6));
    double nearest = 2.5;
    std::size_t lamp = 0;
    for (std::size_t k = 0; k < builder.scene.lamps.size(); ++k) {
      const auto hit = scenes::hit_lamp(builder.scene.lamps[k], origin, direction);
      if (!hit || hit->distance_m >= nearest) continue;
      nearest = hit->distance_m;
      lamp = k;
    }
    const auto seen = lights.seen_lamp(origin, direction, 2.5);
    ASSERT_EQ(seen.has_value(), nearest < 2.5);
    if (!seen) continue;
    ++seen_count;
    EXPECT_EQ(seen->lamp, lamp);
    EXPECT_EQ(seen->hit.distance_m, nearest);
  }
  EXPECT_GT(seen_count, 50);
}

TEST(LightSampler, ALampFlushWithItsCeilingIsSeenWhole) {
  // Seen obliquely and filling the picture, every pixel is its radiance M / pi in both tracers; the
  // hits of the ceiling and of the lamp coincide.
  for (const double height_m : {0.3, 2.0, 7.1}) {
    tests::SceneBuilder builder;
    builder.plate(builder.material(tests::grey(0.5)), 4.0, height_m, false);
    scenes::Lamp lamp;
    lamp.kind = scenes::LampKind::Rectangle;
    lamp.position = Vec3(0.0, 0.0, height_m);
    lamp.edge_u = Vec3(0.0, 1.0, 0.0);
    lamp.edge_v = Vec3(1.0, 0.0, 0.0);
    lamp.axis = Vec3(0.0, 0.0, -1.0);
    lamp.exitance = Rgb(base::pi);
    builder.scene.lamps.push_back(lamp);
    scenes::lift_lamps(builder.scene);
    scenes::Camera camera;
    camera.position = Vec3(0.3, 0.1, 0.3 * height_m);
    camera.look_at = Vec3(0.1, 0.05, height_m);
    camera.fov_deg = 5.0;
    const tests::Prepared prepared(builder.scene);
    PathOptions paths;
    RenderOptions direct;
    paths.columns = paths.rows = direct.columns = direct.rows = 16;
    direct.indirect = Indirect::None;
    const radiosity::Solution solution = prepared.solve({});
    for (const base::Image& image : {trace_paths(prepared, camera, paths).image,
                                     render(prepared, solution, camera, direct).image}) {
      for (const float seen : image.find("G")->values) ASSERT_NEAR(seen, 1.0, 1e-6) << height_m;
    }
  }
}

// A Sun of 5 degrees and a small mirror: may_reach() must hold wherever a sample brings light, also
// from the mirror's rim and at grazing incidence. For most surfaces it is false without a sample.
TEST(LightSampler, NoSunIsLeftOutThatAMirrorThrows) {
  tests::SceneBuilder builder;
  scenes::Material silver = tests::grey(0.0);
  silver.mirror = Rgb(0.9);
  builder.plate(builder.material(silver), 1.0, 0.0, true);
  base::Rng rng(base::Key(1, base::Stream::Test, 81));
  std::size_t thrown_count = 0, may_count = 0, all_count = 0;
  for (const double height_deg : {2.0, 10.0, 40.0, 85.0}) {
    scenes::Sun sun;
    const double angle = base::radians(height_deg);
    sun.direction = Vec3(std::cos(angle), 0, std::sin(angle));
    sun.illuminance_lx = Rgb(1000.0);
    sun.angular_radius_deg = 5.0;
    builder.scene.sun = sun;
    const tests::Prepared prepared(builder.scene);
    const LightSampler lights(prepared, Indirect::None, 1, false, std::nullopt,
                              prepared.query.specular_paths().mirrors());
    ASSERT_EQ(lights.count(), 2U);  // the Sun and its image
    for (int n = 0; n < 20000; ++n) {
      const double x = rng.next(), y = rng.next(), z = rng.next();
      const Vec3 point(6.0 * x - 5.0, 3.0 * y - 1.5, 2.0 * z);
      const double cosine = 2.0 * rng.next() - 1.0, phi = 2.0 * base::pi * rng.next();
      const double sine = std::sqrt(1.0 - cosine * cosine);
      const Vec3 normal(sine * std::cos(phi), sine * std::sin(phi), cosine);
      const double u = rng.next(), v = rng.next();
      const bool may = lights.may_reach(1, point, normal);
      const scenes::LightSample sample = lights.sample(1, point, u, v);
      const bool lit =
          base::is_lit(sample.normal_illuminance_lx) && glm::dot(sample.direction, normal) > 0.0;
      EXPECT_TRUE(may || !lit) << height_deg << ' ' << n;
      thrown_count += lit ? 1 : 0;
      may_count += may ? 1 : 0;
      ++all_count;
    }
  }
  EXPECT_GT(thrown_count, 1000U);
  EXPECT_LT(may_count, all_count / 2);
}

}  // namespace
}  // namespace earthshine::raytrace
