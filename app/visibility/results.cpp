// SPDX-License-Identifier: Apache-2.0
#include "app/visibility/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "app/parts/result_cache.h"
#include "app/study/results.h"
#include "app/study/words.h"
#include "base/error.h"
#include "raytrace/error_budget.h"
#include "scenes/sky/orbit.h"
#include "scenes/text/message_text.h"

namespace earthshine::app {
namespace {

// For a camera's conditions; all targets of a condition share its picture's noise.
std::string noise_of_conditions(const CameraFindings& found,
                                std::span<const ConditionEntry> conditions) {
  std::vector<studies::ConditionNoise> noise;
  std::vector<std::string> names;
  for (std::size_t k = 0; k < found.conditions.size(); ++k) {
    const auto& condition = found.conditions[k];
    if (!condition || condition->empty()) continue;
    noise.push_back(condition->front().noise);
    names.push_back(conditions[k].name);
  }
  return studies::noise_text(noise, names);
}

// conditions: of its part.
CameraEntry camera_entry(const CameraFindings& found, std::span<const ConditionEntry> conditions) {
  const scenes::Camera& camera = *found.camera.camera;
  CameraEntry entry{found.part.scene,
                    camera.name,
                    found.camera.columns,
                    found.camera.rows,
                    camera.fov_deg,
                    {},
                    {},
                    found.relative_noise,
                    {},
                    found.render_seconds};
  if (const auto& cctv = found.camera.cctv) {
    entry.cctv = cctv->name;
    entry.iris = degrade::word_of(cctv->chain.camera.iris);
  }
  const std::string own = noise_of_conditions(found, conditions);
  entry.error_text =
      fmt::format("{}{}{} in the picture of all lights together", own,
                  own.empty() ? "noise of " : "; ", scenes::percent(found.relative_noise));
  return entry;
}

// Where a part's conditions begin.
std::size_t first_condition(const StudyResults& results, const StudyPart& part) {
  const std::string id = conditions_of(part).front().id;
  const auto first =
      std::find_if(results.conditions.begin(), results.conditions.end(),
                   [&](const ConditionEntry& condition) { return condition.id == id; });
  return static_cast<std::size_t>(first - results.conditions.begin());
}

std::size_t target_number(const StudyResults& results, const std::string& name) {
  const auto found = std::find(results.targets.begin(), results.targets.end(), name);
  return static_cast<std::size_t>(found - results.targets.begin());
}

Json settings_of(const studies::StudyFile& study, const std::string& command, std::uint64_t seed) {
  Json set = Json::array();
  for (const std::string& override : study.overrides) set.push_back(override);
  Json lamps = Json::array();
  for (const studies::LampSetting& setting : study.lamps) lamps.push_back(setting.name);
  return {{"command", command},
          {"set", set.dump()},
          {"lamp settings", lamps.dump()},
          {"positions", study.positions_deg.size()},
          {"seen from a probability of", study.seen_probability},
          {"cells of the Earth's disc", study.basis.disc_cells},
          {"cells of the sphere, where the Earth moves", study.basis.sphere_cells},
          {"seed", seed}};
}

// Warnings of loading, and effects that are not simulated.
void add_notes_of_scene(const StudyPart& part, const std::string& scene,
                        std::vector<std::string>& notes) {
  for (const std::string& warning : part.loaded.scene.warnings) {
    notes.push_back(scene + "Found on loading: " + warning);
  }
  const scenes::World of = part.basis_scene.world(*part.query);
  for (const std::string& missing : raytrace::not_captured(of, {})) {
    notes.push_back(scene + "Not simulated: " + missing + ".");
  }
}

constexpr double quarters_deg[] = {0.0, 90.0, 180.0, 270.0};

std::optional<OrbitEntry> orbit_entry(const scenes::Scene& scene) {
  if (!scene.orbit) return std::nullopt;
  const scenes::Orbit& orbit = *scene.orbit;
  OrbitEntry entry;
  entry.altitude_km = orbit.altitude_m / 1000.0;
  entry.beta_deg = orbit.beta_deg;
  entry.period_s = scenes::orbit_period_s(orbit.altitude_m);
  entry.position_deg = orbit.position_deg;
  entry.attitude = orbit.attitude.empty() ? "table" : orbit.attitude;
  if (orbit.attitude == scenes::inertial_attitude) {
    entry.inertial_as = orbit.inertial_as;
    entry.inertial_at_deg = orbit.inertial_at_deg;
  }
  const scenes::Sun usual;
  const scenes::Eclipse eclipse =
      scenes::find_eclipse(orbit, (scene.sun ? *scene.sun : usual).angular_radius_deg);
  const auto take = [](const std::optional<scenes::ShadowSpan>& span, auto& arcs) {
    if (span) arcs.emplace_back(span->begin_deg, span->end_deg);
  };
  take(eclipse.umbra, entry.umbra_deg);
  take(eclipse.penumbra, entry.penumbra_deg);
  for (const double position_deg : quarters_deg) {
    try {
      const scenes::OrbitState at = scenes::orbit_state(orbit, position_deg);
      // n = r x v, all in the scene's frame, whose z is the bay's axis.
      const Vec3 normal = glm::cross(-at.earth, at.velocity);
      entry.bay.push_back({position_deg, -at.earth.z, at.velocity.z, normal.z});
    } catch (const base::Error&) {
      // A table of attitudes may end before.
    }
  }
  return entry;
}

}  // namespace

StudyResults begin_results(const studies::StudyFile& study,
                           const std::vector<const StudyPart*>& parts, const std::string& command,
                           std::uint64_t seed) {
  StudyResults results;
  results.name = study.name;
  results.version = EARTHSHINE_VERSION;
  Json digests = Json::object();
  for (const StudyPart* part : parts) {
    if (part->scene == results.scenes.size()) {
      results.scenes.push_back(
          {part->id, part->loaded.scene.name, part->path, {}, orbit_entry(part->loaded.scene)});
    }
    digests[part->id] = scene_cache_key(part->loaded);
    for (const StudyCamera& camera : part->cameras) {
      digests[part->id]["cameras"][camera.camera->name] = camera_digest(camera);
    }
    for (const std::string& name : part->targets) {
      if (target_number(results, name) == results.targets.size()) results.targets.push_back(name);
    }
    for (ConditionEntry& condition : conditions_of(*part)) {
      results.conditions.push_back(std::move(condition));
    }
  }
  results.settings = settings_of(study, command, seed);
  results.provenance = {{"program", std::string("earthshine ") + EARTHSHINE_VERSION},
                        {"compiler", __VERSION__},
                        {"seed", seed},
                        {"scene_digest", digests.dump()}};
  return results;
}

void add_camera(StudyResults& results, const CameraFindings& found) {
  const std::size_t scene = found.part.scene, first = first_condition(results, found.part);
  CameraEntry entry = camera_entry(found, std::span(results.conditions).subspan(first));
  const auto known =
      std::find_if(results.cameras.begin(), results.cameras.end(),
                   [&](const CameraEntry& c) { return c.scene == scene && c.name == entry.name; });
  const auto camera = static_cast<std::size_t>(known - results.cameras.begin());
  if (known == results.cameras.end()) {
    results.cameras.push_back(std::move(entry));
  } else {
    // Of several poses the noisiest counts.
    entry.render_seconds = *entry.render_seconds + *known->render_seconds;
    if (*entry.relative_noise < *known->relative_noise) {
      entry.relative_noise = known->relative_noise;
      entry.error_text = known->error_text;
    }
    *known = std::move(entry);
  }
  for (std::size_t k = 0; k < found.conditions.size(); ++k) {
    if (!found.conditions[k]) continue;
    for (std::size_t t = 0; t < found.conditions[k]->size(); ++t) {
      ResultEntry result{(*found.conditions[k])[t], first + k, camera,
                         target_number(results, found.part.targets[t])};
      Number& worst = results.conditions[first + k].earth_error;
      if (result.luminance_error) {
        worst = std::max(worst.value_or(0.0), *result.luminance_error);
      }
      results.results.push_back(std::move(result));
    }
  }
  for (const ThumbnailEntry& small : found.thumbnails) {
    results.thumbnails.push_back(
        {first + small.condition, camera, small.file, small.monitor, small.white_cd_m2});
  }
}

std::vector<std::string> notes_of(const StudyResults& results,
                                  const std::vector<const StudyPart*>& parts,
                                  const std::vector<std::vector<std::string>>& limits) {
  std::vector<std::string> notes;
  bool along = false, moving = false;
  for (const StudyPart* part : parts) {
    const auto& earth = part->basis->scene().earth;
    along = along || part->basis->in_parts();
    moving = moving || (part->basis->in_parts() && earth && earth->half_angle_deg >= 180.0);
  }
  if (along) {
    notes.push_back(
        "Along the orbit the Earth's light is a sum over cells of even radiance; luminance_error "
        "is its likely size in each target's luminance, luminance_bound cannot be exceeded by it.");
    notes.push_back(
        "A partly hidden Sun counts as a whole one, dimmed; its penumbra has the width of "
        "the whole disc.");
  }
  if (moving) {
    notes.push_back(
        "The Earth moves through the sky of this attitude: its limb is drawn by cells of the "
        "sphere, coarse where a camera sees it directly or in a mirror.");
  }
  const bool many = results.scenes.size() > 1;
  std::vector<const StudyPart*> first_of_scene;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const std::string scene = many ? scene_title(results, parts[k]->scene) + ": " : std::string();
    if (parts[k]->scene == first_of_scene.size()) {
      add_notes_of_scene(*parts[k], scene, notes);
      first_of_scene.push_back(parts[k]);
    }
    for (const std::string& limit : limits[k]) {
      std::string note = scene + "Limit reached: " + limit + ".";
      if (std::ranges::find(notes, note) == notes.end()) notes.push_back(std::move(note));
    }
  }
  if (parts.size() > first_of_scene.size()) {
    notes.push_back(
        fmt::format("Joints and tracks have {} poses along the study; each has light of its own.",
                    parts.size()));
  }
  for (const CameraEntry& camera : results.cameras) {
    const auto wanted = first_of_scene[camera.scene]->loaded.scene.quality.error;
    const std::string limit = wanted && *camera.relative_noise > *wanted
                                  ? ", where the scene wants " + scenes::percent(*wanted)
                                  : std::string();
    const std::string in = many ? " in " + scene_title(results, camera.scene) : std::string();
    notes.push_back(
        fmt::format("Pictures of camera {}{}: {}{}.", camera.name, in, camera.error_text, limit));
  }
  if (!results.complete)
    notes.push_back("The study was stopped before its end; run it again to go on.");
  for (const std::string& note : black_back_notes(results)) notes.push_back(note);
  return notes;
}

}  // namespace earthshine::app
