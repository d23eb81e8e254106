// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "radiosity/direct/sources.h"
#include "tests/support/scene_builder.h"

namespace earthshine::radiosity {
namespace {

// A closed room with 64 lamps of every kind except measured ones.
scenes::Scene room_of_lamps(bool in_one_group) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.room({m, m, m, m, m, m});
  builder.quad(m, {0.2, 0.2, 0.4}, {0.2, 0.6, 0.4}, {0.6, 0.6, 0.4}, {0.6, 0.2, 0.4});
  for (int k = 0; k < 64; ++k) {
    scenes::Lamp lamp;
    lamp.name = "lamp-" + std::to_string(k);
    lamp.group = in_one_group ? "lamps" : "lamps-" + std::to_string(k / 16);
    lamp.kind = static_cast<scenes::LampKind>(k % 4);
    lamp.position = Vec3(0.1 + 0.11 * (k % 8), 0.1 + 0.11 * (k / 8), 0.9);
    lamp.axis = Vec3(0, 0, -1);
    lamp.beam_deg = 40.0;
    lamp.field_deg = 120.0;
    lamp.edge_u = Vec3(0, 0.05, 0);
    lamp.edge_v = Vec3(0.05, 0, 0);
    lamp.radius_m = 0.03;
    const bool wide = k % 4 >= 2;
    const double strength = 1.0 + k % 7;
    (wide ? lamp.exitance : lamp.intensity_cd) = Rgb(strength * (wide ? 1000.0 : 1.0));
    builder.scene.lamps.push_back(lamp);
  }
  return builder.scene;
}

std::vector<LightSource> sources_of(const tests::Prepared& prepared) {
  return find_sources(prepared, 4);
}

TEST(LightCluster, ManyLampsOfOneGroupAreOneSourceOfTheirWholeFlux) {
  const scenes::Scene scene = room_of_lamps(true);
  Rgb flux(0.0);
  for (const scenes::Lamp& lamp : scene.lamps) flux += scenes::lamp_flux_lm(lamp);
  SolveOptions options;
  options.patch_edge_m = 0.25;
  const SolveReport report = tests::Prepared(scene).solve(options).report;
  ASSERT_EQ(report.sources.size(), 1U);
  EXPECT_EQ(report.sources[0].name, "64 lamps of group lamps");
  EXPECT_NEAR(report.sources[0].emitted_lm.g, flux.g, 1e-9 * flux.g);
  // Some light falls on the black back of the screen; the rest lands.
  EXPECT_EQ(report.sources[0].escaped_share, 0.0);
  EXPECT_NEAR(report.sources[0].scale, 1.0, 0.02);
}

TEST(LightCluster, GivesPatchesTheLightOfItsLampsOneByOne) {
  // Mean over seeds of the flux that lands on every object, within four standard errors of the
  // result with separately sampled lamps (groups of 16).
  const scenes::Scene scene[] = {room_of_lamps(true), room_of_lamps(false)};
  const int seeds = 8;
  const std::size_t objects = scene[0].objects.size();
  std::vector<double> mean[2], square[2];
  std::uint64_t rays[2] = {0, 0};
  for (std::size_t which = 0; which < 2; ++which) {
    const tests::Prepared prepared(scene[which]);
    const Patches patches = subdivide(scene[which], 0.25);
    const std::vector<LightSource> sources = sources_of(prepared);
    mean[which].assign(objects, 0.0);
    square[which].assign(objects, 0.0);
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
      std::vector<double> flux(objects, 0.0);
      for (const LightSource& source : sources) {
        const Sampled sampled =
            sample_patches(prepared.query, patches, {}, {&source.source, 1}, seed, rays[which]);
        for (std::uint32_t i = 0; i < patches.count(); ++i) {
          flux[patches.object(i)] += patches.area_m2[i] * sampled.illuminance_lx[i].g;
        }
      }
      for (std::size_t k = 0; k < objects; ++k) {
        mean[which][k] += flux[k] / seeds;
        square[which][k] += flux[k] * flux[k] / seeds;
      }
    }
  }
  EXPECT_LT(2 * rays[0], rays[1]);
  for (std::size_t k = 0; k < objects; ++k) {
    double variance = 0.0;
    for (std::size_t which = 0; which < 2; ++which) {
      const double m = mean[which][k];
      variance += std::max(0.0, square[which][k] - m * m) / (seeds - 1);
    }
    EXPECT_NEAR(mean[0][k], mean[1][k], 4.0 * std::sqrt(variance)) << k;
    EXPECT_LE(std::sqrt(variance), 0.01 * mean[1][k]) << k;  // the screen's front is dark
  }
}

TEST(LightCluster, FewLampsStaySourcesOfTheirOwn) {
  const scenes::Scene scene = room_of_lamps(false);
  EXPECT_EQ(sources_of(tests::Prepared(scene)).size(), 64U);
}

}  // namespace
}  // namespace earthshine::radiosity
