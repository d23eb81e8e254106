// SPDX-License-Identifier: Apache-2.0
#include "app/accuracy/parts.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/call/memory.h"
#include "app/console.h"
#include "app/study/json_fields.h"
#include "base/error.h"
#include "base/parallel.h"

namespace earthshine::app {

using studies::Batch;
using studies::ReferencePair;

namespace {

constexpr int most_paths = 1 << 14;  // per pixel and side

}  // namespace

AccuracyParts::AccuracyParts(const AccuracyTask& task, const scenes::World& scene)
    : task_(task), scene_(scene), cpu_start_(base::cpu_seconds()) {
  common_cache_key_ = {{"study", "accuracy"},
                       {"scene", scene_cache_key(task.loaded)},
                       {"camera", camera_cache_key(task.view.camera)},
                       {"columns", task.view.columns},
                       {"rows", task.view.rows}};
}

Json AccuracyParts::cache_key_of(const studies::Batch& batch) const {
  Json cache_key = common_cache_key_;
  cache_key["seed"] = task_.view.seed;
  cache_key["reference"] = {{"paths", batch.paths == raytrace::PathSet::All ? "all" : "gathered"},
                            {"side", batch.side},
                            {"index", batch.index},
                            {"paths_per_pixel", batch.paths_per_pixel}};
  return cache_key;
}

// All resolved settings that the picture depends on: a changed default gives another cache_key.
Json AccuracyParts::cache_key_of(const studies::AccuracyStep& step, std::uint64_t seed) const {
  Json cache_key = common_cache_key_;
  const radiosity::SolveOptions solver = studies::solver_of(scene_, step, seed);
  const raytrace::RenderOptions picture = studies::picture_of(scene_, task_.view, step);
  cache_key["seed"] = seed;
  cache_key["step"] = {{"method", step.method},
                       {"lights", step.lights},
                       {"steered", step.steered()},
                       {"wanted_error", step.quality.error.value_or(0.0)},
                       {"gather_rays", picture.gather_rays},
                       {"camera_samples", picture.camera_samples},
                       {"denoise", picture.denoise}};
  if (step.indirect == raytrace::Indirect::Radiosity) {
    cache_key["solve"] = {{"patch_edge_m", solver.patch_edge_m},
                          {"form_factor_rays", solver.form_factor_rays},
                          {"tolerance", solver.tolerance},
                          {"refine", solver.refine.on},
                          {"start_edge_m", solver.refine.start_edge_m},
                          {"max_patches", solver.refine.max_patches},
                          {"error", solver.refine.error}};
  }
  return cache_key;
}

// Stored form beside a step's picture.
template <class Fields>
void describe(Fields& fields, Either<studies::StepCost> auto& cost) {
  fields("wall_seconds", cost.wall_seconds);
  fields("cpu_seconds", cost.cpu_seconds);
  fields("solve_wall_seconds", cost.solve_wall_seconds);
  fields("solve_cpu_seconds", cost.solve_cpu_seconds);
  fields("patches", cost.patches);
  fields("solve_rays", cost.solve_rays);
  fields("picture_rays", cost.picture_rays);
  fields("form_factor_rays", cost.form_factor_rays);
  fields("gather_rays", cost.gather_rays);
  fields("camera_samples", cost.camera_samples);
  fields("memory_bytes", cost.memory_bytes);
  fields("estimate", cost.stated.estimate);
  fields("bound_95", cost.stated.bound_95);
  fields("estimate_cpu_seconds", cost.statement_cpu_seconds);
}

studies::StepCost AccuracyParts::cost_of(const Json& facts) {
  return read_kept<studies::StepCost>(facts);
}

bool AccuracyParts::has(const studies::Batch& batch) const {
  return is_stored(cache_key_of(batch));
}

bool AccuracyParts::has(const studies::AccuracyStep& step, std::uint64_t seed) const {
  return is_stored(cache_key_of(step, seed));
}

bool AccuracyParts::is_stored(const Json& cache_key) const {
  std::string ignored;
  return task_.store.find(cache_key, ignored).has_value();
}

Json AccuracyParts::digests(const std::vector<studies::AccuracyStep>& ladder) const {
  Json settings = Json::array();
  for (const studies::AccuracyStep& step : ladder) {
    settings.push_back(cache_key_of(step, task_.view.seed));
  }
  return {{"scene", digest_of(common_cache_key_)}, {"settings", digest_of(settings)}};
}

std::optional<CachedResult> AccuracyParts::stored(const Json& cache_key) {
  std::string said;
  std::optional<CachedResult> part = task_.store.find(cache_key, said);
  if (!said.empty() && !task_.common.quiet) note("note: " + said);
  if (part) ++finished_;
  return part;
}

void AccuracyParts::end_early() const {
  throw base::Error(base::Blame::Work, "study accuracy", "interrupted", {},
                    fmt::format("{} parts are finished in {}; the same command goes on from them",
                                finished_, task_.call.folder));
}

void AccuracyParts::see_that_work_is_wanted() const {
  if (task_.view.stop()) end_early();
  if (task_.call.part.task != PartCall::Task::Merge) return;
  throw base::Error(base::Blame::Work, task_.call.folder, "has lost work since it was looked at",
                    {}, "Merge again; it lists the missing parts");
}

CachedResult AccuracyParts::batch(const studies::Batch& batch) {
  const Json cache_key = cache_key_of(batch);
  if (auto part = stored(cache_key)) return *part;
  see_that_work_is_wanted();
  const double pixels = double(task_.view.columns) * task_.view.rows;
  const Progress::Listener progress =
      task_.common.progress->begin("reference", Work::Paths, pixels * batch.paths_per_pixel);
  const double before = base::cpu_seconds();
  auto image = studies::trace_batch(scene_, task_.view, batch, progress);
  if (!image) end_early();
  CachedResult part{{{"cpu_seconds", base::cpu_seconds() - before}}, std::move(*image)};
  task_.store.keep(cache_key, part);
  ++finished_;
  return part;
}

CachedResult AccuracyParts::point(const studies::AccuracyStep& step, std::uint64_t seed) {
  const Json cache_key = cache_key_of(step, seed);
  if (auto part = stored(cache_key)) return *part;
  see_that_work_is_wanted();
  const radiosity::SolveOptions solver = studies::solver_of(scene_, step, seed);
  const auto alike = std::count_if(
      expected_.begin(), expected_.end(),
      [&](const radiosity::SolveOptions& other) { return studies::same_solver(other, solver); });
  studies::AccuracyView view = task_.view;
  view.seed = seed;
  const Progress::Listener progress =
      task_.common.progress->begin(step.name(), Work::Picture, double(view.columns) * view.rows);
  auto result = studies::run_step(scene_, view, step, alike > 1 ? shared_ : single_, progress);
  if (!result) end_early();
  base::Image image{view.columns, view.rows, {}};
  image.channels.push_back({"Y", std::move(result->luminance)});
  CachedResult part{kept_json(result->cost), std::move(image)};
  task_.store.keep(cache_key, part);
  ++finished_;
  return part;
}

void AccuracyParts::expect(const std::vector<studies::AccuracyStep>& steps) {
  for (const studies::AccuracyStep& step : steps) {
    // Adaptive steps make their own solutions.
    if (step.indirect != raytrace::Indirect::Radiosity || step.steered()) continue;
    expected_.push_back(studies::solver_of(scene_, step, task_.view.seed));
  }
}

std::string AccuracyParts::does_not_fit(const studies::AccuracyStep& step) const {
  const raytrace::RenderOptions picture = studies::picture_of(scene_, task_.view, step);
  try {
    check_memory(task_.loaded, task_.query, studies::solver_of(scene_, step, task_.view.seed),
                 &picture, true);
  } catch (const base::Error& error) {
    return error.what();
  }
  return "";
}

Json AccuracyParts::key_of_left_out(const studies::AccuracyStep& step) const {
  return {{"what", "left out"}, {"step", cache_key_of(step, task_.view.seed)}};
}

void AccuracyParts::leave_out(const studies::AccuracyStep& step, const std::string& why) const {
  task_.store.keep_facts(key_of_left_out(step), {{"why", why}});
}

std::string AccuracyParts::left_out(const studies::AccuracyStep& step) const {
  std::string ignored;
  const auto facts = task_.store.find_facts(key_of_left_out(step), ignored);
  return facts ? (*facts)["why"].get<std::string>() : "";
}

double AccuracyParts::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

double AccuracyParts::wall_per_cpu() const {
  // Reading stored results takes little of either.
  return std::max(1e-3, seconds()) / std::max(1e-3, base::cpu_seconds() - cpu_start_);
}

void AccuracyParts::note_progress(const std::string& what, double seconds_left,
                                  const std::string& found) const {
  if (task_.common.quiet) return;
  std::string line = what;
  if (!found.empty()) line += ": " + found;
  if (seconds_left > 0.0) line += ", about " + duration(seconds_left) + " to go";
  note(line);
}

ReferencePair PathReference::pair() const {
  return {studies::mean_of_batches(batches[0], pictures[0]),
          studies::mean_of_batches(batches[1], pictures[1])};
}

AccuracyStages::AccuracyStages(const AccuracyTask& task)
    : task_(task), scene_{task.loaded.world(task.query)}, parts_(task, scene_) {}

void AccuracyStages::trace_round(std::vector<PathReference>& references, int index, int paths) {
  for (PathReference& reference : references) {
    for (int side = 0; side < 2; ++side) {
      const Batch batch{reference.paths, side, index, paths};
      CachedResult part = parts_.batch(batch);
      result_.reference_cpu_seconds += part.facts["cpu_seconds"].get<double>();
      reference.batches[side].push_back(batch);
      reference.pictures[side].push_back(std::move(part.image));
    }
  }
  result_.reference_paths += paths;
}

double AccuracyStages::finest() const {
  return *std::min_element(task_.call.wanted.begin(), task_.call.wanted.end());
}

std::vector<PathReference> AccuracyStages::new_references() const {
  std::vector<PathReference> references(1);
  if (studies::leaves_paths_out(task_.loaded.effects)) {
    references.push_back({raytrace::PathSet::NoCaustics, {}, {}});
  }
  return references;
}

std::string AccuracyStages::nothing_to_measure() const {
  if (task_.loaded.groups.count() == 0 &&
      base::max_component(task_.loaded.scene.ambient_radiance) <= 0.0) {
    return "nothing gives light: the picture is black, and has no error";
  }
  return "";
}

void AccuracyStages::take_truth(const PathReference& reference) {
  full_ = reference.pair();
  counted_ = studies::counted_pixels(full_);
  result_.pixels = std::size_t(std::count(counted_.begin(), counted_.end(), true));
}

std::string AccuracyStages::trace_first(std::vector<PathReference>& references) {
  trace_round(references, 0, first_paths);
  take_truth(references.front());
  if (result_.pixels == 0) return "no pixel shows a surface that reflects, edges of sources apart";
  if (studies::mean_luminance(full_, counted_) > 0.0) return "";
  return fmt::format("no light was found on visible surfaces, with {} paths a pixel",
                     2 * result_.reference_paths);
}

std::vector<int> AccuracyStages::further_rounds() {
  result_.wanted_resolution = finest() / task_.call.reference_factor;
  return studies::further_batches(first_paths, studies::resolution(full_, counted_),
                                  result_.wanted_resolution, most_paths);
}

studies::AccuracyStep AccuracyStages::straight_step() const {
  return studies::straight_step(finest());
}
std::uint64_t AccuracyStages::straight_seed(int side) const {
  return studies::reference_seed(task_.view.seed, side, most_paths);
}

std::vector<studies::AccuracyStep> AccuracyStages::make_ladder() const {
  studies::LadderOptions options = task_.call.ladder;
  options.finest = finest();
  return studies::accuracy_ladder(task_.loaded.scene, task_.loaded.effects, options);
}

}  // namespace earthshine::app
