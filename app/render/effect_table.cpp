// SPDX-License-Identifier: Apache-2.0
#include "app/render/effect_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/call/memory.h"
#include "app/cctv/cctv.h"
#include "app/console.h"
#include "app/render/light.h"
#include "base/parallel.h"

namespace earthshine::app {
namespace {

// A stage runs if one of the cameras needs it; the first such camera gives the reason.
void add_cctv_rows(Json& rows, const LoadedScene& loaded, const RenderCall& call) {
  Json stages = Json::array();
  for (const scenes::Camera* camera : loaded.asked.cameras) {
    Json planned = plan_cctv(loaded.scene, *camera, !call.cctv.empty());
    if (stages.empty()) {
      stages = std::move(planned);
      continue;
    }
    for (std::size_t k = 0; k < planned.size(); ++k) {
      if (planned[k]["runs"].get<bool>() && !stages[k]["runs"].get<bool>()) stages[k] = planned[k];
    }
  }
  for (const Json& stage : stages) {
    rows.push_back({{"effect", "cctv: " + stage["stage"].get<std::string>()},
                    {"runs", stage["runs"]},
                    {"why", stage["why"]}});
  }
}

}  // namespace

Json effect_rows(const LoadedScene& loaded, const RenderCall& call) {
  Json rows = Json::array();
  for (const auto& row : scenes::describe_effects(loaded.scene, loaded.groups, loaded.asked)) {
    rows.push_back({{"effect", row.effect}, {"runs", row.runs}, {"why", row.reason}});
  }
  for (const scenes::Culling& off : loaded.culled) {
    const auto row = std::find_if(rows.begin(), rows.end(),
                                  [&](const Json& r) { return r["effect"] == off.effect; });
    // Other lamps of the kind may be on.
    const auto kinds = scenes::lamp_kinds;
    bool still = false;
    for (std::size_t kind = 0; kind < kinds; ++kind) {
      const auto light = scenes::kind_of(static_cast<scenes::LampKind>(kind));
      still |= loaded.effects.lamp_kind[kind] && scenes::effect_of(light) == off.effect;
    }
    (*row)["runs"] = still;
    (*row)["why"] = still ? (*row)["why"].get<std::string>() + "; " + off.why : off.why;
    (*row)["skipped_error"] = off.error;
  }
  add_cctv_rows(rows, loaded, call);
  return rows;
}

Expectation expect(const LoadedScene& loaded, const RenderCall& call, const Common& common,
                   const scenes::RayQuery& query) {
  const radiosity::SolveOptions solver = solver_of(call, loaded.scene, common);
  std::vector<raytrace::RenderOptions> options;
  for (const scenes::Camera* camera : loaded.asked.cameras) {
    options.push_back(picture_options(call, common, loaded, *camera));
  }
  // Cast once, for the memory and for the solver's seconds.
  studies::MemoryCase sizes =
      studies::memory_case(loaded.scene, loaded.groups, loaded.effects, solver);
  if (!loaded.effects.solution) {
    sizes.solves = false;
    sizes.columns = 0;
  }
  if (!call.solution.empty()) sizes.solves = false;
  studies::expect_rows(sizes, loaded.scene, query, solver);
  Expectation expected;
  (void)common.progress->begin("pilot", Work::Pilot,
                               static_cast<double>(loaded.asked.cameras.size()));
  expected.pilot = studies::expect_costs({loaded.world(query), solver, sizes.row_entries},
                                         loaded.asked.cameras, options);
  // The pilot's own solve then only supplies light.
  if (!call.solution.empty()) expected.pilot.bill.solve = {};
  expected.costs = studies::effect_costs(expected.pilot.bill, loaded.effects);
  studies::EffectCost cctv{"cctv"};
  Common quiet = common;
  quiet.quiet = true;
  for (std::size_t k = 0; k < loaded.asked.cameras.size(); ++k) {
    if (call.cctv.empty()) break;
    const CctvSetup setup = cctv_of_camera(loaded.scene, *loaded.asked.cameras[k], quiet);
    StageTimes times;
    times.measure("cctv", [&] { return run_chain(setup, expected.pilot.pictures[k]); });
    cctv.seconds += times.total();
  }
  expected.costs.push_back(cctv);

  expected.memory = studies::memory_needed(sizes);
  for (const raytrace::RenderOptions& picture : options) {
    studies::MemoryCase with_picture = sizes;
    studies::add_picture(with_picture, loaded.groups, loaded.effects, picture);
    studies::MemoryNeed need = studies::memory_needed(with_picture);
    if (need.total() > expected.memory.total()) expected.memory = std::move(need);
  }
  return expected;
}

namespace {

const studies::EffectCost* find_cost(const std::vector<studies::EffectCost>& costs,
                                     const std::string& effect) {
  const auto found = std::find_if(costs.begin(), costs.end(),
                                  [&](const auto& cost) { return cost.effect == effect; });
  return found == costs.end() ? nullptr : &*found;
}

// Memory used because of an effect.
double memory_mib(const studies::MemoryNeed& need, const std::string& effect) {
  double bytes = 0.0;
  for (const studies::MemoryPart& part : need.parts) {
    const bool solving =
        part.name == "form factors" || part.name == "patches" || part.name == "solution";
    if (effect == "interreflection" && solving) bytes += part.bytes;
    if (effect == "light groups" && part.name == "light groups") bytes += part.bytes;
    if (effect == "camera rays" && part.name == "picture") bytes += part.bytes;
  }
  return bytes / mib;
}

Json cost_json(const std::vector<studies::EffectCost>& costs, const Json& row) {
  const studies::EffectCost* cost = find_cost(costs, row["effect"].get<std::string>());
  if (cost == nullptr || !row["runs"].get<bool>()) return {{"rays", 0.0}, {"seconds", 0.0}};
  return {{"rays", cost->rays}, {"seconds", cost->seconds}};
}

Json camera_row() {
  return {{"effect", "camera rays"}, {"runs", true}, {"why", "every picture has them"}};
}

Json expectation_json(const Expectation& expected, const Json& row) {
  Json cost = cost_json(expected.costs, row);
  const bool runs = row["runs"].get<bool>();
  cost["memory_mib"] = runs ? memory_mib(expected.memory, row["effect"].get<std::string>()) : 0.0;
  return cost;
}

}  // namespace

void add_expectation(Json& rows, const Expectation& expected) {
  rows.push_back(camera_row());
  for (Json& row : rows) row.update(expectation_json(expected, row));
}

Json report_json(const LoadedScene& loaded, const RenderCall& call, const Expectation& expected,
                 const radiosity::SolveReport& solved, const std::vector<Picture>& pictures,
                 const StageTimes& times, double cpu_seconds) {
  const double threads = base::available_threads();
  studies::Bill bill;
  // A solution that is read costs nothing here.
  if (call.solution.empty()) bill.solve = solved;
  studies::EffectCost cctv{"cctv"};
  for (const Picture& picture : pictures) {
    bill.pictures.push_back(picture.rendered);
    for (const auto& [stage, seconds] : picture.times.stages()) {
      if (stage == "cctv") cctv.seconds += seconds;
    }
  }
  std::vector<studies::EffectCost> taken = studies::effect_costs(bill, loaded.effects);
  taken.push_back(cctv);
  Json rows = effect_rows(loaded, call);
  rows.push_back(camera_row());
  for (Json& row : rows) {
    row["expected"] = expectation_json(expected, row);
    row["taken"] = cost_json(taken, row);
  }
  return {{"scene", loaded.scene.path.string()},
          {"name", loaded.scene.name},
          {"warnings", loaded.scene.warnings},
          {"solution", call.solution.empty() ? Json(nullptr) : Json(call.solution)},
          {"effects", rows},
          {"expected",
           {{"seconds", studies::total_seconds(expected.pilot.bill)},
            {"patches", expected.pilot.bill.solve.patches},
            {"memory_mib", memory_json(expected.memory)["total_mib"]},
            {"cpu_seconds", studies::total_seconds(expected.pilot.bill) * threads},
            {"pilot_seconds", expected.pilot.seconds},
            {"pilot_cpu_seconds", expected.pilot.cpu_seconds}}},
          {"taken",
           {{"seconds", studies::total_seconds(bill)},
            {"cpu_seconds", cpu_seconds},
            {"patches", solved.patches},
            {"memory_mib", peak_memory_mib()},
            {"stages", times.json()}}}};
}

std::string effect_text(const Json& rows) {
  std::string text;
  for (const Json& row : rows) {
    const auto cell = [&row](const char* key, const auto& words) {
      const double value = row.contains(key) ? row[key].get<double>() : 0.0;
      return value > 0.0 ? words(value) : std::string();
    };
    text += fmt::format(
        "  {:<4} {:<20} {:>8} {:>8} {:>8}  {}\n", row["runs"].get<bool>() ? "yes" : "no",
        row["effect"], cell("rays", [](double n) { return short_count(n); }),
        cell("seconds", [](double s) { return fmt::format("{:.2g} s", s); }),
        cell("memory_mib", [](double m) { return fmt::format("{:.0f} MiB", m); }), row["why"]);
  }
  return text;
}

}  // namespace earthshine::app
