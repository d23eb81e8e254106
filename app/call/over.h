// SPDX-License-Identifier: Apache-2.0
// render --over: the scene laid over a photograph, for studies of where a camera stood and looked.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "app/command.h"
#include "base/files/png_file.h"
#include "scenes/ray_query.h"
#include "scenes/scene.h"

namespace earthshine::app {

enum class OverStyle { Wire, Blend, Both };

struct OverCall {
  std::string photo;  // empty: no photograph
  std::optional<OverStyle> style;
  std::optional<double> alpha;

  [[nodiscard]] bool asked() const { return !photo.empty(); }
  // The wire alone needs neither the light nor the picture.
  [[nodiscard]] bool needs_picture() const {
    return style.value_or(OverStyle::Wire) != OverStyle::Wire;
  }
};

// --over, --over-style, --over-alpha.
void add_over_options(CLI::App& command, OverCall& call);

// Throws base::Error (Input) if the options do not go together: --over without --png to receive the
// picture, with --size (the photograph has one), with a part of the picture or with several
// cameras, --over-style without --over.
struct RenderCall;
void check_over(const RenderCall& call);

// Reads the photograph; a note on stderr where its aspect is not the camera's, unless `quiet`.
// Throws base::Error (Input).
[[nodiscard]] base::Picture8 read_photo(const OverCall& call, const scenes::Camera& camera,
                                        bool quiet);

// The photograph with the scene over it. rendered_rgb: the tone-mapped picture of the photograph's
// size, which only styles with needs_picture() look at.
[[nodiscard]] base::Picture8 lay_over(const OverCall& call, base::Picture8 photo,
                                      const scenes::Scene& scene, const scenes::RayQuery& query,
                                      const scenes::Camera& camera,
                                      std::span<const std::uint8_t> rendered_rgb);

}  // namespace earthshine::app
