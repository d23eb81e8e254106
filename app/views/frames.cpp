// SPDX-License-Identifier: Apache-2.0
#include "app/views/frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/call/memory.h"
#include "app/console.h"
#include "app/parts/shared_solution.h"
#include "app/study/json_fields.h"
#include "app/study/study.h"
#include "app/views/kept_layers.h"
#include "base/error.h"
#include "base/free_memory.h"
#include "radiosity/patches/posed_patches.h"
#include "radiosity/refine.h"
#include "raytrace/frame/first_hit.h"
#include "raytrace/solve_control/wanted_error.h"
#include "scenes/effects/quality.h"
#include "scenes/sky/sky_cells.h"
#include "studies/targets/target_view.h"

namespace earthshine::app {
namespace {

Json noise_key(Json picture_key) {
  picture_key["what"] = "noise";
  return picture_key;
}

Json regions_key(Json picture_key) {
  picture_key["what"] = "regions";
  return picture_key;
}

}  // namespace

// Stored form beside the picture.
template <class Fields>
void describe(Fields& fields, Either<raytrace::LayerErrors> auto& errors) {
  fields("luminance", errors.luminance);
  fields("per_noise", errors.per_noise);
}

template <class Fields>
void describe(Fields& fields, Either<StudyFrames::Frame> auto& frame) {
  fields("seconds", frame.seconds);
  fields("relative_noise", frame.relative_noise);
  fields("rays", frame.rays);
  fields("limits", frame.limits);
  fields("patches", frame.patches);
  fields("errors", frame.errors);
}

namespace {

// Limit of layers times pixels for one gather point per pixel; larger pictures have one per four
// pixels, at a third of the memory and time.
constexpr std::size_t most_values = std::size_t{1} << 23U;

// Suns used to refine the patches; shadows of intermediate Suns fall between theirs.
constexpr std::size_t most_refined_suns = 4;

// Combines the lights in few groups: refinement divides patches where any group varies, and the
// noise of many groups would count as variation.
scenes::Scene scene_to_cut(const scenes::Scene& basis) {
  scenes::Scene scene = basis;
  if (!basis.sky_parts) return scene;
  scenes::SkyParts few;
  const std::vector<scenes::Sun>& suns = basis.sky_parts->suns;
  const std::size_t count = std::min(suns.size(), most_refined_suns);
  for (std::size_t k = 0; k < count; ++k) few.suns.push_back(suns[k * suns.size() / count]);
  scene.sky_parts = std::make_shared<const scenes::SkyParts>(std::move(few));
  return scene;
}

}  // namespace

namespace {

// Alternates targets and surrounds.
std::vector<std::vector<std::uint32_t>> regions_of(
    const std::vector<studies::TargetView>& targets) {
  std::vector<std::vector<std::uint32_t>> regions;
  for (const studies::TargetView& target : targets) {
    regions.push_back(target.measured);
    regions.push_back(target.surround);
  }
  return regions;
}

}  // namespace

radiosity::SolveOptions study_solver(const scenes::Scene& scene, const Common& common) {
  constexpr double enough = 1e-4;
  scenes::Quality quality = scene.quality;
  if (!quality.error) quality.error = scenes::default_error;
  radiosity::SolveOptions solver = raytrace::picture_solver(scene, quality, common.seed);
  if (!scene.quality.solver_tolerance) solver.tolerance = enough;
  return solver;
}

StudyFrames::StudyFrames(const StudyPart& part, const std::filesystem::path& folder,
                         const Common& common, const PartCall& how, Poses* poses)
    : part_(part),
      common_(common),
      how_(how),
      poses_(poses),
      folder_(folder),
      store_(folder),
      solver_(study_solver(part.basis_scene.scene, common)) {
  scene_cache_key_ = scene_cache_key(part.basis_scene);
  scene_cache_key_["solver"] = solver_cache_key(solver_);
  if (part.first_pose != nullptr) {
    scene_cache_key_["patches of"] = digest_of(scene_cache_key(part.first_pose->basis_scene));
  }
}

double StudyFrames::wanted_error(const scenes::Scene& scene) {
  return scene.quality.error.value_or(scenes::default_error);
}

raytrace::RenderOptions StudyFrames::options(const StudyCamera& camera) const {
  raytrace::RenderOptions options =
      raytrace::render_options(scenes::resolve_quality(part_.basis_scene.scene));
  options.columns = camera.columns;
  options.rows = camera.rows;
  options.seed = common_.seed;
  options.per_light = true;
  options.aovs = {"object"};
  options.error = wanted_error(part_.basis_scene.scene);
  options.gather_step = values_of(camera) > most_values ? 2 : 1;
  for (std::size_t place = 0; place < part_.basis->places().size(); ++place) {
    for (std::size_t setting = 0; setting < part_.basis->settings().size(); ++setting) {
      options.sums.push_back(luminances(part_.basis->weights(place, setting)));
    }
  }
  options.stop = Interrupt::leave_or_go_on;
  return options;
}

std::size_t StudyFrames::values_of(const StudyCamera& camera) const {
  return part_.basis->groups().count() * static_cast<std::size_t>(camera.columns) *
         static_cast<std::size_t>(camera.rows);
}

std::vector<std::vector<std::uint32_t>> StudyFrames::regions_at(const StudyCamera& camera) const {
  const scenes::Scene& scene = part_.basis_scene.scene;
  base::Image objects;
  objects.width = camera.columns;
  objects.height = camera.rows;
  objects.add("object");
  const raytrace::Window all{0, 0, camera.columns, camera.rows};
  raytrace::fill_first_hit(scene, *part_.query,
                           raytrace::make_camera_model(*camera.camera, camera.columns, camera.rows),
                           all, objects);
  return regions_of(studies::find_targets(scene, *camera.camera, studies::object_map(objects)));
}

Json StudyFrames::cache_key(const StudyCamera& camera) const {
  Json cache_key = scene_cache_key_;
  const raytrace::RenderOptions how = options(camera);
  cache_key["what"] = "picture";
  cache_key["camera"] = camera_cache_key(*camera.camera);
  cache_key["name"] = camera.camera->name;
  cache_key["filter"] = {scenes::filter_name(camera.camera->filter),
                         camera.camera->filter_width_px};
  cache_key["columns"] = how.columns;
  cache_key["rows"] = how.rows;
  cache_key["gather_step"] = how.gather_step;
  cache_key["denoise"] = how.denoise;
  cache_key["error"] = how.error;
  cache_key["sums"] = digest_of(how.sums);
  cache_key["seed"] = how.seed;
  return cache_key;
}

radiosity::Solution StudyFrames::solve(StageTimes& times) const {
  const EndAtOnce nothing_to_keep;
  const LoadedScene& basis = part_.basis_scene;
  (void)common_.progress->begin("solve " + part_.path, Work::StudySolve,
                                static_cast<double>(basis.scene.triangles.size()));
  radiosity::Solution found = times.measure("solve", [&] {
    radiosity::SolveVariant variant;
    if (poses_ != nullptr) variant.kept = &poses_->kept;
    radiosity::Patches patches =
        poses_ != nullptr && poses_->patches ? *poses_->patches : first_patches();
    if (poses_ != nullptr && !poses_->patches) poses_->patches = patches;
    if (part_.first_pose != nullptr) {
      patches = radiosity::posed_patches(std::move(patches), basis.scene);
    }
    return radiosity::solve(basis.world(*part_.query), solver_, std::move(patches), variant);
  });
  note_balance(found, solver_.balance);
  return found;
}

radiosity::Patches StudyFrames::first_patches() const {
  const StudyPart& first = part_.first_pose != nullptr ? *part_.first_pose : part_;
  const scenes::Scene cut = scene_to_cut(first.basis_scene.scene);
  const scenes::LightGroups groups = scenes::find_light_groups(cut);
  const scenes::Effects effects = scenes::find_effects(cut, groups, {});
  const radiosity::SolveOptions solver = study_solver(first.basis_scene.scene, common_);
  return radiosity::refine({cut, groups, effects, *first.query}, solver).patches;
}

radiosity::Solution StudyFrames::read_or_solve(const std::filesystem::path& file,
                                               const radiosity::SolutionOrigin& origin,
                                               StudyCost& cost, StageTimes& times) const {
  std::error_code ignored;
  if (std::filesystem::exists(file, ignored)) {
    try {
      return times.measure("read", [&] { return radiosity::read_solution(file, origin); });
    } catch (const base::Error& error) {
      note(fmt::format("note: {}; it is recomputed", error.what()));
    }
  }
  radiosity::Solution found = solve(times);
  cost.found = false;
  radiosity::write_solution(file, found, origin);
  return found;
}

const radiosity::Solution& StudyFrames::solution(std::vector<StudyCost>& costs) {
  if (solution_) return *solution_;
  const LoadedScene& basis = part_.basis_scene;
  const std::filesystem::path file = solution_file_in(folder_, scene_cache_key_);
  const scenes::Scene* first =
      part_.first_pose != nullptr ? &part_.first_pose->basis_scene.scene : nullptr;
  const radiosity::SolutionOrigin origin{basis.scene, basis.groups, solver_, EARTHSHINE_VERSION,
                                         first};
  StudyCost cost{"solve " + part_.id, 0.0, 0, true};
  StageTimes times;
  if (how_.in_parts()) {
    SharedSolution shared =
        shared_solution(file, origin, how_, common_.quiet, [&] { return solve(times); });
    cost.found = shared.found;
    solution_ = std::move(shared.solution);
  } else {
    solution_ = read_or_solve(file, origin, cost, times);
  }
  if (!cost.found) cost.rays = solution_->report.form_factor_rays + solution_->report.shadow_rays;
  cost.seconds = times.total();
  costs.push_back(cost);
  if (cost.found) common_.progress->drop(Work::StudySolve);
  return *solution_;
}

std::optional<StudyFrames::Frame> StudyFrames::known(const StudyCamera& camera,
                                                     std::vector<StudyCost>& costs) const {
  std::string said;
  const std::optional<Json> facts = store_.find_facts(cache_key(camera), said);
  if (!facts) return std::nullopt;
  Frame frame = read_kept<Frame>(*facts);
  costs.push_back(cost_of(camera, frame, true));
  return frame;
}

StudyCost StudyFrames::cost_of(const StudyCamera& camera, const Frame& frame, bool found) const {
  return {fmt::format("picture {} {}", part_.id, camera.camera->name), frame.seconds, frame.rays,
          found};
}

bool StudyFrames::has(const StudyCamera& camera) const {
  std::string ignored;
  return find(cache_key(camera), ignored).has_value();
}

std::optional<StudyFrames::Frame> StudyFrames::frame(const StudyCamera& camera,
                                                     std::vector<StudyCost>& costs) {
  const Json key = cache_key(camera);
  std::string said;
  if (std::optional<Frame> frame = find(key, said)) {
    costs.push_back(cost_of(camera, *frame, true));
    common_.progress->drop(Work::StudyPicture);
    return frame;
  }
  if (how_.task == PartCall::Task::Merge) {
    throw base::Error(base::Blame::Work, folder_.string(),
                      "has lost work since it was looked at" + (said.empty() ? "" : ": " + said),
                      {}, "Merge again; it lists the missing parts");
  }
  if (!said.empty()) note("note: " + said);
  const LoadedScene& basis = part_.basis_scene;
  raytrace::RenderOptions how = options(camera);
  check_memory(basis, *part_.query, solver_, &how, !solution_.has_value());
  const radiosity::Solution& light = solution(costs);
  base::give_back_freed_memory(values_of(camera) * sizeof(glm::vec3));
  how.regions = regions_at(camera);
  raytrace::Frame drawn;
  try {
    drawn = raytrace::render(
        basis.world(*part_.query), light, *camera.camera, how,
        common_.progress->begin(fmt::format("camera {} of {}", camera.camera->name, part_.path),
                                Work::StudyPicture, part_.picture_units(camera)));
  } catch (const Interrupt::Left&) {
    return std::nullopt;
  }
  Frame frame{{},
              drawn.report.seconds,
              drawn.report.relative_noise,
              drawn.report.rays.total(),
              limits_of_balance(light, solver_.balance),
              light.report.patches,
              std::move(drawn.layers),
              std::move(drawn.regions)};
  base::give_back_freed_memory(values_of(camera) * sizeof(glm::vec3));
  keep(key, std::move(drawn.image), frame);
  base::give_back_freed_memory(values_of(camera) * sizeof(glm::vec3));
  costs.push_back(cost_of(camera, frame, false));
  return frame;
}

std::optional<StudyFrames::Frame> StudyFrames::find(const Json& cache_key,
                                                    std::string& said) const {
  std::optional<CachedResult> picture = store_.find(cache_key, said);
  if (!picture) return std::nullopt;
  std::optional<CachedResult> noise = store_.find(noise_key(cache_key), said);
  if (!noise) return std::nullopt;
  Frame frame = read_kept<Frame>(picture->facts);
  frame.image = unpacked_layers(std::move(*picture));
  std::optional<CachedResult> regions = store_.find(regions_key(cache_key), said);
  if (!regions) return std::nullopt;
  take_noise(std::move(*noise), frame.errors);
  frame.regions = unpacked_regions(std::move(*regions));
  frame.errors.see(frame.image, part_.basis->groups().names);
  return frame;
}

void StudyFrames::keep(const Json& cache_key, base::Image image, Frame& frame) const {
  // Without an orbit there are few layers, stored with all digits.
  const int digits = part_.basis->in_parts() ? round_layers(image, frame.relative_noise) : 0;
  CachedResult picture = packed_layers(std::move(image), digits, kept_json(frame));
  CachedResult noise = packed_noise(frame.errors);
  store_.keep(noise_key(cache_key), noise);
  store_.keep(regions_key(cache_key), packed_regions(frame.regions));
  store_.keep(cache_key, picture);
  frame.image = unpacked_layers(std::move(picture));
  take_noise(std::move(noise), frame.errors);
  frame.errors.see(frame.image, part_.basis->groups().names);
}

std::vector<double> luminances(const studies::GroupWeights& weights) {
  std::vector<double> luminance;
  for (const Rgb& weight : weights.weight) luminance.push_back(base::luminance(weight));
  return luminance;
}

studies::ConditionNoise StudyFrames::Frame::noise_of(const studies::GroupWeights& weights) const {
  const auto noise = errors.of(luminances(weights));
  return noise ? studies::noise_of_condition(noise->rms, noise->mean) : studies::ConditionNoise();
}

std::vector<double> StudyFrames::Frame::deviations(const studies::GroupWeights& weights) const {
  const std::vector<double> variances = regions.variances(luminances(weights));
  std::vector<double> deviation;
  for (std::size_t k = 0; k + 1 < variances.size(); k += 2) {
    deviation.push_back(std::sqrt(variances[k] + variances[k + 1]));
  }
  return deviation;
}

}  // namespace earthshine::app
