// SPDX-License-Identifier: Apache-2.0
#include "raytrace/probe.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "base/parallel.h"
#include "tests/support/scene_builder.h"

namespace earthshine::raytrace {
namespace {

// A grey room with a bright wall, glossy floor and a lamp, solved.
struct Room {
  scenes::Scene scene;
  scenes::Camera camera;
  tests::Prepared prepared;
  radiosity::Solution solution;
  RenderOptions options;

  explicit Room(bool with_lamp) : scene(made(with_lamp)), prepared(scene) {
    camera.position = Vec3(0.95, 0.9, 0.6);
    camera.look_at = Vec3(0.4, 0.45, 0.5);
    camera.fov_deg = 70.0;
    radiosity::SolveOptions solve;
    solve.form_factor_rays = 128;
    solution = prepared.solve(solve);
    options.columns = 16;
    options.rows = 12;
    options.gather_rays = 256;  // 16 samples with 16 rays each
  }
  static scenes::Scene made(bool with_lamp) {
    tests::SceneBuilder builder;
    const std::uint32_t m = builder.material(tests::grey(0.5));
    builder.room({builder.material(tests::grey(0.5, 50.0)), m, m, m, m, m});
    if (with_lamp) {
      scenes::Lamp lamp;
      lamp.name = lamp.group = "lamp";
      lamp.kind = scenes::LampKind::Disk;
      lamp.position = Vec3(0.4, 0.45, 0.75);
      lamp.axis = Vec3(0, 0, -1);
      lamp.radius_m = 0.15;
      lamp.exitance = Rgb(1000.0);
      builder.scene.lamps.push_back(lamp);
      // A shelf below it, for penumbras.
      builder.quad(m, {0.3, 0.3, 0.4}, {0.5, 0.3, 0.4}, {0.5, 0.5, 0.4}, {0.3, 0.5, 0.4});
    }
    return builder.scene;
  }
  [[nodiscard]] std::vector<std::uint32_t> every() const {
    std::vector<std::uint32_t> pixels(16 * 12);
    std::iota(pixels.begin(), pixels.end(), 0U);
    return pixels;
  }
  [[nodiscard]] Probed look(const radiosity::Solution& read, const ProbeOptions& how) const {
    return probe(scene, prepared.groups, prepared.effects, prepared.query, read, solution, camera,
                 options, every(), how);
  }
  [[nodiscard]] radiosity::Solution times(float factor) const {
    radiosity::Solution other = solution;
    for (float& b : other.radiosity) b *= factor;
    for (float& b : other.soft_radiosity) b *= factor;
    return other;
  }
};

const Room& lit() {
  static const Room room(true);
  return room;
}

TEST(Probe, HasThePixelsOfThePlainRender) {
  const Room& room = lit();
  RenderOptions options = room.options;
  options.aovs = {"variance"};
  const Frame frame = render(room.scene, room.prepared.groups, room.prepared.effects,
                             room.prepared.query, room.solution, room.camera, options);
  ASSERT_EQ(frame.report.gather_rays, 256);
  const Probed probed = room.look(
      room.solution,
      {.camera_samples = 16, .gather_rays = 16, .seed = options.seed, .lamp_seed = options.seed});
  std::size_t sources = 0;
  for (std::size_t p = 0; p < 192; ++p) {
    const double drawn = double(frame.image.find("G")->values[p]);  // grey: the luminance
    EXPECT_NEAR(probed.luminance[p], drawn, 1e-5 * drawn) << p;
    EXPECT_NEAR(probed.sample_variance[p] / 16.0, double(frame.image.find("variance")->values[p]),
                1e-5 * probed.sample_variance[p] + 1e-9);
    EXPECT_EQ(probed.sees_source[p] != 0, frame.squared_error[p] == shows_source) << p;
    sources += probed.sees_source[p];
  }
  EXPECT_GT(sources, 0U);
  EXPECT_LT(sources, 192U);
  EXPECT_EQ(probed.rays.total(), frame.report.rays.total());
}

TEST(Probe, AnotherSolutionChangesTheSolutionsPartAlone) {
  // L = D + S(B), S linear in B; with the same rays L(2 B) - L(B) = L(B) - L(0) to rounding. Aimed
  // at the same bright patches, whichever is read.
  for (const bool reads : {false, true}) {
    const ProbeOptions how{.reads_solution = reads};
    const Probed none = lit().look(lit().times(0.0F), how), once = lit().look(lit().solution, how),
                 twice = lit().look(lit().times(2.0F), how);
    double part = 0.0;
    for (std::size_t p = 0; p < none.luminance.size(); ++p) {
      const double first = once.luminance[p] - none.luminance[p];
      EXPECT_NEAR(twice.luminance[p] - once.luminance[p], first, 2e-5 * twice.luminance[p]);
      part += first;
    }
    EXPECT_GT(part, 0.0);
  }
}

TEST(Probe, LampSeedChangesLampsAlone) {
  const auto both = [](const Room& room, std::uint64_t lamp_seed, float factor) {
    return room.look(room.times(factor), {.lamp_seed = lamp_seed}).luminance;
  };
  // Without lamps, nothing.
  const Room dark(false);
  EXPECT_EQ(both(dark, 1, 1.0F), both(dark, 2, 1.0F));
  // With them, the lamps' light, and of the solution's not a bit but for rounding.
  const auto l1 = both(lit(), 1, 1.0F), l2 = both(lit(), 2, 1.0F);
  const auto d1 = both(lit(), 1, 0.0F), d2 = both(lit(), 2, 0.0F);
  std::size_t changed = 0;
  for (std::size_t p = 0; p < l1.size(); ++p) {
    if (d1[p] != d2[p]) ++changed;
    EXPECT_NEAR(l1[p] - d1[p], l2[p] - d2[p], 1e-5 * l1[p]);
  }
  EXPECT_GT(changed, 20U);
  // The other seed changes the gathered part.
  const auto other = lit().look(lit().times(1.0F), {.seed = 2}).luminance;
  EXPECT_NE(other, l1);
}

TEST(Probe, ReadsTheSolutionWhereItIsSeen) {
  // A closed room whose walls all emit: B = M / (1 - rho) everywhere, L = B / pi, without a gather
  // ray; what varies is nothing.
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5, 10.0));
  builder.room({m, m, m, m, m, m});
  const tests::Prepared prepared(builder.scene);
  radiosity::SolveOptions solve;
  solve.form_factor_rays = 64;
  const radiosity::Solution solution = prepared.solve(solve);
  RenderOptions options;
  options.columns = options.rows = 4;
  const std::vector<std::uint32_t> pixels{0, 5, 15};
  const Probed probed =
      probe(builder.scene, prepared.groups, prepared.effects, prepared.query, solution, solution,
            lit().camera, options, pixels, {.reads_solution = true});
  EXPECT_EQ(probed.rays.gather, 0U);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(probed.luminance[k], 20.0 / std::numbers::pi, 1e-4);
    EXPECT_LT(probed.sample_variance[k], 1e-6);
  }
}

TEST(Probe, TheSameOnOneAndTwoThreadsAndPixelByPixel) {
  std::vector<Probed> looks;
  for (const int threads : {1, 2}) {
    const base::ThreadLimit limit(threads);
    looks.push_back(lit().look(lit().solution, {}));
  }
  EXPECT_EQ(looks[0].luminance, looks[1].luminance);
  EXPECT_EQ(looks[0].sample_variance, looks[1].sample_variance);
  EXPECT_EQ(looks[0].rays.total(), looks[1].rays.total());
  const Room& room = lit();
  const std::vector<std::uint32_t> some{100, 7, 7};
  const Probed few =
      probe(room.scene, room.prepared.groups, room.prepared.effects, room.prepared.query,
            room.solution, room.solution, room.camera, room.options, some, {});
  EXPECT_EQ(few.luminance, (std::vector<double>{looks[0].luminance[100], looks[0].luminance[7],
                                                looks[0].luminance[7]}));
}

}  // namespace
}  // namespace earthshine::raytrace
