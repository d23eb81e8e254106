// SPDX-License-Identifier: Apache-2.0
// Data of the lighting console: each camera's light by source, rendered to the scene's error, and
// the masks of its targets.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/study/study.h"
#include "app/views/scene.h"
#include "base/image.h"
#include "studies/sight/sight.h"

namespace earthshine::app {

// A fader: a lamp, a light group, the Sun, the Earth or ambient light.
struct ConsoleLight {
  std::string name;   // as used by `set` of [[lamps]] and `relight --set`
  std::string kind;   // "lamp", "group", "sun", "earth" or "ambient"
  std::string group;  // group of a lamp in the scene
};

struct ConsoleLayer {
  std::size_t light = 0;
  std::optional<std::size_t> place;  // orbit position; none: all positions
  std::vector<float> r, g, b;        // cd/m^2 at factor 1
};

struct ConsoleView {
  const StudyCamera* camera = nullptr;
  double relative_noise = 0.0;  // of the picture of all lights
  double seconds = 0.0;
  base::Image image;  // as rendered, with a layer per light group
  std::vector<ConsoleLayer> layers;
  studies::SightPlan plan;
};

// The call's scene with one light group per lamp, or with its own light groups if it has more than
// `most_faders` lamps.
inline constexpr std::size_t most_faders = 48;
[[nodiscard]] studies::StudyFile console_study(const StudyCall& call,
                                               std::vector<double> positions_deg);

[[nodiscard]] std::vector<ConsoleLight> console_lights(const StudyPart& part);

// Renders every camera of the part in turn; `folder` stores finished pictures (StudyFrames),
// `other` may have more of them, from a study (empty: none). Throws base::Error (Work) if
// interrupted.
void draw_views(const StudyPart& part, const std::string& folder, const std::string& other,
                const Common& common, const std::function<void(ConsoleView)>& take);

}  // namespace earthshine::app
