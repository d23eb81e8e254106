// SPDX-License-Identifier: Apache-2.0
#include "scenes/sky/airglow.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/sky/sky.h"

namespace earthshine::scenes {
namespace {

constexpr int directions = 16;

}  // namespace

void add_airglow_lamps(Scene& scene, const Rgb& radiance, const base::Location& where) {
  if (!scene.earth) {
    throw base::Error(base::Blame::Input, where, "[airglow] needs an Earth",
                      "airglow is the light of the Earth's night side", "Write [earth] or [orbit]");
  }
  if (std::any_of(scene.lamps.begin(), scene.lamps.end(),
                  [](const Lamp& lamp) { return lamp.group == airglow_group; })) {
    throw base::Error(base::Blame::Input, where,
                      "[airglow] cannot be combined with a [[light]] of the group \"airglow\"", {},
                      "Give the light another group");
  }
  Scene sunlit;
  sunlit.sun = scene.sun;
  sunlit.earth = scene.earth;
  const bool is_off = scene.earth->model == EarthModel::Lambert && earth_is_lit(sunlit);
  const double lowest = std::cos(base::radians(scene.earth->half_angle_deg));
  const Rgb each = radiance * (2.0 * base::pi * (1.0 - lowest) / directions);
  const base::Frame3 frame = base::frame_around(scene.earth->direction);
  for (int k = 0; k < directions; ++k) {
    // A spiral of equal solid angles; the turn is the golden section's.
    const double height = 1.0 - (1.0 - lowest) * (k + 0.5) / directions;
    const double radius = std::sqrt(1.0 - height * height);
    const double azimuth = 2.0 * base::pi * k / std::numbers::phi;
    Lamp lamp;
    lamp.name = fmt::format("airglow-{}", k + 1);
    lamp.group = airglow_group;
    lamp.kind = LampKind::Distant;
    lamp.axis = -frame.to_world({radius * std::cos(azimuth), radius * std::sin(azimuth), height});
    if (!is_off) lamp.illuminance_lx = each;
    scene.lamps.push_back(std::move(lamp));
  }
}

}  // namespace earthshine::scenes
