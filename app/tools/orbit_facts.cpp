// SPDX-License-Identifier: Apache-2.0
#include "app/tools/orbit_facts.h"

#include <fmt/format.h>

#include "scenes/sky/orbit.h"

namespace earthshine::app {
namespace {

Json span_of(const std::optional<scenes::ShadowSpan>& span) {
  if (!span) return {};
  return {{"begin_deg", span->begin_deg},
          {"end_deg", span->end_deg},
          {"begin_s", span->begin_s},
          {"end_s", span->end_s}};
}

}  // namespace

Json orbit_facts(const scenes::Scene& scene) {
  if (!scene.orbit) return {};
  const scenes::Orbit& orbit = *scene.orbit;
  const scenes::OrbitState state = scenes::orbit_state(orbit, orbit.position_deg);
  const scenes::Eclipse eclipse = scenes::find_eclipse(orbit, scene.sun->angular_radius_deg);
  return {{"altitude_m", orbit.altitude_m},
          {"period_s", scenes::orbit_period_s(orbit.altitude_m)},
          {"beta_deg", orbit.beta_deg},
          {"position_deg", state.position_deg},
          {"time_s", state.time_s},
          {"latitude_deg", state.latitude_deg},
          {"attitude", orbit.table ? Json() : Json(orbit.attitude)},
          {"attitude_table", orbit.table ? Json(orbit.table->file) : Json()},
          {"penumbra", span_of(eclipse.penumbra)},
          {"umbra", span_of(eclipse.umbra)}};
}

std::string orbit_line(const Json& facts) {
  const Json& umbra = facts["umbra"];
  const std::string shadow =
      umbra.is_null()
          ? "the Sun is never wholly hidden"
          : fmt::format("the Sun is hidden from {:.5g} to {:.5g} deg",
                        umbra["begin_deg"].get<double>(), umbra["end_deg"].get<double>());
  return fmt::format("orbit: {:.6g} km, period {:.6g} s, at {:g} deg; {}\n",
                     facts["altitude_m"].get<double>() / 1e3, facts["period_s"].get<double>(),
                     facts["position_deg"].get<double>(), shadow);
}

}  // namespace earthshine::app
