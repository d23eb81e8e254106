// SPDX-License-Identifier: Apache-2.0
// `render --part`: processes share the rows of all pictures of a call, camera by camera. Pictures
// whose settings depend on the whole picture (--error) are not divided.
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
  // A camera's picture, joined from the parts.
  [[nodiscard]] raytrace::Frame joined(const scenes::Camera& camera) const;

 private:
  // Rows of a camera's picture.
  struct Piece {
    std::size_t camera = 0, part = 0;
    raytrace::Window window;
  };
  [[nodiscard]] std::vector<Piece> pieces() const;
  [[nodiscard]] Json key_of(const Piece& piece) const;
  [[nodiscard]] raytrace::Window picture_of(std::size_t camera) const;

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
