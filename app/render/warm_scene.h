// SPDX-License-Identifier: Apache-2.0
// A scene that stays loaded between pictures, with its ray structure and its solutions: for the
// Python module and for `console --serve`.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/call/render_call.h"
#include "app/render/kept_lights.h"
#include "scenes/pose/posed_scene.h"
#include "scenes/ray_query.h"

namespace earthshine::app {

struct WarmScene {
  std::string path;
  std::optional<std::string> text;     // of a scene without a file; meshes are relative to `path`
  std::vector<std::string> overrides;  // requested
  bool is_read = false;
  LoadedScene loaded;       // with `overrides`, once read
  scenes::Quality quality;  // } of the file: calls may set their own
  std::vector<std::string> warnings;
  std::optional<scenes::RayQuery> query;
  KeptLights lights;
  std::size_t reads = 0, structures = 0;

  // Replaces the changes to the scene. The next read() reads it again and keeps the ray structure
  // and the solutions that are still valid.
  void set(std::vector<std::string> changes);
  void read();
  // Moves parts of the scene as it was read, until the next call or read(). Other poses than the
  // one that was read are within rounding of a scene that is read with these values.
  void pose(const scenes::PoseChange& change);
  // Prepares the scene for a call: decides its effects, and checks its views as `render` does.
  void prepare(const RenderCall& call, const std::vector<const scenes::Camera*>& cameras,
               bool draws, std::optional<double> error);
  // Broken off if the interrupt asks for it.
  [[nodiscard]] const Solved& light_for(const RenderCall& call, const Common& common,
                                        StageTimes& times);

 private:
  std::vector<std::uint64_t> shape_;      // digests of what `query` depends on; empty: a pose's
  std::optional<scenes::Scene> as_read_;  // while `loaded` has another pose
  // Of this scene, by the name and the key of a camera.
  std::map<std::pair<std::string, std::string>, std::vector<std::string>> view_warnings_;
};

}  // namespace earthshine::app
