// SPDX-License-Identifier: Apache-2.0
#include "app/render/render_parts.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/console.h"
#include "app/parts/frame_file.h"
#include "app/parts/shared_solution.h"
#include "app/provenance.h"
#include "app/render/draw.h"
#include "app/render/light.h"
#include "base/error.h"
#include "radiosity/store/solution_key.h"
#include "raytrace/adaptive/adaptive_render.h"

namespace earthshine::app {
namespace {

// All input of a picture besides scene and solution.
Json settings_of(const RenderCall& call, const raytrace::RenderOptions& how) {
  const raytrace::Window window = raytrace::window_of(how);
  return {{"picture", {how.columns, how.rows}},
          {"window", {window.x, window.y, window.columns, window.rows}},
          {"gather", {how.gather_rays, how.denoise}},
          {"samples", how.camera_samples},
          {"indirect", indirect_name(how.indirect)},
          {"caustics", how.paths == raytrace::PathSet::All},
          {"lights", how.distributed_lights},
          {"over", how.distributed_over},
          {"layers", how.aovs},
          {"per_light", how.per_light},
          {"error", how.error},
          {"states_error", !call.no_error},
          {"seed", how.seed}};
}

}  // namespace

RenderParts::RenderParts(const LightCall& wanted, PartCall& part,
                         const std::vector<const scenes::Camera*>& cameras)
    : wanted_(wanted),
      part_(part),
      cameras_(cameras),
      solver_(solver_of(wanted.call, wanted.loaded.scene, wanted.common)),
      folder_(wanted.call.output + ".parts") {
  scene_key_ = scene_cache_key(wanted.loaded);
  scene_key_["solver"] = solver_cache_key(solver_);
  for (const scenes::Culling& effect : wanted.loaded.culled)
    scene_key_["left_out"].push_back(effect.effect);
  Json views = Json::array(), settings = Json::array();
  for (const scenes::Camera* camera : cameras_) {
    options_.push_back(picture_options(wanted.call, wanted.common, wanted.loaded, *camera));
    settings.push_back(settings_of(wanted.call, options_.back()));
    views.push_back({camera->name, camera_cache_key(*camera), scenes::filter_name(camera->filter),
                     camera->filter_width_px});
  }
  digests_ = {{"scene", digest_of(scene_key_)},
              {"cameras", digest_of(views)},
              {"settings", digest_of(settings)}};
  join_parts(folder_, wanted.common, digests_, part);
  store_.emplace(folder_);
}

Solved RenderParts::light(StageTimes& times) {
  LightCall call = wanted_;
  if (!wanted_.call.solution.empty()) solution_ = digest_of_file(wanted_.call.solution);
  call.share = [&](const std::function<radiosity::Solution()>& solve) {
    const std::filesystem::path file = solution_file_in(folder_, scene_key_);
    if (part_.task == PartCall::Task::Merge && !std::filesystem::exists(file)) check_complete();
    SharedSolution shared = shared_solution(
        file, {wanted_.loaded.scene, wanted_.loaded.groups, solver_, EARTHSHINE_VERSION}, part_,
        wanted_.common.quiet, solve);
    solution_ = shared.digest;
    return std::move(shared.solution);
  };
  return find_light(call, times);
}

Json RenderParts::key_of(std::size_t camera) const {
  return {{"what", "share of a picture"},
          {"call", digests_},
          {"build", scene_key_["build"]},
          {"solution", solution_},
          {"camera", cameras_[camera]->name}};
}

void RenderParts::draw_share(const RenderContext& context) const {
  const Share share = share_of(part_, cameras_.size());
  std::size_t drawn = 0;
  for (std::size_t k = share.first; k < share.last; ++k) {
    std::string said;
    if (store_->find(key_of(k), said)) continue;
    if (!said.empty()) note("note: " + said);
    const raytrace::Frame frame = draw_frame(context, *cameras_[k], options_[k]);
    if (frame.report.stopped) end_part_if_interrupted();
    store_->keep(key_of(k), kept_frame(frame, {0, 0, options_[k].columns, options_[k].rows}));
    ++drawn;
  }
  if (wanted_.common.quiet) return;
  const std::size_t mine = share.last - share.first;
  const std::string done = mine == 0 ? "nothing to do: there are fewer cameras than parts"
                                     : fmt::format("{} drawn, {} there already, in {}", drawn,
                                                   mine - drawn, folder_.string());
  note(fmt::format("part {} of {}: {}", part_.number, part_.count, done));
}

void RenderParts::check_complete() const {
  std::vector<MissingWork> missing;
  for (std::size_t k = 0; k < cameras_.size(); ++k) {
    std::string said;
    if (store_->find(key_of(k), said)) continue;
    missing.push_back(
        {fmt::format("camera {}{}", cameras_[k]->name, said.empty() ? "" : " (" + said + ")"),
         part_of(k, cameras_.size(), part_.count)});
  }
  if (!missing.empty()) refuse_to_merge(folder_, missing);
}

raytrace::Frame RenderParts::picture(const scenes::Camera& camera) const {
  const auto k = static_cast<std::size_t>(std::ranges::find(cameras_, &camera) - cameras_.begin());
  std::string said;
  std::optional<CachedResult> kept = store_->find(key_of(k), said);
  // It existed a moment ago.
  if (!kept) refuse_to_merge(folder_, {{said, part_of(k, cameras_.size(), part_.count)}});
  return frame_of(std::move(*kept));
}

}  // namespace earthshine::app
