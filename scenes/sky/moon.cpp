// SPDX-License-Identifier: Apache-2.0
#include "scenes/sky/moon.h"

#include <algorithm>
#include <cmath>

namespace earthshine::scenes {
namespace {

constexpr double sun_magnitude = -26.74;
constexpr const char* moon_name = "moon";

}  // namespace

double moon_magnitude(double phase_deg) {
  const double a = std::abs(phase_deg);
  return -12.73 + 0.026 * a + 4e-9 * a * a * a * a;
}

Rgb moon_illuminance_lx(const Rgb& sun_lx, double phase_deg, double distance_m,
                        double sun_distance_m) {
  const double moon_per_sun = std::pow(10.0, -0.4 * (moon_magnitude(phase_deg) - sun_magnitude));
  const double nearer = mean_moon_distance_m / distance_m;
  const double brighter = astronomical_unit_m / sun_distance_m;
  return sun_lx * (moon_per_sun * nearer * nearer * brighter * brighter);
}

void add_moon_lamp(Scene& scene, const base::Location& where) {
  if (std::any_of(scene.lamps.begin(), scene.lamps.end(),
                  [](const Lamp& lamp) { return lamp.name == moon_name; })) {
    throw base::Error(base::Blame::Input, where,
                      "[moon] cannot be combined with a [[light]] named \"moon\"", {},
                      "Give the light another name");
  }
  Lamp lamp;
  lamp.name = lamp.group = moon_name;
  lamp.kind = LampKind::Distant;
  lamp.axis = -scene.moon->direction;
  if (!scene.moon->hidden) lamp.illuminance_lx = scene.moon->illuminance_lx;
  scene.lamps.push_back(std::move(lamp));
}

}  // namespace earthshine::scenes
