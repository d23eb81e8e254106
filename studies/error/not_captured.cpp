// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "studies/error/error_budget.h"

namespace earthshine::studies {
namespace {

bool any_beam_lamp(const scenes::Scene& scene) {
  return std::any_of(scene.lamps.begin(), scene.lamps.end(), [](const scenes::Lamp& lamp) {
    return lamp.kind == scenes::LampKind::Point || lamp.kind == scenes::LampKind::Spot;
  });
}

}  // namespace

std::vector<std::string> not_captured(const StudyScene& scene,
                                      const raytrace::RenderOptions& options) {
  const scenes::Effects& effects = scene.effects;
  const bool throws_light = effects.mirror || effects.refraction;
  std::vector<std::string> missing;
  switch (options.indirect) {
    case raytrace::Indirect::Paths:
      if (throws_light && any_beam_lamp(scene.scene)) {
        missing.emplace_back("caustics of point and spot lamps");
      }
      return missing;
    case raytrace::Indirect::Distributed:
      missing.emplace_back(
          "light from surface to surface, and what N lights in place of a wide source change");
      break;
    case raytrace::Indirect::None:
      missing.emplace_back("light from surface to surface");
      break;
    case raytrace::Indirect::Radiosity:
      break;
  }
  if (throws_light) {
    missing.emplace_back("caustics: light of lamps, Sun and emitters that mirrors or glass throw");
  }
  if (effects.refraction) {
    missing.emplace_back("light of lamps, Sun and emitters through glass, which casts a shadow");
  }
  return missing;
}

}  // namespace earthshine::studies
