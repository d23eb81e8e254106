// SPDX-License-Identifier: Apache-2.0
// Describes a mission for `inspect`, so that a wrong frame or time system is obvious.
#include <fmt/format.h>

#include <algorithm>

#include "app/tools/inspect_text.h"
#include "scenes/time/mission.h"

namespace earthshine::app {
namespace {

using scenes::Instant;

// Longer intervals are truncated: every orbit has an eclipse.
constexpr double longest_eclipse_span_s = 31 * 86400.0;
constexpr double same_moment_s = 1e-6;  // of two segments: dates are exact to 0.1 us

Json moment_text(const std::optional<Instant>& t) {
  return t ? Json(scenes::utc_text(*t)) : Json();
}

// [time], or one revolution from the scene's time; of an orbit without a period all states from
// there on.
Instant end_of_eclipses(const scenes::Mission& mission, Instant start) {
  Instant stop = std::max(mission.time.stop, start);
  if (!mission.has_span) {
    const auto period_s = scenes::period_at(mission, start);
    stop = period_s ? start + *period_s : mission.trajectory->last();
  }
  return std::min(stop, start + longest_eclipse_span_s);
}

// Within the states. Segments that share a moment are one span, so that an eclipse at that moment
// is one.
Json eclipses_of(const scenes::Scene& scene, const scenes::Mission& mission) {
  const Instant start = mission.has_span ? mission.time.start : mission.moment;
  const Instant stop = end_of_eclipses(mission, start);
  Json list = Json::array();
  const auto& segments = mission.trajectory->segments;
  for (std::size_t k = 0; k < segments.size(); ++k) {
    const Instant from = std::max(start, segments[k].first_useful);
    while (k + 1 < segments.size() &&
           segments[k + 1].first_useful - segments[k].last_useful < same_moment_s) {
      ++k;
    }
    const Instant to = std::min(stop, segments[k].last_useful);
    if (!(from < to)) continue;
    for (const scenes::EclipseTimes& eclipse :
         scenes::eclipses_between(mission, from, to, scene.sun->angular_radius_deg)) {
      list.push_back({{"penumbra_begin", moment_text(eclipse.penumbra_begin)},
                      {"umbra_begin", moment_text(eclipse.umbra_begin)},
                      {"umbra_end", moment_text(eclipse.umbra_end)},
                      {"penumbra_end", moment_text(eclipse.penumbra_end)}});
    }
  }
  return list;
}

std::string or_dash(const Json& text) { return text.is_null() ? "-" : text.get<std::string>(); }

}  // namespace

Json mission_facts(const scenes::Scene& scene) {
  const scenes::Mission* const mission = scenes::mission_of(scene);
  if (mission == nullptr) return {};
  const scenes::Trajectory& trajectory = *mission->trajectory;
  const Instant start = mission->moment;
  const scenes::MissionState state = scenes::mission_state(*mission, start);
  const auto period_s = scenes::period_at(*mission, start);
  Json segments = Json::array();
  for (const scenes::TrajectorySegment& segment : trajectory.segments) {
    segments.push_back({{"start", scenes::utc_text(segment.first_useful)},
                        {"stop", scenes::utc_text(segment.last_useful)},
                        {"states", segment.at.size()}});
  }
  return {{"trajectory", trajectory.file},
          {"object", trajectory.object},
          {"frame", trajectory.frame_name},
          {"time_system", trajectory.time_system},
          {"segments", segments},
          {"utc", scenes::utc_text(start)},
          {"stop", mission->has_span ? Json(scenes::utc_text(mission->time.stop)) : Json()},
          {"step_s", mission->has_span ? Json(mission->time.step_s) : Json()},
          {"moments", mission->time.count()},
          {"tai_minus_utc_s", scenes::tai_minus_utc_s(start)},
          {"ut1_minus_utc_s", mission->clock.ut1_minus_utc_s},
          {"latitude_deg", state.below.latitude_deg},
          {"longitude_deg", state.below.longitude_deg},
          {"height_m", state.below.height_m},
          {"distance_m", state.distance_m},
          {"period_s", period_s ? Json(*period_s) : Json()},
          {"beta_deg", state.beta_deg},
          {"position_deg", state.position_deg},
          {"attitude", mission->history ? Json() : Json(mission->attitude)},
          {"attitude_file", mission->history ? Json(mission->history->file) : Json()},
          {"attitude_frame", mission->history ? Json(mission->history->frame_name) : Json()},
          {"eclipses", eclipses_of(scene, *mission)}};
}

std::string mission_lines(const Json& facts) {
  std::string text = fmt::format("trajectory: {} of {}, {}, {}; TAI - UTC = {:g} s\n",
                                 facts["trajectory"], facts["object"], facts["frame"],
                                 facts["time_system"], facts["tai_minus_utc_s"].get<double>());
  for (const Json& segment : facts["segments"]) {
    text += fmt::format("  {} states from {} to {}\n", segment["states"].get<std::size_t>(),
                        segment["start"], segment["stop"]);
  }
  text += fmt::format(
      "at {}: over latitude {:.4f}, longitude {:.4f} deg, {:.2f} km high; beta {:.3f} deg, orbit "
      "{:.2f} deg from noon, {}\n",
      facts["utc"], facts["latitude_deg"].get<double>(), facts["longitude_deg"].get<double>(),
      facts["height_m"].get<double>() / 1e3, facts["beta_deg"].get<double>(),
      facts["position_deg"].get<double>(),
      facts["period_s"].is_null()
          ? "no period: a parabola or hyperbola"
          : fmt::format("period {:.2f} min", facts["period_s"].get<double>() / 60.0));
  if (!facts["attitude_file"].is_null()) {
    text += fmt::format("attitude: {}, from {}\n", facts["attitude_file"], facts["attitude_frame"]);
  } else {
    text += fmt::format("attitude: {}\n", facts["attitude"]);
  }
  for (const Json& eclipse : facts["eclipses"]) {
    text += fmt::format("eclipse: penumbra {}, umbra {} to {}, penumbra ends {}\n",
                        or_dash(eclipse["penumbra_begin"]), or_dash(eclipse["umbra_begin"]),
                        or_dash(eclipse["umbra_end"]), or_dash(eclipse["penumbra_end"]));
  }
  if (facts["eclipses"].empty()) text += "eclipse: none in this time\n";
  return text;
}

}  // namespace earthshine::app
