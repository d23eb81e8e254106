// SPDX-License-Identifier: Apache-2.0
// earthshine form-factors: the matrix between objects, and to the sky.
#include "radiosity/form_factors.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <numeric>

#include "app/command.h"
#include "app/console.h"
#include "radiosity/patches.h"
#include "scenes/quality.h"
#include "scenes/ray_query.h"

namespace earthshine::app {
namespace {

struct FactorsCall {
  SceneInput scene;
  bool raw = false;
  bool json = false;
};

constexpr std::size_t widest_table = 10;  // objects; beyond it each row lists its largest entries
constexpr std::size_t largest_listed = 6;

struct Found {
  std::vector<std::string> names;
  radiosity::ObjectFormFactors between;
  std::size_t patches = 0;
  int rays_per_patch = 0;
  std::uint64_t rays = 0;
};

Found find(const FactorsCall& call, const Common& common) {
  const LoadedScene loaded = load(call.scene, common.quiet);
  const scenes::Scene& scene = loaded.scene;
  const scenes::QualityKnobs knobs = scenes::resolve_quality(scene);
  const scenes::RayQuery query(scene);
  const radiosity::Patches patches = radiosity::subdivide(scene, knobs.patch_edge_m);
  radiosity::FormFactors factors =
      radiosity::cast_form_factors(scene, query, patches, {knobs.form_factor_rays, common.seed});
  if (!call.raw) radiosity::balance(factors, patches.area_m2);
  Found found{{},
              radiosity::object_form_factors(scene, patches, factors),
              patches.count(),
              factors.rays_per_patch,
              factors.ray_count};
  for (const scenes::Object& object : scene.objects) found.names.push_back(object.name);
  return found;
}

Json json_of(const Found& found, bool raw) {
  return {{"objects", found.names},
          {"area_m2", found.between.area_m2},
          {"F", found.between.F},
          {"sky", found.between.sky},
          {"black", found.between.black},
          {"std_error", found.between.std_error},
          {"max_row_error", found.between.max_row_error},
          {"max_reciprocity_error", found.between.max_reciprocity_error},
          {"balanced", !raw},
          {"patches", found.patches},
          {"rays_per_patch", found.rays_per_patch},
          {"rays", found.rays}};
}

std::string matrix(const Found& found) {
  std::string text = fmt::format("{:<16} {:>10}", "F from \\ to", "area m2");
  for (const std::string& name : found.names) text += fmt::format(" {:>10.10}", name);
  text += fmt::format(" {:>10} {:>10}\n", "sky", "black");
  for (std::size_t i = 0; i < found.names.size(); ++i) {
    text += fmt::format("{:<16.16} {:>10.5g}", found.names[i], found.between.area_m2[i]);
    for (const double f : found.between.F[i]) text += fmt::format(" {:>10.6f}", f);
    text += fmt::format(" {:>10.6f} {:>10.6f}\n", found.between.sky[i], found.between.black[i]);
  }
  return text;
}

std::string largest_entries(const Found& found) {
  std::string text = fmt::format("{:<24} {:>10} {:>9} {:>9}  {}\n", "from", "area m2", "sky",
                                 "black", "largest factors (all of them: --json)");
  for (std::size_t i = 0; i < found.names.size(); ++i) {
    const std::vector<double>& row = found.between.F[i];
    std::vector<std::size_t> order(row.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto end =
        order.begin() + static_cast<std::ptrdiff_t>(std::min(largest_listed, row.size()));
    std::partial_sort(order.begin(), end, order.end(), [&row](std::size_t a, std::size_t b) {
      return row[a] != row[b] ? row[a] > row[b] : a < b;
    });
    text += fmt::format("{:<24} {:>10.5g} {:>9.5f} {:>9.5f} ", found.names[i],
                        found.between.area_m2[i], found.between.sky[i], found.between.black[i]);
    for (auto j = order.begin(); j != end && row[*j] > 0.0; ++j) {
      text += fmt::format(" {} {:.5f}", found.names[*j], row[*j]);
    }
    text += "\n";
  }
  return text;
}

std::string text_of(const Found& found, bool raw) {
  double worst_error = 0.0;
  for (const auto& row : found.between.std_error) {
    for (const double e : row) worst_error = std::max(worst_error, e);
  }
  std::string text = found.names.size() <= widest_table ? matrix(found) : largest_entries(found);
  text += fmt::format(
      "\n{} patches, {} rays per patch{}\nlargest standard error {:.2g}, row error {:.2g}, "
      "reciprocity error {:.2g}\n",
      found.patches, found.rays_per_patch, raw ? ", as cast" : ", balanced", worst_error,
      found.between.max_row_error, found.between.max_reciprocity_error);
  return text;
}

}  // namespace

Command add_form_factors(CLI::App& program) {
  CLI::App* parser =
      program.add_subcommand("form-factors", "Form factors between objects, and to the sky");
  const auto call = std::make_shared<FactorsCall>();
  add_scene_options(*parser, call->scene);
  parser->add_flag("--raw", call->raw, "As cast, before energy conservation is imposed");
  parser->add_flag("--json", call->json, "JSON on standard output");
  return {parser, [call](const Common& common) {
            const Found found = find(*call, common);
            print(call->json ? dump(json_of(found, call->raw)) : text_of(found, call->raw));
          }};
}

}  // namespace earthshine::app
