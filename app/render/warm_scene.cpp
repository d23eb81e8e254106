// SPDX-License-Identifier: Apache-2.0
#include "app/render/warm_scene.h"

#include <algorithm>
#include <utility>

#include "app/console.h"
#include "app/options.h"
#include "app/parts/result_cache.h"
#include "scenes/effects/light_groups.h"
#include "scenes/read/scene_file.h"

namespace earthshine::app {

void WarmScene::set(std::vector<std::string> changes) {
  if (changes == overrides) return;
  overrides = std::move(changes);
  is_read = false;
}

void WarmScene::read() {
  if (is_read && !as_read_) return;
  if (is_read) {
    loaded.scene = std::move(*as_read_);
  } else {
    loaded = check_scene(text ? scenes::read_scene_text(*text, path, overrides)
                              : scenes::read_scene(path, overrides));
    ++reads;
  }
  is_read = true;
  as_read_.reset();
  quality = loaded.scene.quality;
  warnings = loaded.scene.warnings;
  view_warnings_.clear();
  loaded.groups = scenes::find_light_groups(loaded.scene);
  std::vector<std::uint64_t> parts = KeptLights::digests_of(loaded);
  parts.resize(2);  // geometry and materials
  if (query && parts == shape_) return;
  query.reset();
  query.emplace(loaded.scene);
  shape_ = std::move(parts);
  ++structures;
}

void WarmScene::pose(const scenes::PoseChange& change) {
  const bool was_moved = shape_.empty();
  if (!as_read_) {
    as_read_ = loaded.scene;
    as_read_->quality = quality;  // calls may have set their own
    as_read_->warnings = warnings;
  }
  view_warnings_.clear();
  loaded.scene = scenes::posed_scene(*as_read_, change);
  if (!change.moves_surfaces() && !was_moved) return;
  query.emplace(loaded.scene);
  shape_.clear();
  ++structures;
}

void WarmScene::prepare(const RenderCall& call, const std::vector<const scenes::Camera*>& cameras,
                        bool draws, std::optional<double> error) {
  loaded.scene.quality = quality;
  if (error) loaded.scene.quality.error = error;
  loaded.scene.warnings = warnings;
  decide_effects(loaded, wanted_effects(call, cameras));
  if (cameras.size() != 1) return check_input(loaded, *query, {cameras}, true, draws);
  const std::pair view(cameras.front()->name, camera_cache_key(*cameras.front()).dump());
  const auto known = view_warnings_.find(view);
  if (known != view_warnings_.end()) {
    loaded.scene.warnings.insert(loaded.scene.warnings.end(), known->second.begin(),
                                 known->second.end());
    return;
  }
  check_input(loaded, *query, {cameras}, true, draws);
  const auto own = loaded.scene.warnings.begin() + static_cast<std::ptrdiff_t>(warnings.size());
  view_warnings_[view] = {own, loaded.scene.warnings.end()};
}

const Solved& WarmScene::light_for(const RenderCall& call, const Common& common,
                                   StageTimes& times) {
  return lights.take({call, common, loaded, *query, {}, [] { return Interrupt::asked(); }}, times);
}

}  // namespace earthshine::app
