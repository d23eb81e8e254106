// SPDX-License-Identifier: Apache-2.0
#include "app/tools/inspect_text.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "base/units.h"
#include "scenes/sky/orbit.h"
#include "scenes/time/mission.h"

namespace earthshine::app {
namespace {

std::string numbers(const Json& three) {
  const auto plain = [&](std::size_t k) { return three[k].get<double>() + 0.0; };  // avoids -0
  return fmt::format("{:g} {:g} {:g}", plain(0), plain(1), plain(2));
}

// Text of a unit vector.
std::string direction(const Json& three) {
  const auto rounded = [&](std::size_t k) {
    return std::round(1e4 * three[k].get<double>()) / 1e4;
  };
  return fmt::format("{:.4f} {:.4f} {:.4f}", rounded(0) + 0.0, rounded(1) + 0.0, rounded(2) + 0.0);
}

double luminance_of(const Json& three) {
  return base::luminance({three[0].get<double>(), three[1].get<double>(), three[2].get<double>()});
}

std::string joined(const Json& words) {
  return fmt::format("{}", fmt::join(words.get<std::vector<std::string>>(), ", "));
}

std::string objects_table(const Json& report) {
  std::string text = fmt::format("\n{:<24} {:>9} {:>9} {:>12}  {}\n", "object", "polygons",
                                 "triangles", "area m2", "materials; source");
  for (const Json& o : report["objects"]) {
    text += fmt::format("{:<24} {:>9} {:>9} {:>12.6g}  {}; {}{}\n", o["name"], o["polygons"],
                        o["triangles"], o["area_m2"], joined(o["materials"]), o["source"],
                        o["target"].get<bool>() ? "; target" : "");
  }
  return text;
}

std::string bounds_table(const Json& report) {
  std::string text = fmt::format("\n{:<24} {:<32} {}\n", "bounds", "from m", "to m");
  for (const Json& o : report["objects"]) {
    text += fmt::format("{:<24} {:<32} {}\n", o["name"], numbers(o["bounds"]["min_m"]),
                        numbers(o["bounds"]["max_m"]));
  }
  for (const Json& pair : report["crossings"]["pairs"]) {
    const auto triangles = pair["triangles"].get<std::size_t>();
    text += fmt::format(
        "{} and {} run through one another: {}\n", pair["objects"][0], pair["objects"][1],
        triangles == 0
            ? "with faces in the same planes"
            : fmt::format("{} triangles, along {:.3g} m", triangles, pair["line_m"].get<double>()));
  }
  if (!report["crossings"]["complete"].get<bool>()) {
    text += "too many triangles lie close together: other objects may run through one another\n";
  }
  return text;
}

std::string surfaces_table(const Json& report) {
  std::string text = fmt::format(
      "\n{:<24} {:>7} {:>7} {:>7} {:>10} {:>12} {:>11} {:>9}  {}\n", "surface", "parts", "closed",
      "inward", "open edges", "non-manifold", "wound apart", "on others", "not used of the file");
  for (const Json& o : report["objects"]) {
    const Json& s = o["surface"];
    text += fmt::format("{:<24} {:>7} {:>7} {:>7} {:>10} {:>12} {:>11} {:>9}  {}\n", o["name"],
                        s["parts"], s["closed_parts"], s["inward_parts"], s["open_edges"],
                        s["non_manifold_edges"], s["mixed_edges"], s["triangles_on_others"],
                        o["unused"]);
  }
  return text;
}

std::string materials_table(const Json& report) {
  std::string text = fmt::format("\n{:<24} {:>10} {:<20} {:<20} {:>9}  {}\n", "material", "area m2",
                                 "diffuse", "specular", "shininess", "also");
  for (const Json& m : report["materials"]) {
    std::vector<std::string> also;
    if (!m["light_group"].is_null()) {
      also.push_back(
          fmt::format("emits {} lm/m2 in group {}", numbers(m["emit_lm_m2"]), m["light_group"]));
    }
    const std::string black = "0 0 0";
    if (numbers(m["mirror"]) != black) also.push_back("mirror " + numbers(m["mirror"]));
    if (numbers(m["transmit"]) != black) {
      also.push_back(fmt::format("transmits {}, ior {:g}", numbers(m["transmit"]), m["ior"]));
    }
    if (m["two_sided"].get<bool>()) also.push_back("two-sided");
    for (const Json& texture : m.value("textures", Json::array())) {
      also.push_back(fmt::format("{} by {} ({} x {}, {:.3g} MiB)", texture["use"], texture["file"],
                                 texture["size"][0], texture["size"][1], texture["mib"]));
    }
    text += fmt::format("{:<24} {:>10.5g} {:<20} {:<20} {:>9g}  {}\n", m["name"], m["area_m2"],
                        numbers(m["diffuse"]), numbers(m["specular"]), m["shininess"],
                        fmt::join(also, "; "));
  }
  return text;
}

std::string lights_table(const Json& report) {
  std::string text;
  for (const Json& lamp : report["lamps"]) {
    const Json& source = lamp["source"];
    if (lamp["flux_lm"].is_null()) {
      text +=
          fmt::format("lamp {}: {}, group {}, {} lx, toward {}\n", lamp["name"], lamp["type"],
                      lamp["group"], numbers(lamp["illuminance_lx"]), direction(lamp["direction"]));
      continue;
    }
    text += fmt::format(
        "lamp {}: {}{}, group {}, {} lm ({:.6g} by luminance), at {}\n", lamp["name"], lamp["type"],
        source.is_null() ? "" : " (" + source.get<std::string>() + ")", lamp["group"],
        numbers(lamp["flux_lm"]), luminance_of(lamp["flux_lm"]), numbers(lamp["position_m"]));
  }
  for (const Json& area : report["areas"]) {
    text +=
        fmt::format("area {}: {:.6g} m2, for distributed lights\n", area["name"], area["area_m2"]);
  }
  for (const char* name : {"sun", "earth"}) {
    const Json& body = report[name];
    if (body.is_null()) continue;
    text += fmt::format("{}: toward {}{}\n", name, direction(body["direction"]),
                        body["shines"].get<bool>()
                            ? ""
                            : " (gives no light: " + body["why"].get<std::string>() + ")");
  }
  if (!report["orbit"].is_null()) text += orbit_line(report["orbit"]);
  if (!report["mission"].is_null()) text += mission_lines(report["mission"]);
  for (const Json& camera : report["cameras"]) {
    text += fmt::format("camera {}: at {}, looks at {}, {:g} deg, {} x {}\n", camera["name"],
                        numbers(camera["position_m"]), numbers(camera["look_at_m"]),
                        camera["fov_deg"], camera["resolution"][0], camera["resolution"][1]);
  }
  const std::string groups = joined(report["light_groups"]);
  text += "light groups: " + (groups.empty() ? "none: nothing gives light" : groups) + "\n";
  return text;
}

Json span_of(const std::optional<scenes::ShadowSpan>& span) {
  if (!span) return {};
  return {{"begin_deg", span->begin_deg},
          {"end_deg", span->end_deg},
          {"begin_s", span->begin_s},
          {"end_s", span->end_s}};
}

}  // namespace

std::string inspect_text(const Json& report) {
  std::string text = fmt::format("{} ({})\n", report["name"], report["scene"]);
  text += fmt::format("{} objects, {} triangles, {:.6g} m2", report["objects"].size(),
                      report["triangles"], report["area_m2"]);
  if (!report["bounding_box"].is_null()) {
    text += fmt::format(", from {} to {} m", numbers(report["bounding_box"]["min_m"]),
                        numbers(report["bounding_box"]["max_m"]));
  }
  text += "\n" + objects_table(report) + bounds_table(report) + surfaces_table(report) +
          materials_table(report) + "\n" + lights_table(report);
  for (const Json& warning : report["warnings"]) {
    text += "warning: " + warning.get<std::string>() + "\n";
  }
  return text;
}

Json orbit_facts(const scenes::Scene& scene) {
  if (!scene.orbit || scenes::mission_of(scene) != nullptr) return {};
  const scenes::Orbit& orbit = *scene.orbit;
  const scenes::AttitudeTable* const table =
      orbit.files && orbit.files->attitudes ? &*orbit.files->attitudes : nullptr;
  const scenes::OrbitState state = scenes::orbit_state(orbit, orbit.position_deg);
  const scenes::Eclipse eclipse = scenes::find_eclipse(orbit, scene.sun->angular_radius_deg);
  return {{"altitude_m", orbit.altitude_m},
          {"period_s", scenes::orbit_period_s(orbit.altitude_m)},
          {"beta_deg", orbit.beta_deg},
          {"position_deg", state.position_deg},
          {"time_s", state.time_s},
          {"latitude_deg", state.latitude_deg},
          {"attitude", table == nullptr ? Json(orbit.attitude) : Json()},
          {"attitude_table", table == nullptr ? Json() : Json(table->file)},
          {"penumbra", span_of(eclipse.penumbra)},
          {"umbra", span_of(eclipse.umbra)}};
}

std::string orbit_line(const Json& facts) {
  const Json& umbra = facts["umbra"];
  const std::string shadow = umbra.is_null()
                                 ? "the Sun is never wholly hidden"
                                 : fmt::format("the Sun is hidden from {:.5g} to {:.5g} deg",
                                               umbra["begin_deg"], umbra["end_deg"]);
  return fmt::format("orbit: {:.6g} km, period {:.6g} s, at {:g} deg; {}\n",
                     facts["altitude_m"].get<double>() / 1e3, facts["period_s"],
                     facts["position_deg"], shadow);
}

}  // namespace earthshine::app
