// SPDX-License-Identifier: Apache-2.0
// Radiosity at the same points of several stored solutions of one scene, for error_truth.py:
//   earthshine_surfaces SCENE POINTS {FILE.h5 SEED KEY=VALUE...} -- {FILE.h5 SEED KEY=VALUE...} ...
// SEED and KEY=VALUE (scene overrides) as given to "solve". Prints a line of luminances per
// uncovered point.
#include <fmt/format.h>

#include <exception>
#include <string>
#include <vector>

#include "radiosity/bodies/closed_bodies.h"
#include "radiosity/store/solution_file.h"
#include "scenes/effects/light_groups.h"
#include "scenes/effects/quality.h"
#include "scenes/read/scene_file.h"
#include "tests/validation/surface_points.h"

namespace {

using namespace earthshine;

radiosity::Solution read(const std::string& path, const std::vector<std::string>& words) {
  const std::vector<std::string> overrides(words.begin() + 3, words.end());
  const scenes::Scene scene = scenes::read_scene(path, overrides);
  const scenes::QualityKnobs knobs = scenes::resolve_quality(scene);
  const radiosity::SolveOptions options = radiosity::solve_options(knobs, std::stoull(words[2]));
  return radiosity::read_solution(
      words[1], {scene, scenes::find_light_groups(scene), options, EARTHSHINE_VERSION});
}

// The points outside all bodies.
std::vector<scenes::Hit> open_points(const scenes::Scene& scene, const scenes::RayQuery& query,
                                     const std::vector<scenes::Hit>& all) {
  const radiosity::ClosedBodies bodies(scene, query.centre());
  const radiosity::Patches patches = radiosity::subdivide(scene, 1e9);
  std::vector<scenes::Hit> open;
  for (const scenes::Hit& hit : all) {
    const std::uint32_t patch = patches.find(hit.triangle, hit.u, hit.v, hit.front);
    const double lift = query.offset_m(hit.triangle);
    const Vec3 at = scenes::hit_position(scene, hit) + lift * patches.normal(patch);
    if (!bodies.cover(at - bodies.centre(), bodies.near(patches, patch, 2.0 * lift))) {
      open.push_back(hit);
    }
  }
  return open;
}

void print(const std::vector<std::string>& arguments) {
  constexpr std::uint64_t seed = 20261121;  // differs from all seeds in use
  const std::string& path = arguments.at(0);
  const scenes::Scene scene = scenes::read_scene(path);
  const scenes::RayQuery query(scene);
  const auto where = open_points(
      scene, query, validation::spread_over_surfaces(scene, std::stoul(arguments.at(1)), seed));
  std::vector<std::vector<double>> columns;
  std::vector<std::string> words = {"--"};
  const auto end = [&] {
    columns.push_back(validation::radiosity_at(query, read(path, words), where));
    words = {"--"};
  };
  for (std::size_t k = 2; k < arguments.size(); ++k) {
    if (arguments[k] == "--") {
      end();
    } else {
      words.push_back(arguments[k]);
    }
  }
  end();
  for (std::size_t i = 0; i < where.size(); ++i) {
    std::string line;
    for (const auto& column : columns) line += fmt::format("{:.9g} ", column[i]);
    fmt::print("{}\n", line);
  }
}

}  // namespace

int main(int count, char** words) {
  try {
    print({words + 1, words + count});
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
