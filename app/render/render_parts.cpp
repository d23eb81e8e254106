// SPDX-License-Identifier: Apache-2.0
#include "app/render/render_parts.h"

#include <fmt/format.h>

#include "app/console.h"
#include "app/parts/frame_file.h"
#include "app/parts/shared_solution.h"
#include "app/provenance.h"
#include "app/render/draw.h"
#include "app/render/light.h"
#include "base/error.h"
#include "radiosity/store/solution_key.h"
#include "raytrace/adaptive/adaptive_render.h"
#include "raytrace/frame/join.h"

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

raytrace::Window RenderParts::picture_of(std::size_t camera) const {
  return {0, 0, options_[camera].columns, options_[camera].rows};
}

std::vector<RenderParts::Piece> RenderParts::pieces() const {
  std::vector<Piece> pieces;
  const bool whole = steers(wanted_.call, wanted_.loaded.scene);
  std::vector<std::size_t> first = {0};  // index of each camera's first item
  for (const raytrace::RenderOptions& options : options_) {
    const int rows = raytrace::window_of(options).rows;
    first.push_back(first.back() + (whole ? 1 : static_cast<std::size_t>(rows)));
  }
  PartCall part = part_;
  for (part.number = 1; part.number <= part_.count; ++part.number) {
    const Share share = share_of(part, first.back());
    for (std::size_t k = 0; k < cameras_.size(); ++k) {
      const std::size_t from = std::max(share.first, first[k]);
      const std::size_t to = std::min(share.last, first[k + 1]);
      if (from >= to) continue;
      raytrace::Window window = raytrace::window_of(options_[k]);
      if (!whole) {
        window.y += static_cast<int>(from - first[k]);
        window.rows = static_cast<int>(to - from);
      }
      pieces.push_back({k, part.number, window});
    }
  }
  return pieces;
}

Json RenderParts::key_of(const Piece& piece) const {
  const raytrace::Window& window = piece.window;
  return {{"what", "share of a picture"},
          {"call", digests_},
          {"build", scene_key_["build"]},
          {"solution", solution_},
          {"camera", cameras_[piece.camera]->name},
          {"window", {window.x, window.y, window.columns, window.rows}}};
}

void RenderParts::draw_share(const RenderContext& context) const {
  std::size_t mine = 0, drawn = 0;
  for (const Piece& piece : pieces()) {
    if (piece.part != part_.number) continue;
    ++mine;
    std::string said;
    if (store_->find(key_of(piece), said)) continue;
    if (!said.empty()) note("note: " + said);
    raytrace::RenderOptions options = options_[piece.camera];
    options.crop = piece.window;
    const raytrace::Frame frame = draw_frame(context, *cameras_[piece.camera], options);
    if (frame.report.stopped) end_part_if_interrupted();
    store_->keep(key_of(piece), kept_frame(frame, picture_of(piece.camera)));
    ++drawn;
  }
  if (wanted_.common.quiet) return;
  const std::string done = mine == 0 ? "nothing to do: there are fewer rows or pictures than parts"
                                     : fmt::format("{} drawn, {} there already, in {}", drawn,
                                                   mine - drawn, folder_.string());
  note(fmt::format("part {} of {}: {}", part_.number, part_.count, done));
}

void RenderParts::check_complete() const {
  std::vector<MissingWork> missing;
  for (const Piece& piece : pieces()) {
    std::string said;
    if (store_->find(key_of(piece), said)) continue;
    const raytrace::Window& window = piece.window;
    missing.push_back(
        {fmt::format("camera {}, rows {} to {}{}", cameras_[piece.camera]->name, window.y,
                     window.y + window.rows - 1, said.empty() ? "" : " (" + said + ")"),
         piece.part});
  }
  if (!missing.empty()) refuse_to_merge(folder_, missing);
}

raytrace::Frame RenderParts::joined(const scenes::Camera& camera) const {
  std::vector<raytrace::Frame> frames;
  std::size_t number = 0;
  for (const Piece& piece : pieces()) {
    if (cameras_[piece.camera] != &camera) continue;
    number = piece.camera;
    std::string said;
    std::optional<CachedResult> kept = store_->find(key_of(piece), said);
    if (!kept) refuse_to_merge(folder_, {{said, piece.part}});  // it existed a moment ago
    frames.push_back(frame_of(std::move(*kept)));
  }
  return raytrace::join(frames, raytrace::window_of(options_[number]));
}

}  // namespace earthshine::app
