// SPDX-License-Identifier: Apache-2.0
// earthshine plan: which effects will run and why, with rays, memory and time. Traces a few rows of
// form factors for the memory, and a small run of everything for the seconds.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <memory>

#include "app/call/memory.h"
#include "app/call/render_call.h"
#include "app/cctv/cctv.h"
#include "app/console.h"
#include "app/options.h"
#include "app/render/effect_table.h"
#include "app/render/light.h"
#include "base/free_memory.h"
#include "base/parallel.h"
#include "radiosity/near_lamps.h"
#include "radiosity/refine.h"
#include "scenes/effects/quality.h"

namespace earthshine::app {
namespace {

constexpr double network_bytes_per_s = 12.5e9;  // assumed: 100 Gbit/s (docs/scaling.md)

std::vector<const scenes::Camera*> planned_cameras(const RenderCall& call,
                                                   const scenes::Scene& scene) {
  if (!call.cameras.empty()) return each_once(wanted_cameras(call.cameras, scene));
  std::vector<const scenes::Camera*> all;
  for (const scenes::Camera& camera : scene.cameras) all.push_back(&camera);
  return all;
}

Json stages_that_run(const Json& planned) {
  Json names = Json::array();
  for (const Json& stage : planned) {
    if (stage["runs"].get<bool>()) names.push_back(stage["stage"]);
  }
  return names;
}

Json images_of(const scenes::Scene& scene, const RenderCall& call, const scenes::Asked& asked,
               std::uint64_t gather_rays) {
  Json images = Json::array();
  for (const scenes::Camera* camera : asked.cameras) {
    const Size size = call.size.value_or(Size{camera->columns, camera->rows});
    const auto pixels =
        static_cast<std::uint64_t>(size.columns) * static_cast<std::uint64_t>(size.rows);
    images.push_back(
        {{"camera", camera->name},
         {"resolution", {size.columns, size.rows}},
         {"gather_rays", pixels * gather_rays},
         {"cctv_stages", stages_that_run(plan_cctv(scene, *camera, !call.cctv.empty()))}});
  }
  return images;
}

// Bytes per rank: of the first, which has the vectors of the linear solve, and of the others.
struct RankBytes {
  double first = 0.0, others = 0.0;
  void take_most(studies::MemoryCase sizes) {
    first = std::max(first, studies::memory_needed(sizes).total());
    sizes.first_rank = false;
    others = std::max(others, studies::memory_needed(sizes).total());
  }
};

// Memory of the solution with its error, and of each camera's picture in its own size, including
// the solution. Returns the maximum for ranks that divide the matrix; 0: no mpirun.
RankBytes add_memory(Json& report, const LoadedScene& loaded, const RenderCall& call,
                     const Common& common, const scenes::RayQuery& query, int ranks,
                     std::size_t patches) {
  const radiosity::SolveOptions solver = solver_of(call, loaded.scene, common);
  studies::MemoryCase sizes =
      studies::memory_case(loaded.scene, loaded.groups, loaded.effects, solver, patches);
  if (!loaded.effects.solution) {
    sizes.solves = false;
    sizes.columns = 0;
  }
  studies::expect_rows(sizes, loaded.scene, query, solver);
  RankBytes most;
  const auto add = [&](Json& to, const studies::MemoryCase& one) {
    to["memory"] = memory_json(studies::memory_needed(one));
    studies::MemoryCase divided = one;
    divided.ranks = std::max(1, ranks);
    divided.has_mpi = ranks > 0;
    most.take_most(divided);
  };
  studies::MemoryCase alone = sizes;
  alone.states_error = true;
  add(report, alone);
  for (std::size_t k = 0; k < loaded.asked.cameras.size(); ++k) {
    studies::MemoryCase with_picture = sizes;
    studies::add_picture(with_picture, loaded.groups, loaded.effects,
                         picture_options(call, common, loaded, *loaded.asked.cameras[k]));
    add(report["images"][k], with_picture);
  }
  return most;
}

// Maximum over the solution and the pictures.
double most_mib(const Json& report) {
  double most = report["memory"]["total_mib"].get<double>();
  for (const Json& image : report["images"]) {
    most = std::max(most, image["memory"]["total_mib"].get<double>());
  }
  return most;
}

// Cost with `ranks` processes of earthshine-mpi.
void add_ranks(Json& report, const studies::Bill& bill, int ranks, const RankBytes& bytes) {
  double pixels = 0.0;
  for (const Json& image : report["images"]) {
    pixels += image["resolution"][0].get<double>() * image["resolution"][1].get<double>();
  }
  const studies::RanksCost cost =
      studies::ranks_cost(bill, report["right_hand_sides"].get<std::size_t>(), pixels);
  report["ranks"] = {{"count", ranks},
                     {"threads_each", base::available_threads()},
                     {"memory_mib_each", bytes.first / mib},
                     {"memory_mib_others", bytes.others / mib},
                     {"memory_mib_all", (bytes.first + bytes.others * (ranks - 1)) / mib},
                     {"seconds", studies::seconds_on_ranks(cost, ranks, network_bytes_per_s)},
                     {"shared_seconds", cost.shared_s},
                     {"unshared_seconds", cost.alone_s},
                     {"exchanged_bytes", studies::bytes_of_a_rank(cost, ranks)},
                     {"network_bytes_per_second", network_bytes_per_s}};
}

void add_seconds(Json& report, const LoadedScene& loaded, const RenderCall& call,
                 const Common& common, const scenes::RayQuery& query, int ranks,
                 const RankBytes& bytes) {
  const Expectation expected = expect(loaded, call, common, query);
  add_expectation(report["effects"], expected);
  const studies::Bill& bill = expected.pilot.bill;
  double pictures = 0.0;
  for (std::size_t k = 0; k < bill.pictures.size(); ++k) {
    report["images"][k]["rays"] = bill.pictures[k].rays.total();
    report["images"][k]["seconds"] = bill.pictures[k].seconds;
    pictures += bill.pictures[k].seconds;
  }
  report["expected"] = {{"seconds", studies::total_seconds(bill)},
                        {"solve_seconds", studies::total_seconds(bill) - pictures},
                        {"patches", bill.solve.patches},
                        {"cpu_seconds", studies::total_seconds(bill) * base::available_threads()},
                        {"pilot_seconds", expected.pilot.seconds},
                        {"pilot_cpu_seconds", expected.pilot.cpu_seconds}};
  if (ranks > 0) add_ranks(report, bill, ranks, bytes);
}

}  // namespace

Json plan_json(LoadedScene& loaded, const RenderCall& call, const Common& common, int ranks) {
  want_usual_error(call, loaded.scene);
  const scenes::QualityKnobs knobs = scenes::resolve_quality(loaded.scene);
  const radiosity::SolveOptions solver = solver_of(call, loaded.scene, common);
  const auto rays_per_patch = std::bit_ceil(static_cast<std::uint64_t>(solver.form_factor_rays));
  const bool refines = solver.refine.on && radiosity::is_lit(loaded.effects);
  const std::size_t patches = refines
                                  ? radiosity::most_refined_patches(loaded.scene, solver)
                                  : radiosity::count_near_lamps(loaded.scene, solver.patch_edge_m);
  const bool solves = loaded.effects.solution;
  Json report;
  report["scene"] = loaded.scene.path.string();
  report["name"] = loaded.scene.name;
  report["effects"] = effect_rows(loaded, call);
  report["light_groups"] = loaded.groups.names;
  report["quality"] = {{"patch_edge_m", solver.patch_edge_m},
                       {"refine", solver.refine.on},
                       {"form_factor_rays", rays_per_patch},
                       {"gather_rays", knobs.gather_rays},
                       {"solver_tolerance", solver.tolerance},
                       {"error", to_json(loaded.scene.quality.error)},
                       {"max_patches", knobs.max_patches > 0 ? Json(knobs.max_patches) : Json()},
                       {"camera_samples", knobs.camera_samples},
                       {"denoise", knobs.denoise}};
  report["patches"] = patches;
  report["patches_at_most"] = refines;
  report["rays"] = solves ? patches * rays_per_patch : 0;
  report["right_hand_sides"] = 3 * loaded.groups.count();
  report["images"] = images_of(loaded.scene, call, loaded.asked,
                               solves ? static_cast<std::uint64_t>(knobs.gather_rays) : 0);
  const scenes::RayQuery query = ray_query(loaded, {loaded.asked.cameras}, common.quiet);
  const RankBytes bytes = add_memory(report, loaded, call, common, query, ranks, patches);
  add_seconds(report, loaded, call, common, query, ranks, bytes);
  report["warnings"] = loaded.scene.warnings;
  return report;
}

namespace {

Json report_of(const RenderCall& call, const Common& common, int ranks) {
  LoadedScene loaded = load(call.scene, common.quiet, [&](const scenes::Scene& scene) {
    return wanted_effects(call, planned_cameras(call, scene));
  });
  return plan_json(loaded, call, common, ranks);
}

// A warning, not an error as in render: rows may turn out less full.
std::string too_much_text(const Json& report) {
  const auto free_bytes = base::free_memory_bytes();
  if (!free_bytes) return "";
  const double free_mib = static_cast<double>(*free_bytes) / 1048576.0;
  if (most_mib(report) <= free_mib) return "";
  return fmt::format("that may not fit: {:.0f} MiB are {}; render looks closer and refuses\n",
                     free_mib, base::memory_bound());
}

std::string ranks_text(const Json& ranks) {
  return fmt::format(
      "on {} rank(s) with {} core(s) each: at best {}, of which {} do not depend on the number of "
      "ranks\nmemory: {:.0f} MiB in the first rank, {:.0f} MiB in each other rank, {:.0f} MiB in "
      "all\n",
      ranks["count"], ranks["threads_each"], duration(ranks["seconds"].get<double>()),
      duration(ranks["unshared_seconds"].get<double>()), ranks["memory_mib_each"],
      ranks["memory_mib_others"], ranks["memory_mib_all"]);
}

std::string text_of(const Json& report) {
  std::string text = fmt::format("{} ({})\n\n", report["name"], report["scene"]);
  text += effect_text(report["effects"]);
  const Json& quality = report["quality"];
  const bool refines = report["patches_at_most"].get<bool>();
  const bool solves = report["rays"].get<double>() > 0.0;
  if (solves) {
    text += fmt::format("\n{}{} patches {}; {} form-factor rays ({} per patch)\n",
                        refines ? "at most " : "", report["patches"],
                        refines ? std::string("where light varies")
                                : fmt::format("with edges up to {:g} m", quality["patch_edge_m"]),
                        short_count(report["rays"].get<double>()), quality["form_factor_rays"]);
    text += fmt::format("{} right-hand sides, solved to {:g}\n", report["right_hand_sides"],
                        quality["solver_tolerance"]);
    text += std::string("memory of the solution: ") + (refines ? "at most " : "") +
            memory_text(report["memory"]) + "\n";
  } else {
    text += "\nno radiosity: nothing is cut into patches and solved\n";
  }
  text += too_much_text(report);
  text += fmt::format("expected on this machine: {}",
                      duration(report["expected"]["seconds"].get<double>()));
  if (solves) {
    text += fmt::format(", of them {} for the solution of {} patches",
                        duration(report["expected"]["solve_seconds"].get<double>()),
                        report["expected"]["patches"]);
  }
  text += "\n";
  for (const Json& image : report["images"]) {
    text += fmt::format("camera {}: {} x {} pixels, {} gather rays, {}, {:.0f} MiB in all\n",
                        image["camera"], image["resolution"][0], image["resolution"][1],
                        short_count(image["gather_rays"].get<double>()),
                        duration(image["seconds"].get<double>()), image["memory"]["total_mib"]);
    const auto stages = image["cctv_stages"].get<std::vector<std::string>>();
    if (!stages.empty()) text += fmt::format("  cctv: {}\n", fmt::join(stages, ", "));
  }
  if (report.contains("ranks")) text += ranks_text(report["ranks"]);
  return text;
}

}  // namespace

Command add_plan(CLI::App& program) {
  CLI::App* parser = add_subcommand(program, "plan",
                                    "Which effects will run, which not and why, and how many rays");
  const auto call = std::make_shared<RenderCall>();
  add_scene_options(*parser, call->scene);
  add_picture_options(*parser, *call);
  parser->add_flag_callback(
      "--cctv", [call] { call->cctv = "asked"; },
      "As if the pictures on the CCTV monitors were asked for");
  const auto ranks = std::make_shared<std::uint64_t>(0);
  add_whole_number(*parser, "--ranks", *ranks, 1, 65536,
                   "What so many ranks of earthshine-mpi take, each of them");
  parser->add_flag("--json", call->json, "JSON on standard output");
  return {parser, [call, ranks](const Common& common) {
            check_picture_options(*call, common.quiet);
            const Json report = report_of(*call, common, static_cast<int>(*ranks));
            print(call->json ? dump(report) : text_of(report));
          }};
}

}  // namespace earthshine::app
