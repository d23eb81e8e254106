// SPDX-License-Identifier: Apache-2.0
// Furnaces of all reflectances, errors by balancing in open scenes, energy of the shipped scenes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "scenes/read/scene_file.h"
#include "tests/support/case_scene.h"
#include "tests/support/scene_builder.h"
#include "tests/validation/tables.h"

namespace earthshine::validation {

void furnace_table(const Options&, Verdict& verdict) {
  fmt::print("| ρ of the closed room | max error of B / B | imbalance of energy | iterations |\n");
  fmt::print("| --- | --- | --- | --- |\n");
  for (const double rho : {0.0, 0.1, 0.5, 0.9, 0.99, 0.999, 0.9999, 0.99999, 0.999999}) {
    tests::SceneBuilder builder;
    const std::uint32_t m = builder.material(tests::grey(rho, 1.0 - rho));
    builder.room({m, m, m, m, m, m});
    radiosity::SolveOptions options;
    options.patch_edge_m = 0.125;
    const radiosity::Solution s = tests::Prepared(builder.scene).solve(options);
    double worst = 0.0;
    for (const radiosity::ObjectLight& o : s.report.objects) {
      worst = std::max(worst, std::abs(o.radiosity_lm_m2.g - 1.0));
    }
    // Patch values are stored in single precision.
    for (const float b : s.radiosity) worst = std::max(worst, std::abs(double(b) - 1.0) - 6e-8);
    fmt::print("| {} | {:.1e} | {:.1e} | {} |\n", rho, worst, s.report.groups[0].imbalance,
               s.report.iterations);
    verdict.check(worst <= 1e-8, fmt::format("furnace of rho {}: B off by {:.2e}", rho, worst));
    verdict.check(s.report.groups[0].imbalance <= 1e-12,
                  fmt::format("furnace of rho {}: energy imbalance", rho));
  }
}

void balancing_table(const Options& options, Verdict&) {
  // Unit squares at 1 m, each of 8 x 8 patches; F between them in closed form.
  constexpr double exact = 0.19982489569838;
  tests::CaseScene made;
  const std::uint32_t m = made.material(0.5);
  made.object("first", m);
  made.level(0, 1, 0, 1, 0, true, 8, 8);
  made.object("second", m);
  made.level(0, 1, 0, 1, 1, false, 8, 8);
  const scenes::RayQuery query(made.scene);
  const radiosity::Patches patches = radiosity::subdivide(made.scene, 1.0);
  fmt::print("| rays per patch | F as cast - exact | F balanced - as cast | std. error of it |\n");
  fmt::print("| --- | --- | --- | --- |\n");
  const int seeds = options.quick ? 16 : 64;
  for (const int rays : {64, 256, 1024, 4096}) {
    double raw = 0.0, change = 0.0, square = 0.0;
    for (int seed = 1; seed <= seeds; ++seed) {
      radiosity::FormFactors f =
          radiosity::cast_form_factors(made.scene, query, patches, {rays, std::uint64_t(seed)});
      const auto landed = [&f] {
        double sum = 0.0;
        for (const double sky : f.sky) sum += (1.0 - sky) / double(f.count());
        return sum;
      };
      const double before = landed();
      radiosity::balance(f, patches.area_m2);
      const double d = landed() - before;
      raw += (before - exact) / seeds;
      change += d / seeds;
      square += d * d / seeds;
    }
    fmt::print("| {} | {:+.1e} | {:+.1e} | {:.1e} |\n", rays, raw, change,
               std::sqrt((square - change * change) / (seeds - 1.0)));
  }
}

void energy_table(const Options& options, Verdict& verdict) {
  std::vector<std::filesystem::path> files;
  const std::filesystem::path library = EARTHSHINE_SOURCE_DIR "/scenes/library";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(library)) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  fmt::print(
      "| scene | patches | light groups | largest imbalance | column defect before | after |\n");
  fmt::print("| --- | --- | --- | --- | --- | --- |\n");
  for (const std::filesystem::path& file : files) {
    const scenes::Scene scene = scenes::read_scene(file);
    const bool large = scene.triangles.size() > 1000;
    radiosity::SolveOptions solve;
    solve.patch_edge_m = !large ? 0.1 : options.quick ? 1.0 : 0.45;
    solve.form_factor_rays = options.quick ? 256 : 1024;
    const radiosity::Solution s = tests::Prepared(scene).solve(solve);
    double worst = 0.0;
    for (const radiosity::GroupLedger& line : s.report.groups) {
      worst = std::max(worst, line.imbalance);
    }
    const std::string name = std::filesystem::relative(file, library).string();
    fmt::print("| {} | {} | {} | {:.1e} | {:.1e} | {:.1e} |\n", name, s.report.patches,
               s.report.groups.size(), worst, s.report.balance.before, s.report.balance.after);
    verdict.check(worst <= 1e-12, fmt::format("{}: energy imbalance {:.2e}", name, worst));
  }
}

}  // namespace earthshine::validation
