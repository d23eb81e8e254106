// SPDX-License-Identifier: Apache-2.0
// Gates for the closed cube of 6 x 16 x 16 patches; rays lost from a closed room.
#include <fmt/format.h>

#include <cmath>

#include "tests/support/cube_errors.h"
#include "tests/validation/tables.h"

namespace earthshine::validation {
namespace {

void gate(Verdict& verdict, const std::string& what, double found, double most) {
  fmt::print("| {} | {:.3g} | {:.3g} |\n", what, found, most);
  verdict.check(found <= most, fmt::format("{}: {:.4g}, at most {:.4g}", what, found, most));
}

}  // namespace

void cube_table(const Options& options, Verdict& verdict) {
  const tests::ExactCube cube = tests::grey_cube(16);
  const radiosity::FormFactors few = tests::cast_cube(cube, 1024, options.seed);
  const double at_1024 = tests::mean_row_error(cube, few);
  const double at_4096 = tests::mean_row_error(cube, tests::cast_cube(cube, 4096, options.seed));
  const double at_16384 = tests::mean_row_error(cube, tests::cast_cube(cube, 16384, options.seed));
  radiosity::FormFactors balanced = few;
  const std::vector<double> area(few.count(), 1.0 / 256.0);
  radiosity::balance(balanced, area);
  fmt::print("| closed cube, 6 x 16 x 16 patches | found | at most |\n| --- | --- | --- |\n");
  fmt::print("| mean row error, 1024 rays | {:.3g} | |\n", at_1024);
  gate(verdict, "mean row error, 4096 rays", at_4096, 1.15e-2);
  fmt::print("| mean row error, 16384 rays | {:.3g} | |\n", at_16384);
  gate(verdict, "exponent of the rays, 1024 to 16384",
       std::log(at_16384 / at_1024) / std::log(16.0), -0.58);
  gate(verdict, "indirect B, ceiling shining, ρ 0.5, 1024 rays",
       tests::indirect_error(cube, balanced, 0.5), 6e-3);
  gate(verdict, "indirect B, ceiling shining, ρ 0.99, 1024 rays",
       tests::indirect_error(cube, balanced, 0.99), 1.2e-4);
  gate(verdict, "indirect B, lamp of 2 x 2 patches, ρ 0.5, 1024 rays",
       tests::lamp_error(1024, options.seed), 2e-3);
}

void leak_table(const Options& options, Verdict& verdict) {
  // The closed room of separate patches, without shared vertices, at the origin and 10 km away.
  const double wanted = options.quick ? 1e7 : 1e8;
  double rays = 0.0, lost = 0.0;
  tests::ExactCube cube = tests::grey_cube(16);
  tests::SceneBuilder far = cube.builder;
  for (Vec3& p : far.scene.vertices) p += Vec3(1e4, -1e4, 5e3);
  for (const scenes::Scene* scene : {&cube.builder.scene, &far.scene}) {
    const scenes::RayQuery query(*scene);
    const radiosity::Patches patches = radiosity::subdivide(*scene, 1.0);
    const double before = rays;
    for (std::uint64_t seed = 1; rays - before < 0.5 * wanted; ++seed) {
      const radiosity::FormFactors f =
          radiosity::cast_form_factors(*scene, query, patches, {4096, options.seed + seed});
      rays += double(f.ray_count);
      for (std::size_t i = 0; i < f.count(); ++i) lost += (f.sky[i] + f.black[i]) * 4096.0;
    }
  }
  fmt::print(
      "{:.3g} rays in a closed room of 1536 patches, half of them 10 km from the origin: {} "
      "lost.\n",
      rays, std::lround(lost));
  verdict.check(lost == 0.0, fmt::format("{} of {} rays leaked", lost, rays));
}

}  // namespace earthshine::validation
