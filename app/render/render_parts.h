// SPDX-License-Identifier: Apache-2.0
// `render --part`: processes share the cameras of a call.
#pragma once

#include <optional>
#include <vector>

#include "app/call/render_call.h"
#include "app/parts/part.h"
#include "app/parts/result_cache.h"
#include "app/render/light.h"

namespace earthshine::app {

class RenderParts {
 public:
  // `light`: solver settings and scene, before the solve. Opens the parts' folder, FILE.exr.parts;
  // throws base::Error (Input) if it belongs to another call.
  RenderParts(const LightCall& wanted, PartCall& part,
              const std::vector<const scenes::Camera*>& cameras);

  // The common solution, made here or by another process.
  [[nodiscard]] Solved light(StageTimes& times);

  // Renders the missing pictures of this part. Throws base::Error (Work) if interrupted; finished
  // pictures stay stored.
  void draw_share(const RenderContext& context) const;
  // Throws base::Error (Work) if a part is missing, with the command that makes it.
  void check_complete() const;
  // A camera's stored picture.
  [[nodiscard]] raytrace::Frame picture(const scenes::Camera& camera) const;

 private:
  [[nodiscard]] Json key_of(std::size_t camera) const;

  const LightCall wanted_;
  const PartCall& part_;
  std::vector<const scenes::Camera*> cameras_;
  std::vector<raytrace::RenderOptions> options_;  // per camera
  radiosity::SolveOptions solver_;
  std::filesystem::path folder_;
  Json scene_key_, digests_;
  std::optional<ResultCache> store_;
  std::string solution_;  // its digest; empty: none
};

}  // namespace earthshine::app
