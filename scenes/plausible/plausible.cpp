// SPDX-License-Identifier: Apache-2.0
#include "scenes/plausible/plausible.h"

#include <fmt/format.h>

#include <algorithm>

#include "scenes/effects/light_groups.h"
#include "scenes/health/crossings.h"
#include "scenes/light/lamp_light.h"
#include "scenes/plausible/shut_in.h"
#include "scenes/plausible/views.h"
#include "scenes/sky/orbit.h"
#include "scenes/sky/sky.h"
#include "scenes/text/message_text.h"
#include "scenes/time/mission.h"

namespace earthshine::scenes {
namespace {

constexpr double little_reflected = 0.005, nearly_all_through = 0.99;
constexpr double worth_a_word = 0.01;  // share of the Sun's light worth a warning
// The Moon is 384 400 km away; no satellite of the Earth orbits beyond it. A low altitude of 100 to
// 2000 km is 100 000 or more in metres.
constexpr double high_km = 1e5;

using Texts = std::vector<std::string>;

void name_empty_materials(const Scene& scene, Texts& found) {
  std::vector<bool> worn(scene.materials.size(), false);
  for (const Triangle& triangle : scene.triangles) worn[triangle.material] = true;
  for (std::size_t m = 0; m < worn.size(); ++m) {
    const Material& material = scene.materials[m];
    const Rgb& through = material.transmit;
    const bool reflects =
        std::max({base::max_component(material.diffuse), base::max_component(material.specular),
                  base::max_component(material.mirror)}) > little_reflected;
    if (!worn[m] || reflects || material.emits() || material.ior != 1.0) continue;
    if (std::min({through.r, through.g, through.b}) < nearly_all_through) continue;
    found.push_back(fmt::format(
        "the material {} neither reflects nor stops light: what wears it is not there (in MTL "
        "files \"Tr 1\" and \"d 0\" say so, in glTF an alpha of 0 or below the cutoff); give it a "
        "reflectance and no transmit, in the file or "
        "as a [[material]] of that name",
        in_quotes(material.name)));
  }
}

void name_height(const Scene& scene, Texts& found) {
  const double altitude_m = scene.orbit   ? scene.orbit->altitude_m
                            : scene.earth ? scene.earth->altitude_m
                                          : 0.0;
  if (altitude_m < 1e3 * high_km) return;
  found.push_back(fmt::format(
      "{}: altitude_km = {:.10g} is kilometres; {:.10g} m would be altitude_km = {:g}",
      scene.orbit ? "[orbit]" : "[earth]", altitude_m / 1e3, altitude_m / 1e3, altitude_m / 1e6));
}

void name_hidden_sun(const Scene& scene, Texts& found) {
  if (!scene.sun || !(base::max_component(scene.sun->illuminance_lx) > 0.0)) return;
  const double hidden = 1.0 - visible_sun_share(scene);
  if (hidden < worth_a_word) return;
  // An orbit position in full shadow, with lamps: night is intended.
  const bool any_lamp = std::any_of(scene.lamps.begin(), scene.lamps.end(), [](const Lamp& lamp) {
    return base::max_component(lamp_flux_lm(lamp)) > 0.0;
  });
  if (scene.orbit && hidden >= 1.0 && any_lamp) return;
  std::string advice = "turn one of the two where sunlight is meant, or leave out [sun]";
  if (mission_of(scene) != nullptr) {
    advice = "take another moment under [time] where sunlight is meant";
  } else if (scene.orbit) {
    advice = "take another position_deg where sunlight is meant";
    const Eclipse eclipse = find_eclipse(*scene.orbit, scene.sun->angular_radius_deg);
    if (eclipse.penumbra) {
      advice += fmt::format("; the Earth covers part of it or all from {:.1f} to {:.1f}",
                            eclipse.penumbra->begin_deg, eclipse.penumbra->end_deg);
    }
  }
  found.push_back(fmt::format("the Earth hides {} of the Sun; {}",
                              hidden > 0.9999 ? "all" : percent(hidden), advice));
}

void name_darkness(const Scene& scene, Texts& found) {
  if (find_light_groups(scene).count() > 0) return;
  found.emplace_back(
      "nothing gives light, so that all is black; add a [[light]], [sun], [earth], [orbit] or a "
      "material with emit, or give those that there are a strength above 0");
}

}  // namespace

std::optional<std::string> non_square_pixels_warning(double fx, double fy) {
  if (std::abs(fx / fy - 1.0) <= 0.01) return std::nullopt;
  return fmt::format(
      "has pixels {:.4g} times as wide as high, and the CCTV chain shows them as squares; give "
      "fx = fy, and the number of columns that shows the same view",
      fy / fx);
}

Texts implausible_input(const Scene& scene, const RayQuery& query, const SceneUse& use) {
  Texts found;
  const auto add = [&found](Texts more) {
    found.insert(found.end(), std::make_move_iterator(more.begin()),
                 std::make_move_iterator(more.end()));
  };
  std::vector<const Camera*> cameras = use.cameras;
  if (cameras.empty()) {
    for (const Camera& camera : scene.cameras) cameras.push_back(&camera);
  }
  if (!use.cameras_used) cameras.clear();
  std::vector<Box> bounds;
  for (const Object& object : scene.objects) bounds.push_back(bounds_of(scene, object));
  std::vector<View> views;
  for (const Camera* camera : cameras) views.push_back(sample_view(scene, query, *camera, bounds));
  add(implausible_size(scene, views));
  add(implausible_views(scene, views));
  for (const Camera* camera : cameras) {
    if (camera->cctv.empty() || !camera->intrinsics) continue;
    const auto text = non_square_pixels_warning((*camera->intrinsics)[0], (*camera->intrinsics)[1]);
    if (text) found.push_back(fmt::format("camera {} {}", in_quotes(camera->name), *text));
  }
  name_empty_materials(scene, found);
  if (!use.lights) return found;
  name_height(scene, found);
  const bool meets_sun =
      use.moves_along_orbit && scene.sun && base::max_component(scene.sun->illuminance_lx) > 0.0;
  // An orbit includes night.
  const bool may_be_night = use.moves_along_orbit || (use.shows_facts && scene.orbit);
  const std::size_t before = found.size();
  if (!may_be_night) name_hidden_sun(scene, found);
  const bool sun_is_hidden = found.size() > before;
  if (!meets_sun && !sun_is_hidden && !use.shows_facts) name_darkness(scene, found);
  add(shut_in_lights(scene, query, cameras));
  return found;
}

}  // namespace earthshine::scenes
