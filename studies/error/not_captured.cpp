// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "studies/error/error_budget.h"
#include "studies/error/uncaught.h"

namespace earthshine::studies {
namespace {

// ": about 3 % of what falls straight from them ("ball")"
std::string extent(const Uncaught& light) {
  std::string text = ": less than 0.1 % of what falls straight from them";
  if (light.share >= 0.001) {
    text = fmt::format(": about {:.2g} % of what falls straight from them", 100.0 * light.share);
  }
  if (light.objects.empty()) return text;
  return fmt::format("{} (\"{}\")", text, fmt::join(light.objects, "\", \""));
}

}  // namespace

std::vector<std::string> not_captured(const StudyScene& scene,
                                      const raytrace::RenderOptions& options) {
  const scenes::Effects& effects = scene.effects;
  const bool throws_light = effects.mirror || effects.refraction;
  const bool traced = options.indirect == raytrace::Indirect::Paths;
  std::vector<std::string> missing;
  if (options.indirect == raytrace::Indirect::Distributed) {
    missing.emplace_back(
        "light from surface to surface, and what N lights in place of a wide source change");
  } else if (options.indirect == raytrace::Indirect::None) {
    missing.emplace_back("light from surface to surface");
  }
  if (!throws_light) return missing;
  const UncaughtLight light =
      uncaught_light(scene, traced ? raytrace::Indirect::Radiosity : options.indirect,
                     traced ? SourcesOf::WithoutSize : SourcesOf::All);
  const std::string sources =
      traced ? "light of sources without size" : "light of lamps, Sun and emitters";
  if (light.mirrors.possible || light.mirrors.share > 0.0) {
    missing.push_back("caustics: " + sources +
                      " that curved mirrors, or two flat mirrors in turn, throw" +
                      extent(light.mirrors));
  }
  if (light.glass.possible) {
    missing.push_back("caustics: " + sources +
                      " through glass that bends it, which casts a shadow" + extent(light.glass));
  }
  return missing;
}

}  // namespace earthshine::studies
