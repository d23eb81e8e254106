// SPDX-License-Identifier: Apache-2.0
// `render --part`: the rows of all pictures of a call, one camera after the other, in shares.
// Pictures whose pixels are told by all of the picture (--error) are shared out whole.
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
  // `light` of the scene before it is solved: its solver's settings. Joins the parts' folder,
  // FILE.exr.parts; throws base::Error (Input) where it belongs to another call.
  RenderParts(const LightCall& wanted, PartCall& part,
              const std::vector<const scenes::Camera*>& cameras);

  // Of all parts: solved here or by another process.
  [[nodiscard]] Solved light(StageTimes& times);

  // Draws what is not there yet of this part's share. Throws base::Error (Work) once it is
  // interrupted; finished pictures are kept.
  void draw_share(const Studio& studio) const;
  // Throws base::Error (Work) where anything is not there, with the command that makes it.
  void check_complete() const;
  // A camera's picture from the parts.
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
  std::vector<raytrace::RenderOptions> options_;  // of each camera
  radiosity::SolveOptions solver_;
  std::filesystem::path folder_;
  Json scene_key_, digests_;
  std::optional<ResultCache> store_;
  std::string solution_;  // its digest; empty: none is read
};

}  // namespace earthshine::app
