// SPDX-License-Identifier: Apache-2.0
#include "radiosity/direct/explicit_emitters.h"

#include <algorithm>
#include <numeric>

#include "scenes/ray_query.h"
#include "scenes/reflect/bihemispherical_albedo.h"

namespace earthshine::radiosity {
namespace {

constexpr double wide_share = 0.05;  // of all surface area
constexpr double stands_out = 2.0;   // times the mean illuminance

// Both sides of sheets.
std::vector<double> areas_by_material(const scenes::Scene& scene) {
  std::vector<double> area(scene.materials.size(), 0.0);
  for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
    const std::uint32_t m = scene.triangles[t].material;
    const double sides = scene.materials[m].two_sided ? 2.0 : 1.0;
    area[m] += sides * scenes::triangle_area(scene, static_cast<std::uint32_t>(t));
  }
  return area;
}

// 0 where nothing absorbs.
double mean_illuminance(const scenes::Scene& scene, const std::vector<double>& area) {
  const std::vector<Rgb> spread = scenes::bihemispherical_albedos(scene);
  double emitted = 0.0, absorbing = 0.0;
  for (std::size_t m = 0; m < area.size(); ++m) {
    const scenes::Material& material = scene.materials[m];
    const double sent_on = base::luminance(spread[m] + material.mirror + material.transmit);
    emitted += area[m] * base::luminance(material.emit);
    absorbing += area[m] * std::max(0.0, 1.0 - sent_on);
  }
  return absorbing > 0.0 ? emitted / absorbing : 0.0;
}

}  // namespace

std::vector<bool> emitter_is_explicit(const scenes::Scene& scene) {
  const std::vector<double> area = areas_by_material(scene);
  const double all = std::accumulate(area.begin(), area.end(), 0.0);
  const double bright = stands_out * mean_illuminance(scene, area);
  std::vector<bool> is_explicit(area.size(), false);
  for (std::size_t m = 0; m < area.size(); ++m) {
    const scenes::Material& material = scene.materials[m];
    is_explicit[m] =
        material.emits() && area[m] < wide_share * all && base::luminance(material.emit) > bright;
  }
  return is_explicit;
}

}  // namespace earthshine::radiosity
