// SPDX-License-Identifier: Apache-2.0
#include "app/visibility/plan.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "app/console.h"
#include "app/views/frames.h"
#include "app/visibility/run.h"
#include "base/parallel.h"
#include "degrade/chain.h"
#include "scenes/effects/quality.h"
#include "studies/cost/cost.h"
#include "studies/cost/memory.h"

namespace earthshine::app {
namespace {

// One pass of the CCTV chain over a flat picture: minimum time of a condition.
double chain_seconds(const StudyCamera& camera) {
  if (!camera.cctv) return 0.0;
  base::Image flat = base::make_rgb_image(camera.columns, camera.rows);
  for (base::Channel& channel : flat.channels) {
    std::fill(channel.values.begin(), channel.values.end(), 100.0F);
  }
  degrade::Options options = camera.cctv->chain.options;
  options.fov_deg = camera.camera->fov_deg;
  const auto start = std::chrono::steady_clock::now();
  (void)degrade::degrade(flat, camera.cctv->chain.camera, camera.cctv->chain.monitor, options);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

struct Pictures {
  std::vector<const scenes::Camera*> cameras;
  std::vector<raytrace::RenderOptions> options;
};
struct CostEstimate {
  double solve_s = 0.0, memory_mib = 0.0;
  std::vector<double> picture_s;
};

// From a pilot of the pictures.
CostEstimate estimate_cost(const StudyPart& part, const Pictures& pictures, const Common& common) {
  if (pictures.cameras.empty()) return {};
  const LoadedScene& basis = part.basis_scene;
  const radiosity::SolveOptions solver = study_solver(basis.scene, common);
  studies::MemoryCase sizes =
      studies::memory_case(basis.scene, basis.groups, basis.effects, solver);
  studies::expect_rows(sizes, basis.scene, *part.query, solver);
  studies::add_picture(sizes, basis.groups, basis.effects, pictures.options.front());
  (void)common.progress->begin("pilot of " + part.path, Work::Pilot,
                               static_cast<double>(pictures.cameras.size()));
  const studies::Pilot pilot = studies::expect_costs(
      {basis.world(*part.query), solver, sizes.row_entries}, pictures.cameras, pictures.options);
  CostEstimate found;
  found.memory_mib = studies::memory_needed(sizes).total() / 1048576.0;
  found.solve_s = studies::total_seconds(pilot.bill);
  double drawn = 0.0;
  for (const auto& picture : pilot.bill.pictures) {
    found.picture_s.push_back(picture.seconds);
    drawn += picture.seconds;
  }
  found.solve_s -= drawn;
  return found;
}

Json plan_of(const StudyPart& part, const std::filesystem::path& folder, const Common& common) {
  const LoadedScene& basis = part.basis_scene;
  std::error_code ignored;
  const std::filesystem::path points = folder / points_folder;
  const PartCall alone;
  std::optional<StudyFrames> frames;
  if (std::filesystem::is_directory(points, ignored)) frames.emplace(part, points, common, alone);
  Pictures pictures;
  Json listed = Json::array();
  for (const StudyCamera& camera : part.cameras) {
    const bool found = frames && frames->has(camera);
    listed.push_back(
        {{"camera", camera.camera->name},
         {"columns", camera.columns},
         {"rows", camera.rows},
         {"cctv", camera.cctv ? Json(camera.cctv->name) : Json()},
         {"found", found},
         {"seconds", 0.0},
         {"conditions_seconds", static_cast<double>(part.conditions()) * chain_seconds(camera) /
                                    base::available_threads()}});
    if (found) continue;
    raytrace::RenderOptions options =
        raytrace::render_options(scenes::resolve_quality(basis.scene));
    options.columns = camera.columns;
    options.rows = camera.rows;
    options.per_light = true;
    pictures.cameras.push_back(camera.camera);
    pictures.options.push_back(options);
  }
  const CostEstimate expected = estimate_cost(part, pictures, common);
  std::size_t next = 0;
  for (Json& one : listed) {
    if (!one["found"].get<bool>()) one["seconds"] = expected.picture_s[next++];
  }
  return {{"id", part.id},
          {"path", part.path},
          {"targets", part.targets},
          {"positions", part.basis->places().size()},
          {"conditions", part.conditions()},
          {"light_groups", basis.groups.count()},
          {"suns", part.basis->in_parts() ? part.basis->sun_parts() : 0},
          {"earth_cells", part.basis->in_parts() ? part.basis->earth_parts() : 0},
          {"memory_mib", expected.memory_mib},
          {"solve_seconds", expected.solve_s},
          {"cameras", listed}};
}

}  // namespace

Json plan_json(const studies::StudyFile& study, const std::vector<const StudyPart*>& parts,
               const std::filesystem::path& folder, const Common& common) {
  Json plan = {{"study", "visibility"}, {"name", study.name}, {"dry_run", true}};
  Json lamps = Json::array();
  for (const studies::LampSetting& setting : study.lamps) lamps.push_back(setting.name);
  plan["lamps"] = lamps;
  plan["scenes"] = Json::array();
  double seconds = 0.0;
  for (const StudyPart* part : parts) {
    const Json one = plan_of(*part, folder, common);
    seconds += one["solve_seconds"].get<double>();
    for (const Json& camera : one["cameras"]) {
      seconds += camera["seconds"].get<double>() + camera["conditions_seconds"].get<double>();
    }
    plan["scenes"].push_back(one);
  }
  plan["pictures"] = study.pictures.size();
  plan["seconds"] = seconds;
  return plan;
}

std::string plan_text(const Json& plan) {
  std::string text = plan["name"].get<std::string>() + "\n";
  for (const Json& scene : plan["scenes"]) {
    text += fmt::format(
        "{}: {} places x {} lamp settings = {} conditions; {} light groups ({} Suns, {} cells of "
        "the "
        "Earth), {:.0f} MiB; radiosity {}\n",
        scene["path"], scene["positions"], plan["lamps"].size(), scene["conditions"],
        scene["light_groups"], scene["suns"], scene["earth_cells"], scene["memory_mib"],
        duration(scene["solve_seconds"].get<double>()));
    for (const Json& camera : scene["cameras"]) {
      const std::string drawing = camera["found"].get<bool>()
                                      ? "picture found"
                                      : "picture " + duration(camera["seconds"].get<double>());
      text += fmt::format("  camera {}: {} x {}, {}, conditions {}\n", camera["camera"],
                          camera["columns"], camera["rows"], drawing,
                          duration(camera["conditions_seconds"].get<double>()));
    }
  }
  return text + fmt::format(
                    "{} pictures for the report\nabout {} on this machine, without the "
                    "reasons of targets that fail\n",
                    plan["pictures"], duration(plan["seconds"].get<double>()));
}

void fill_pictures(studies::StudyFile& study, const StudyPart& part) {
  if (!study.pictures.empty()) return;
  const std::vector<double>& positions = part.positions_deg;
  std::optional<double> midnight;
  for (const double position : positions) {
    const auto off = [](double deg) { return std::abs(std::remainder(deg - 180.0, 360.0)); };
    if (!midnight || off(position) < off(*midnight)) midnight = position;
  }
  for (const StudyCamera& camera : part.cameras) {
    const std::string name = camera.camera->name;
    const auto add = [&](const std::string& suffix, const std::string& what,
                         std::optional<double> position, studies::Shows shows) {
      studies::PictureWish wish;
      wish.name = name + suffix;
      wish.title = fmt::format("Camera {}, {}", name, what);
      wish.camera = name;
      wish.position_deg = position;
      wish.shows = shows;
      study.pictures.push_back(wish);
    };
    const auto add_place = [&](const std::string& suffix, const std::string& what,
                               std::optional<double> position) {
      add(suffix, what, position, studies::Shows::Clean);
      if (!camera.cctv) return;
      add(suffix + "-cctv", what + ", on the monitor", position, studies::Shows::Cctv);
      study.pairs.push_back({fmt::format("Camera {}, {}: clean and on the monitor", name, what),
                             name + suffix, name + suffix + "-cctv"});
    };
    if (positions.size() < 2) {
      add_place("", "as the scene has it",
                positions.empty() ? std::nullopt : std::optional(positions.front()));
      continue;
    }
    const auto at = [&](double position) { return place_text(positions, part.moments, position); };
    const auto suffix = [&](double position) {
      return "-" + (part.moments.empty() ? fmt::format("{:g}-deg", position) : at(position));
    };
    const std::string first = suffix(positions.front()), last = suffix(*midnight);
    add_place(first, at(positions.front()), positions.front());
    if (*midnight == positions.front()) continue;
    add_place(last, at(*midnight), midnight);
    const std::string kind = camera.cctv ? "-cctv" : "";
    study.pairs.push_back(
        {part.moments.empty()
             ? fmt::format("Camera {}: orbit {:g} and {:g} deg", name, positions.front(), *midnight)
             : fmt::format("Camera {}: {} and {}", name, at(positions.front()), at(*midnight)),
         name + first + kind, name + last + kind});
  }
}

}  // namespace earthshine::app
