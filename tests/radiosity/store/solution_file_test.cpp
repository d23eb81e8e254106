// SPDX-License-Identifier: Apache-2.0
#include "radiosity/store/solution_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "radiosity/store/solution_key.h"
#include "scenes/light/photometry.h"
#include "scenes/sky/orbit.h"
#include "tests/base/temporary_folder.h"
#include "tests/support/scene_builder.h"

namespace earthshine::radiosity {
namespace {

// A grey room with a black wall, a standing sheet, a bright patch and a lamp.
scenes::Scene lit_room() {
  tests::SceneBuilder builder;
  const std::uint32_t grey = builder.material(tests::grey(0.5));
  const std::uint32_t black = builder.material(tests::grey(0.0));
  builder.room({grey, grey, black, grey, grey, grey});
  scenes::Material sheet = tests::grey(0.7);
  sheet.two_sided = true;
  builder.quad(builder.material(sheet), {0.4, 0.4, 0.1}, {0.6, 0.4, 0.1}, {0.6, 0.4, 0.6},
               {0.4, 0.4, 0.6});
  builder.quad(builder.material(tests::grey(0.3, 50.0)), {0.1, 0.1, 0.01}, {0.2, 0.1, 0.01},
               {0.2, 0.2, 0.01}, {0.1, 0.2, 0.01});
  scenes::Lamp lamp;
  lamp.name = lamp.group = "lamp";
  lamp.position = {0.8, 0.7, 0.9};
  lamp.intensity_cd = {100.0, 90.0, 80.0};
  builder.scene.lamps.push_back(lamp);
  builder.scene.cameras.emplace_back();
  builder.scene.path = "room.toml";
  return builder.scene;
}

SolveOptions coarse_options() { return {0.25, 64, 1e-8, 1}; }

// A scene with its solution, which can be written and read.
struct Stored {
  test::TemporaryFolder folder;
  std::filesystem::path path = folder / "room.h5";
  scenes::Scene scene;
  SolveOptions options = coarse_options();
  Solution solution;

  explicit Stored(scenes::Scene s = lit_room())
      : scene(std::move(s)), solution(tests::Prepared(scene).solve(options)) {
    write();
  }
  void write() const {
    const scenes::LightGroups groups = scenes::find_light_groups(scene);
    write_solution(path, solution, {scene, groups, options, "1.0"});
  }
  [[nodiscard]] Solution read(const scenes::Scene& now, const SolveOptions& with,
                              const std::string& program = "1.0") const {
    const scenes::LightGroups groups = scenes::find_light_groups(now);
    return read_solution(path, {now, groups, with, program});
  }
  [[nodiscard]] Solution read() const { return read(scene, options); }
  [[nodiscard]] std::string refusal(const scenes::Scene& now, const SolveOptions& with,
                                    const std::string& program = "1.0") const {
    return test::error_of(base::Blame::Input, [&] { (void)read(now, with, program); });
  }
};

void expect_in(const std::string& part, const std::string& text) {
  EXPECT_NE(text.find(part), std::string::npos) << "\"" << part << "\" in: " << text;
}

void expect_same(const Patches& a, const Patches& b) {
  EXPECT_EQ(a.area_m2, b.area_m2);
  EXPECT_EQ(a.facet, b.facet);
  EXPECT_EQ(a.is_back, b.is_back);
  EXPECT_EQ(a.of_triangle, b.of_triangle);
  EXPECT_EQ(a.second_half, b.second_half);
  EXPECT_EQ(a.tree, b.tree);
  ASSERT_EQ(a.count(), b.count());
  for (std::uint32_t i = 0; i < a.count(); ++i) EXPECT_EQ(a.corners(i), b.corners(i));
}

TEST(SolutionFile, WhatIsReadIsBitForBitWhatWasWritten) {
  const Stored stored;
  const Solution read = stored.read();
  expect_same(read.patches, stored.solution.patches);
  EXPECT_EQ(read.columns, 6U);
  EXPECT_EQ(read.radiosity, stored.solution.radiosity);
  EXPECT_EQ(read.indirect_radiosity, stored.solution.indirect_radiosity);
  EXPECT_EQ(read.direct_lx, stored.solution.direct_lx);
  EXPECT_EQ(read.indirect_lx, stored.solution.indirect_lx);
  const SolveReport &a = read.report, &b = stored.solution.report;
  EXPECT_EQ(a.patches, b.patches);
  EXPECT_EQ(a.form_factor_rays, b.form_factor_rays);
  EXPECT_EQ(a.shadow_rays, b.shadow_rays);
  EXPECT_EQ(a.nonzeros, b.nonzeros);
  EXPECT_EQ(a.iterations, b.iterations);
  EXPECT_EQ(a.residual, b.residual);
  EXPECT_EQ(a.balance.sweeps, b.balance.sweeps);
  EXPECT_EQ(a.balance.after, b.balance.after);
  EXPECT_EQ(a.balance.balanced, b.balance.balanced);
  ASSERT_EQ(a.groups.size(), 2U);
  ASSERT_EQ(a.sources.size(), b.sources.size());
  ASSERT_EQ(a.objects.size(), b.objects.size());
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(a.groups[k].name, b.groups[k].name);
    EXPECT_EQ(a.groups[k].absorbed_lm, b.groups[k].absorbed_lm);
    EXPECT_EQ(a.groups[k].imbalance, b.groups[k].imbalance);
    EXPECT_EQ(a.sources[k].group, b.sources[k].group);
    EXPECT_EQ(a.sources[k].emitted_lm, b.sources[k].emitted_lm);
    EXPECT_EQ(a.objects[k].name, b.objects[k].name);
    EXPECT_EQ(a.objects[k].radiosity_lm_m2, b.objects[k].radiosity_lm_m2);
  }
}

TEST(SolutionFile, RadiosityIsReflectanceTimesDirectAndIndirectIlluminance) {
  // B = M + rho (E0 + F B); the bright patch's exitance is sampled explicitly.
  const Stored stored;
  const Solution read = stored.read();
  for (std::uint32_t i = 0; i < read.patches.count(); ++i) {
    const double rho = stored.scene.materials[read.patches.material(i)].diffuse.r;
    for (std::size_t k = i * read.columns; k < (i + 1) * read.columns; ++k) {
      const double e = double{read.direct_lx[k]} + read.indirect_lx[k];
      EXPECT_NEAR(read.radiosity[k], rho * e, 1e-5 * (1.0 + rho * e));
    }
  }
}

TEST(SolutionFile, TheSameSolutionGivesTheSameBytes) {
  const Stored stored;
  const std::string once = test::read_bytes(stored.path);
  Stored again;
  again.solution.report.seconds.clear();
  again.write();
  EXPECT_EQ(test::read_bytes(again.path), once);
}

TEST(SolutionFile, ADarkSceneIsStoredToo) {
  scenes::Scene dark = lit_room();
  dark.lamps.clear();
  for (scenes::Material& material : dark.materials) material.emit = Rgb(0.0);
  const Stored stored(dark);
  const Solution read = stored.read();
  EXPECT_EQ(read.columns, 0U);
  EXPECT_TRUE(read.radiosity.empty());
  EXPECT_EQ(read.patches.count(), stored.solution.patches.count());
}

TEST(SolutionFile, AChangeThatTheSolutionDependsOnIsNamed) {
  const Stored stored;
  const auto changed = [&](const char* words, auto change) {
    scenes::Scene scene = stored.scene;
    change(scene);
    const std::string text = stored.refusal(scene, stored.options);
    expect_in(std::string("since it was solved, ") + words + " changed", text);
    expect_in("room.h5: is stale", text);
    expect_in("Run \"earthshine solve room.toml -o", text);
  };
  changed("the geometry", [](auto& s) { s.vertices[3].x += 1e-9; });
  changed("the geometry", [](auto& s) { std::swap(s.triangles[0], s.triangles[2]); });
  changed("the materials", [](auto& s) { s.materials[0].diffuse.g = 0.51; });
  changed("the materials", [](auto& s) { s.materials[0].mirror = Rgb(0.1); });
  changed("the materials", [](auto& s) { s.triangles[0].material = 1; });
  changed("the lights", [](auto& s) { s.lamps[0].intensity_cd *= 0.5; });
  changed("the lights", [](auto& s) { s.lamps[0].group = "panels"; });
  changed("the lights", [](auto& s) {
    using Table = std::vector<double>;
    s.lamps[0].photometry =
        std::make_shared<const scenes::Photometry>(Table{0, 90}, Table{0, 360}, Table{1, 2, 1, 2});
  });
  changed("the lights", [](auto& s) { s.materials[3].emit.b = 3.0; });
  changed("the lights, the Sun or the Earth", [](auto& s) { s.sun.emplace(); });
  changed("the geometry, the materials", [](auto& s) {
    s.vertices[0].z = -1.0;
    s.materials[0].diffuse.r = 0.1;
  });
}

TEST(SolutionFile, TheEarthsAlbedoByLatitudeBelongsToTheSky) {
  scenes::Scene scene;
  scene.sun.emplace();
  scene.earth.emplace();
  scene.orbit.emplace().altitude_m = 425e3;
  const auto sky = [&scene] {
    return scene_parts(scene, scenes::find_light_groups(scene)).back().digest;
  };
  std::vector<std::uint64_t> digests = {sky()};
  scene.orbit->inclination_deg = 28.5;  // sets only the pole, which this Earth does not use
  scene.orbit->position_deg = 5.0;
  EXPECT_EQ(sky(), digests[0]);
  scene.earth->by_latitude.emplace();
  digests.push_back(sky());
  scene.earth->by_latitude->a1 = 0.1;
  digests.push_back(sky());
  scene.earth->by_latitude->a0 = 0.3;
  digests.push_back(sky());
  scene.earth->by_latitude->a2 = 0.2;
  digests.push_back(sky());
  scene.earth->by_latitude->north = Vec3(1, 0, 0);
  digests.push_back(sky());
  move_along_orbit(scene, 90.0);
  digests.push_back(sky());
  std::sort(digests.begin(), digests.end());
  EXPECT_EQ(std::unique(digests.begin(), digests.end()), digests.end());
}

TEST(SolutionFile, AChangedOptionIsNamedWithBothValues) {
  const Stored stored;
  const auto changed = [&](const char* words, auto change) {
    SolveOptions options = stored.options;
    change(options);
    expect_in(words, stored.refusal(stored.scene, options));
  };
  changed("quality.patch_edge in m (0.25, now 0.2)", [](auto& o) { o.patch_edge_m = 0.2; });
  changed("quality.form_factor_rays (64, now 128)", [](auto& o) { o.form_factor_rays = 128; });
  changed("quality.solver_tolerance (1e-08, now 1e-09)", [](auto& o) { o.tolerance = 1e-9; });
  changed("--seed (1, now 2)", [](auto& o) { o.seed = 2; });
  expect_in("was solved by version 1.0, this is 1.1",
            stored.refusal(stored.scene, stored.options, "1.1"));
}

TEST(SolutionFile, FewerSamplesOfDirectLightAreNamedAndTheWholeNumbersAreNot) {
  // Older files lack these numbers and remain valid.
  const auto named = [](const SolveOptions& options, const std::string& key) {
    const std::vector<SolveKnob> knobs = solve_knobs(options);
    return std::any_of(knobs.begin(), knobs.end(),
                       [&](const SolveKnob& knob) { return knob.key == key; });
  };
  SolveOptions options;
  EXPECT_FALSE(named(options, "flux_rays") || named(options, "direct_points"));
  options.flux_rays /= 16;
  EXPECT_TRUE(named(options, "flux_rays"));
  options.direct_points /= 4;
  EXPECT_TRUE(named(options, "direct_points"));
}

TEST(SolutionFile, WhatRadiosityDoesNotReadDoesNotMakeItStale) {
  const Stored stored;
  scenes::Scene scene = stored.scene;
  scene.cameras.clear();
  scene.name = "another";
  scene.quality.gather_rays = 7;
  scene.cctv.emplace_back();
  scene.objects[0].name = "west wall";
  scene.objects[0].target = true;
  for (scenes::Material& material : scene.materials) {
    material.name += " paint";
  }
  scene.materials.push_back(tests::grey(0.9, 1.0));  // unused
  EXPECT_EQ(stored.read(scene, stored.options).radiosity, stored.solution.radiosity);
}

TEST(SolutionFile, NumbersThatAreNotFiniteAreRefused) {
  Stored stored;
  stored.solution.radiosity[5] = std::numeric_limits<float>::quiet_NaN();
  stored.write();
  expect_in("\"radiosity\" holds a number that is not finite",
            stored.refusal(stored.scene, stored.options));
}

TEST(SolutionFile, ADamagedFileIsRefused) {
  const Stored stored;
  std::string bytes = test::read_bytes(stored.path);
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  test::write_bytes(stored.path, bytes);
  expect_in("room.h5: is not a sound file", stored.refusal(stored.scene, stored.options));
}

}  // namespace
}  // namespace earthshine::radiosity
