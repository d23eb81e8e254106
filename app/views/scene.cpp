// SPDX-License-Identifier: Apache-2.0
#include "app/views/scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "app/call/render_call.h"
#include "app/console.h"
#include "app/parts/result_cache.h"
#include "base/error.h"
#include "base/input/input_file.h"
#include "raytrace/camera/camera.h"
#include "scenes/sky/orbit.h"
#include "scenes/text/message_text.h"
#include "scenes/time/linkage.h"
#include "scenes/view/motion.h"

namespace earthshine::app {
namespace {

using base::Blame;
using base::Error;

// The study's own CCTV cameras and monitor have priority over the scene's.
void add_cctv(const studies::StudyFile& study, scenes::Scene& scene) {
  for (const scenes::SettingTable& table : study.cctv.cctv) {
    std::erase_if(scene.cctv,
                  [&](const scenes::SettingTable& old) { return old.name == table.name; });
    scene.cctv.push_back(table);
  }
  if (study.cctv.monitor) scene.monitor = study.cctv.monitor;
  for (const auto& [name, model] : study.camera_models) {
    const auto camera =
        std::find_if(scene.cameras.begin(), scene.cameras.end(),
                     [&name = name](const scenes::Camera& c) { return c.name == name; });
    if (camera == scene.cameras.end()) continue;  // another scene of the study may have it
    camera->cctv = model == "none" ? "" : model;
    if (camera->cctv.empty()) continue;
    (void)degrade::resolve_camera(scene, model, "camera_models: camera " + scenes::in_quotes(name),
                                  study.place("camera_models"));
  }
  degrade::check_settings(scene);
}

void mark_targets(const studies::StudyFile& study, scenes::Scene& scene) {
  if (study.targets.empty()) return;
  for (scenes::Object& object : scene.objects) object.target = false;
  for (const std::string& name : study.targets) {
    const auto object = std::find_if(scene.objects.begin(), scene.objects.end(),
                                     [&](const scenes::Object& o) { return o.name == name; });
    if (object != scene.objects.end()) {
      object->target = true;
      continue;
    }
    std::vector<std::string> names;
    for (const scenes::Object& o : scene.objects) names.push_back(o.name);
    throw Error(Blame::Input, study.place("targets"),
                fmt::format("{} has no object {}", scene.path.string(), scenes::in_quotes(name)),
                names.empty() ? "it has no objects" : "it has " + scenes::listed(names),
                scenes::did_you_mean(name, names));
  }
}

void check_wanted(const studies::StudyFile& study, const StudyPart& part) {
  for (const studies::WantedTarget& wanted : study.wanted) {
    if (std::find(part.targets.begin(), part.targets.end(), wanted.target) != part.targets.end()) {
      continue;
    }
    throw Error(Blame::Input, study.place(study.where.contains("wanted") ? "wanted" : "--wanted"),
                fmt::format("{} names {}, which is no target of {}", scenes::in_quotes(wanted.text),
                            scenes::in_quotes(wanted.target), part.path),
                part.targets.empty() ? "it has no targets"
                                     : "its targets are " + scenes::listed(part.targets),
                "Mark the object with target = true, or list it under targets");
  }
}

// The cameras that the study names, or all.
std::vector<const scenes::Camera*> chosen_cameras(const studies::StudyFile& study,
                                                  const scenes::Scene& scene) {
  std::vector<const scenes::Camera*> chosen, named;
  if (study.where.contains("cameras")) {
    for (const std::string& name : study.cameras) {
      named.push_back(&choose_camera(scene, name, study.place("cameras")));
    }
  } else if (!study.cameras.empty()) {
    named = wanted_cameras(study.cameras, scene);
  }
  for (const scenes::Camera* camera : named) {
    if (std::find(chosen.begin(), chosen.end(), camera) == chosen.end()) chosen.push_back(camera);
  }
  if (study.cameras.empty()) {
    (void)first_camera(scene);  // rejects a scene without cameras
    for (const scenes::Camera& camera : scene.cameras) chosen.push_back(&camera);
  }
  return chosen;
}

void find_cameras(const studies::StudyFile& study, const std::vector<const scenes::Camera*>& chosen,
                  const Common& common, StudyPart& part) {
  const scenes::Scene& scene = part.loaded.scene;
  for (const scenes::Camera* camera : chosen) {
    StudyCamera& made = part.cameras.emplace_back();
    made.camera = camera;
    made.columns = study.columns.value_or(camera->columns);
    made.rows = study.rows.value_or(camera->rows);
    if (!camera->cctv.empty()) made.cctv = cctv_of_camera(scene, *camera, common);
  }
}

// Error for a study whose route does not suit the scene.
[[noreturn]] void refuse_section(const studies::StudyFile& study, const StudyPart& part,
                                 const char* key, const std::string& found, const char* allowed,
                                 const char* remedy) {
  const bool in_file = study.where.contains(key);
  throw Error(Blame::Input, in_file ? study.place(key) : base::Location{part.path},
              (in_file ? part.path + " " : "") + found, allowed, remedy);
}

// The places of a study and, where any moves, the pose of the joints at each of them.
struct StudyInstants {
  std::vector<studies::SkyPlace> places;
  std::vector<double> positions_deg, times_s;
  std::vector<scenes::Instant> moments;
  std::vector<std::vector<scenes::JointState>> joints;

  [[nodiscard]] StudyInstants part(std::size_t first, std::size_t last) const {
    const auto cut = [&](const auto& list) {
      if (list.empty()) return list;
      return std::decay_t<decltype(list)>(list.begin() + static_cast<std::ptrdiff_t>(first),
                                          list.begin() + static_cast<std::ptrdiff_t>(last));
    };
    return {cut(places), cut(positions_deg), cut(times_s), cut(moments), cut(joints)};
  }
};

Vec3 sun_of(const scenes::Scene& sky) { return sky.sun ? sky.sun->direction : Vec3(0.0, 0.0, 1.0); }

// Sun and Earth, and the pose of all joints, at each moment.
StudyInstants find_moments(const studies::StudyFile& study, const scenes::Mission& mission,
                           scenes::Scene& sky, const StudyPart& part) {
  if (!study.time && !mission.has_span) {
    refuse_section(study, part, "orbit", "has a trajectory and no [time] to go along", "",
                   "Write [time] with start, stop and step");
  }
  const scenes::TimeSpan span = study.time.value_or(mission.time);
  const scenes::Linkage* const linkage = part.loaded.scene.linkage.get();
  StudyInstants instants;
  for (std::size_t k = 0; k < span.count(); ++k) {
    scenes::move_to_moment(sky, span.at(k));
    instants.places.push_back(studies::sky_of(sky));
    double position = sky.orbit->position_deg;
    if (k > 0) {
      const double expected =
          instants.positions_deg.back() + scenes::revolved_deg(mission, span.at(k - 1), span.at(k));
      position = expected + std::remainder(position - expected, 360.0);
    }
    instants.positions_deg.push_back(position);
    instants.times_s.push_back(span.at(k) - span.start);
    instants.moments.push_back(span.at(k));
    if (linkage != nullptr && linkage->moves()) {
      instants.joints.push_back(linkage->at(&mission, span.at(k), sun_of(sky)));
    }
  }
  return instants;
}

// Sun and Earth at each position, and when.
StudyInstants find_instants(const studies::StudyFile& study, const StudyPart& part) {
  const scenes::Scene& scene = part.loaded.scene;
  StudyInstants instants;
  if (study.positions_deg.empty() && !study.time) {
    instants.places = {studies::sky_of(scene)};
    return instants;
  }
  scenes::Scene sky;  // without surfaces: cheap to move
  sky.sun = scene.sun;
  sky.earth = scene.earth;
  sky.orbit = scene.orbit;
  const scenes::Mission* const mission = scenes::mission_of(scene);
  if (mission != nullptr && (study.time || study.usual_positions)) {
    return find_moments(study, *mission, sky, part);
  }
  if (mission != nullptr) {
    refuse_section(study, part, "orbit",
                   "has a trajectory, along which positions in degrees are none",
                   "a study of it goes along [time]", "Write [time] with start, stop and step");
  }
  if (study.time) {
    refuse_section(study, part, "time", "has no trajectory, so that there is no time to go along",
                   "", "Write [orbit] with trajectory = \"FILE.oem\" in the scene");
  }
  if (!scene.orbit) {
    refuse_section(study, part, "orbit", "has no [orbit], so that there is nothing to go along",
                   "a study with positions needs a scene with [orbit]",
                   "Add [orbit] with altitude_km, or leave the positions out");
  }
  const scenes::Linkage* const linkage = scene.linkage.get();
  for (const double position : study.positions_deg) {
    scenes::move_along_orbit(sky, position);
    if (linkage != nullptr && linkage->moves()) {  // what follows the Sun
      instants.joints.push_back(linkage->at(nullptr, {}, sun_of(sky)));
    }
    instants.places.push_back(studies::sky_of(sky));
    instants.positions_deg.push_back(position);
    instants.times_s.push_back(scenes::orbit_state(*scene.orbit, position).time_s);
  }
  return instants;
}

// Warns if the scene has light but no condition of the study does.
void name_darkness(StudyPart& part, bool quiet) {
  const studies::LightBasis& basis = *part.basis;
  for (std::size_t place = 0; place < basis.places().size(); ++place) {
    for (std::size_t setting = 0; setting < basis.settings().size(); ++setting) {
      const std::vector<Rgb> weights = basis.weights(place, setting).weight;
      if (std::any_of(weights.begin(), weights.end(),
                      [](const Rgb& weight) { return base::max_component(weight) > 0.0; })) {
        return;
      }
    }
  }
  if (scenes::find_light_groups(part.loaded.scene).count() == 0) return;  // reported on loading
  std::string warning =
      "no condition of the study has any light: its lamp settings and positions leave all dark; "
      "look at [[lamps]] and [orbit] of the study";
  if (!quiet) note("warning: " + warning);
  part.loaded.scene.warnings.push_back(std::move(warning));
}

}  // namespace

std::string place_text(const std::vector<double>& positions_deg,
                       const std::vector<scenes::Instant>& moments, double position_deg) {
  if (moments.empty()) return fmt::format("orbit {:g} deg", position_deg);
  const auto after = std::lower_bound(positions_deg.begin(), positions_deg.end(), position_deg);
  const auto k = static_cast<std::size_t>(after - positions_deg.begin());
  if (k == positions_deg.size()) return scenes::utc_text(moments.back());
  if (k == 0 || positions_deg[k] == position_deg) return scenes::utc_text(moments[k]);
  const double share =
      (position_deg - positions_deg[k - 1]) / (positions_deg[k] - positions_deg[k - 1]);
  return scenes::utc_text(
      {std::round(moments[k - 1].tai_s + share * (moments[k] - moments[k - 1]))});
}

namespace {

// Runs of moments in one pose of all joints: where each begins, and the end of all.
std::vector<std::size_t> runs_of(const StudyInstants& instants) {
  std::vector<std::size_t> begins = {0};
  for (std::size_t k = 1; k < instants.joints.size(); ++k) {
    const auto same = [](const scenes::JointState& a, const scenes::JointState& b) {
      return a.pose == b.pose;
    };
    if (!std::ranges::equal(instants.joints[k - 1], instants.joints[k], same)) begins.push_back(k);
  }
  begins.push_back(instants.places.size());
  return begins;
}

SceneInput input_of(const studies::StudyFile& study, const StudyPart& part) {
  SceneInput input{part.path, study.overrides};
  if (study.where.count("set") > 0) input.overrides_at = study.place("set");
  return input;
}

// Moon and Earth move through the sky of most attitudes, and a lamp of a study does not.
void leave_night_lights_out(StudyPart& part, bool quiet) {
  scenes::Scene& scene = part.loaded.scene;
  const std::size_t lamps = scene.lamps.size();
  scene.moon.reset();
  std::erase_if(scene.lamps, [](const scenes::Lamp& lamp) {
    return lamp.group == "moon" || lamp.group == "airglow";
  });
  if (scene.lamps.size() == lamps) return;
  scene.warnings.push_back(
      "moonlight and airglow are left out of a study with several places in one pose");
  if (!quiet) note("warning: " + scene.warnings.back());
}

// The times, or positions, of one of several poses.
std::string times_of(const StudyInstants& instants) {
  const auto at = [&](std::size_t k) {
    return place_text(instants.positions_deg, instants.moments, instants.positions_deg[k]);
  };
  const std::size_t last = instants.positions_deg.size() - 1;
  return last == 0 ? at(0) : at(0) + " to " + at(last);
}

// The scene's surfaces, cameras and lights at those instants; one_pose: of several.
void fill_part(const studies::StudyFile& study, const Common& common, StudyInstants instants,
               bool one_pose, StudyPart& part) {
  scenes::Scene& scene = part.loaded.scene;
  scenes::hold_still(scene);
  add_cctv(study, scene);
  mark_targets(study, scene);
  for (const scenes::Object& object : scene.objects) {
    if (object.target) part.targets.push_back(object.name);
  }
  check_wanted(study, part);
  if (scene.linkage) part.pose = scenes::pose_text(scene);
  if (instants.places.size() > 1) leave_night_lights_out(part, common.quiet);
  scenes::SceneUse use;
  use.cameras = chosen_cameras(study, scene);
  use.moves_along_orbit = !study.positions_deg.empty() || study.time;
  part.query = std::make_unique<const scenes::RayQuery>(
      scene,
      part.first_pose != nullptr ? std::optional(part.first_pose->query->centre()) : std::nullopt);
  if (one_pose) part.skipped_at = times_of(instants);
  part.skipped =
      skip_hidden_cameras(scene, *part.query, use.cameras, common.quiet, part.skipped_at);
  check_input(part.loaded, *part.query, use, common.quiet);
  find_cameras(study, use.cameras, common, part);
  part.positions_deg = std::move(instants.positions_deg);
  part.times_s = std::move(instants.times_s);
  part.moments = std::move(instants.moments);
  part.basis = std::make_unique<const studies::LightBasis>(scene, std::move(instants.places),
                                                           study.lamps, study.basis);
  name_darkness(part, common.quiet);
  scenes::Asked asked;
  for (const StudyCamera& camera : part.cameras) asked.cameras.push_back(camera.camera);
  asked.per_light = true;
  part.basis_scene.scene = part.basis->scene();
  part.basis_scene.groups = part.basis->groups();
  part.basis_scene.effects = scenes::find_effects(part.basis->scene(), part.basis->groups(), asked);
}

}  // namespace

std::string camera_digest(const StudyCamera& camera) {
  Json all = {camera_cache_key(*camera.camera), camera.columns, camera.rows};
  if (camera.cctv) {
    all.push_back(settings_json(camera.cctv->chain.camera));
    all.push_back(monitor_json(camera.cctv->chain.monitor));
  }
  return digest_of(all);
}

StudyParts prepare_parts(const studies::StudyFile& study, std::size_t index, const Common& common) {
  StudyParts parts;
  auto first = std::make_unique<StudyPart>();
  first->id = fmt::format("s{}", index);
  first->scene = index;
  first->path = study.scenes[index].lexically_normal().string();
  for (const char* key : {"scene", "scenes"}) {
    if (study.where.contains(key)) base::check_input_file(first->path, study.place(key));
  }
  first->loaded = load(input_of(study, *first), common.quiet);
  const StudyInstants instants = find_instants(study, *first);
  const std::vector<std::size_t> begins = runs_of(instants);
  for (std::size_t run = 0; run + 1 < begins.size(); ++run) {
    auto part = std::make_unique<StudyPart>();
    part->id = run == 0 ? first->id : fmt::format("{}-p{}", first->id, run);
    part->scene = index;
    part->path = first->path;
    // A scene's Moon and joints are those of its moment.
    const bool moon_of_moment = first->loaded.scene.moon && instants.moments.size() == 1;
    if (instants.joints.empty() && !moon_of_moment) {
      part->loaded = std::move(first->loaded);
    } else {
      SceneInput input = input_of(study, *first);
      const std::size_t at = begins[run];
      input.overrides.push_back(
          instants.moments.empty()
              ? fmt::format("orbit.position_deg={}", instants.positions_deg[at])
              : "time.moment=" + scenes::utc_text(instants.moments[at]));
      part->loaded = load(input, common.quiet || run > 0);
    }
    if (run > 0) part->first_pose = parts.front().get();
    fill_part(study, common, instants.part(begins[run], begins[run + 1]), begins.size() > 2, *part);
    parts.push_back(std::move(part));
  }
  if (std::ranges::all_of(parts, [](const auto& part) { return part->cameras.empty(); })) {
    const StudyPart& part = *parts.front();  // throws for its first camera
    raytrace::check_camera(part.loaded.scene, *part.query, *part.skipped.front());
  }
  return parts;
}

}  // namespace earthshine::app
