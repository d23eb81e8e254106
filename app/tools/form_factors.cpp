// SPDX-License-Identifier: Apache-2.0
// earthshine form-factors: the matrix between objects, and to the sky.
#include "app/tools/form_factors.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>

#include "app/call/memory.h"
#include "app/command.h"
#include "app/console.h"
#include "app/options.h"
#include "base/error.h"
#include "radiosity/exact/form_factors.h"
#include "radiosity/objects/form_factors.h"
#include "radiosity/patches/patches.h"
#include "scenes/effects/quality.h"
#include "scenes/ray_query.h"
#include "scenes/reflect/specular.h"
#include "scenes/surface_texture.h"

namespace earthshine::app {
namespace {

// Up to this number `auto` uses the exact method: its time grows with the square of the number.
constexpr std::size_t most_facets_for_auto = 1000;

using Method = FactorMethod;

struct FactorsCall {
  SceneInput scene;
  Method method = Method::Auto;
  bool raw = false;
  bool json = false, csv = false;
};

constexpr std::size_t widest_table = 10;  // objects; larger tables list the largest entries only
constexpr std::size_t largest_listed = 6;

struct Found {
  std::vector<std::string> names;
  radiosity::ObjectFormFactors between;
  radiosity::ObjectFactorReport rays;  // by rays only
  radiosity::ExactReport exact;        // by the exact method only
  bool is_exact = false;
  std::size_t patches = 0;
  double seconds = 0.0;
};

// Rays per face: all faces together take a fraction of a second.
int split_rays(std::size_t faces) {
  constexpr std::size_t all_rays = std::size_t{1} << 21, most = 1U << 16, fewest = 256;
  return static_cast<int>(std::clamp(all_rays / std::max<std::size_t>(1, faces), fewest, most));
}

// Between objects the exact method needs no patches: it integrates over whole facets.
void find_exactly(const scenes::Scene& scene, const scenes::RayQuery& query,
                  const radiosity::Patches& facets, const Common& common, Found& found) {
  const radiosity::ExactFormFactors exact = radiosity::exact_form_factors(
      scene, query, facets, {.split_rays = split_rays(facets.count()), .seed = common.seed});
  found.between = radiosity::object_form_factors(scene, facets, exact.factors);
  found.exact = exact.report;
  // Relative error of the area rules for unoccluded pairs.
  constexpr double area_rule_error = 2e-5;
  radiosity::ObjectFormFactors& o = found.between;
  // Rays divide the rest of a row between sky and black backs; points estimate the open part of a
  // face.
  std::vector<double> split(o.F.size(), 0.0), open(o.F.size(), 0.0), apart(o.F.size(), 0.0);
  for (std::uint32_t i = 0; i < facets.count(); ++i) {
    const double shared = facets.area_m2[i] * exact.report.split_std_error[i];
    const double points = facets.area_m2[i] * exact.report.open_std_error[i];
    split[facets.object(i)] += shared * shared;
    apart[facets.object(i)] += facets.area_m2[i] * exact.report.disagreement[i];
    open[facets.object(i)] += points * points;
  }
  for (std::size_t i = 0; i < o.F.size(); ++i) {
    if (o.open_area_m2[i] <= 0.0) continue;
    const double of_area = std::sqrt(open[i]) / o.open_area_m2[i];
    const double of_row = std::hypot(exact.report.estimated_error, apart[i] / o.open_area_m2[i]);
    const auto error_of = [&](double f) {
      return std::hypot(std::hypot(of_row, area_rule_error * f), of_area * f);
    };
    std::transform(o.F[i].begin(), o.F[i].end(), o.std_error[i].begin(), error_of);
    const double rest = o.sky[i] + o.black[i];
    o.sky_std_error[i] = o.black_std_error[i] =
        std::hypot(std::hypot(of_row, area_rule_error * rest),
                   std::hypot(std::sqrt(split[i]) / o.open_area_m2[i], of_area * (1.0 - rest)));
  }
}

Found find(LoadedScene& loaded, Method method, bool raw, const Common& common) {
  if (raw && method == Method::Exact) {
    throw base::Error(base::Blame::Input, "--raw", "is of rays, and --method exact casts none", {},
                      "Leave one of the two out");
  }
  const scenes::Scene& scene = loaded.scene;
  const scenes::QualityKnobs knobs = scenes::resolve_quality(scene);
  const auto start = std::chrono::steady_clock::now();
  const scenes::RayQuery query = ray_query(loaded, {{}, false, false}, common.quiet);
  const radiosity::Patches facets =
      radiosity::subdivide(scene, std::numeric_limits<double>::infinity());
  Found found;
  found.is_exact = method == Method::Exact ||
                   (method == Method::Auto && !raw && !scenes::any_passes_light_on(scene) &&
                    !scenes::any_has_holes(scene) && facets.count() <= most_facets_for_auto);
  if (found.is_exact) {
    found.patches = facets.count();
    find_exactly(scene, query, facets, common, found);
  } else {
    check_row_memory(loaded, query, knobs.patch_edge_m,
                     knobs.form_factor_rays / static_cast<int>(radiosity::ray_replicates));
    const radiosity::Patches patches = radiosity::subdivide(scene, knobs.patch_edge_m);
    found.patches = patches.count();
    found.between = radiosity::object_form_factors_by_rays(
        scene, query, patches, {knobs.form_factor_rays, common.seed, raw}, found.rays);
  }
  if (found.exact.disagreeing_rows > 0 && !common.quiet) {
    note(
        fmt::format("warning: of {} faces the exact factors leave more or less open than rays find "
                    "open, beyond "
                    "the errors of both; the errors are widened. Compare with --method rays",
                    found.exact.disagreeing_rows));
  }
  if (found.rays.disagreeing_pairs > 0 && !common.quiet) {
    note(
        fmt::format("warning: the two estimates of {} pairs disagree beyond their noise, as where "
                    "faces of two objects lie on each other; their errors are widened",
                    found.rays.disagreeing_pairs));
  }
  for (const scenes::Object& object : scene.objects) found.names.push_back(object.name);
  const std::chrono::duration<double> gone = std::chrono::steady_clock::now() - start;
  found.seconds = gone.count();
  return found;
}

Json json_of(const Found& found) {
  Json json = {{"objects", found.names},
               {"area_m2", found.between.area_m2},
               {"open_area_m2", found.between.open_area_m2},
               {"F", found.between.F},
               {"sky", found.between.sky},
               {"black", found.between.black},
               {"std_error", found.between.std_error},
               {"sky_std_error", found.between.sky_std_error},
               {"black_std_error", found.between.black_std_error},
               {"max_row_error", found.between.max_row_error},
               {"max_reciprocity_error", found.between.max_reciprocity_error},
               {"balanced", found.is_exact || found.rays.reconciled},
               {"method", found.is_exact ? "exact" : "rays"},
               {"patches", found.patches},
               {"seconds", found.seconds}};
  if (found.is_exact) {
    json["before"] = {{"max_row_error", found.exact.max_closed_defect}};
    json["pairs"] = found.exact.pairs;
  } else {
    json["before"] = {{"max_row_error", found.rays.row_error_before},
                      {"max_reciprocity_error", found.rays.reciprocity_error_before}};
    json["rays_per_patch"] = found.rays.rays_per_patch;
    json["replicates"] = found.rays.replicates;
    json["rays"] = found.rays.rays;
  }
  return json;
}

// One pair per line, the usual exchange format of view factors.
std::string csv_of(const Found& found) {
  const radiosity::ObjectFormFactors& o = found.between;
  std::string text = "from,to,from_area_m2,F,std_error,from_open_area_m2\n";
  for (std::size_t i = 0; i < found.names.size(); ++i) {
    const auto line = [&](const std::string& to, double f, double error) {
      text += fmt::format("{},{},{},{},{},{}\n", csv_cell(found.names[i]), to, o.area_m2[i], f,
                          error, o.open_area_m2[i]);
    };
    for (std::size_t k = 0; k < found.names.size(); ++k) {
      line(csv_cell(found.names[k]), o.F[i][k], o.std_error[i][k]);
    }
    line("(sky)", o.sky[i], o.sky_std_error[i]);
    line("(black backs)", o.black[i], o.black_std_error[i]);
  }
  return text;
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

// Objects that bodies partly cover; the covered part is excluded.
std::string covered(const Found& found) {
  std::string text;
  for (std::size_t i = 0; i < found.names.size(); ++i) {
    const double all = found.between.area_m2[i], open = found.between.open_area_m2[i];
    if (open >= all) continue;
    text +=
        fmt::format("{}: {:.4g} of {:.4g} m2 lie in or under bodies; F is over the other {:.4g}\n",
                    found.names[i], all - open, all, open);
  }
  return text.empty() ? text : "\n" + text;
}

std::string text_of(const Found& found) {
  std::string text =
      "F, no unit: of diffuse light from the first, even over its open area, the share\n"
      "that lands on the other, leaves for the sky or meets black backs\n\n";
  text += found.names.size() <= widest_table ? matrix(found) : largest_entries(found);
  text += covered(found);
  double worst_error = 0.0;
  for (const auto& row : found.between.std_error) {
    for (const double e : row) worst_error = std::max(worst_error, e);
  }
  if (found.is_exact) {
    return text + fmt::format(
                      "\nexact: {} facets, {} pairs, largest error {:.1g}, row sums right to "
                      "{:.1g} before they were closed; {}\n",
                      found.patches, found.exact.pairs, worst_error, found.exact.max_closed_defect,
                      duration(found.seconds));
  }
  text += fmt::format(
      "\nlargest standard error {:.2g}, row error {:.2g}, reciprocity error {:.2g}{}\n",
      worst_error, found.between.max_row_error, found.between.max_reciprocity_error,
      found.rays.reconciled
          ? fmt::format(", balanced (as cast: {:.2g})", found.rays.reciprocity_error_before)
          : std::string(", as cast"));
  return text + fmt::format("{} patches, {} rays each in {} replicates, {}\n", found.patches,
                            found.rays.rays_per_patch, found.rays.replicates,
                            duration(found.seconds));
}

}  // namespace

FactorMethod factor_method(const std::string& option, const std::string& word) {
  if (word == "auto") return Method::Auto;
  if (word == "rays") return Method::Rays;
  if (word == "exact") return Method::Exact;
  throw base::Error(base::Blame::Input, option, "there is no method \"" + word + "\"",
                    "the methods are auto, rays and exact");
}

Json form_factors_json(LoadedScene& loaded, FactorMethod method, bool raw, const Common& common) {
  return json_of(find(loaded, method, raw, common));
}

Command add_form_factors(CLI::App& program) {
  CLI::App* parser =
      add_subcommand(program, "form-factors", "Form factors between objects, and to the sky");
  const auto call = std::make_shared<FactorsCall>();
  add_scene_options(*parser, call->scene);
  parser
      ->add_option_function<std::string>(
          "--method",
          [call](const std::string& word) { call->method = factor_method("--method", word); },
          "rays; exact: analytic, without mirrors or glass; auto: exact where that is quick")
      ->type_name("auto|rays|exact");
  parser->add_flag("--raw", call->raw,
                   "Rays as cast, before both laws, closure and reciprocity, hold");
  CLI::Option* json = parser->add_flag("--json", call->json, "JSON on standard output");
  parser->add_flag("--csv", call->csv, "A line per pair on standard output")->excludes(json);
  return {parser, [call](const Common& common) {
            LoadedScene loaded = load(call->scene, common.quiet);
            const Found found = find(loaded, call->method, call->raw, common);
            print(call->json ? dump(json_of(found)) : call->csv ? csv_of(found) : text_of(found));
          }};
}

}  // namespace earthshine::app
