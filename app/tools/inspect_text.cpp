// SPDX-License-Identifier: Apache-2.0
#include "app/tools/inspect_text.h"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "app/tools/orbit_facts.h"
#include "base/units.h"

namespace earthshine::app {
namespace {

std::string numbers(const Json& three, const char* format = "{:g} {:g} {:g}") {
  return fmt::format(fmt::runtime(format), three[0].get<double>(), three[1].get<double>(),
                     three[2].get<double>());
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
    text += fmt::format("{:<24} {:>9} {:>9} {:>12.6g}  {}; {}{}\n", o["name"].get<std::string>(),
                        o["polygons"].get<int>(), o["triangles"].get<int>(),
                        o["area_m2"].get<double>(), joined(o["materials"]),
                        o["source"].get<std::string>(), o["target"].get<bool>() ? "; target" : "");
  }
  return text;
}

std::string surfaces_table(const Json& report) {
  std::string text = fmt::format(
      "\n{:<24} {:>7} {:>7} {:>7} {:>10} {:>12} {:>11} {:>9}  {}\n", "surface", "parts", "closed",
      "inward", "open edges", "non-manifold", "wound apart", "on others", "not used of the file");
  for (const Json& o : report["objects"]) {
    const Json& s = o["surface"];
    text += fmt::format(
        "{:<24} {:>7} {:>7} {:>7} {:>10} {:>12} {:>11} {:>9}  {}\n", o["name"].get<std::string>(),
        s["parts"].get<int>(), s["closed_parts"].get<int>(), s["inward_parts"].get<int>(),
        s["open_edges"].get<int>(), s["non_manifold_edges"].get<int>(), s["mixed_edges"].get<int>(),
        s["triangles_on_others"].get<int>(), o["unused"].get<std::string>());
  }
  return text;
}

std::string materials_table(const Json& report) {
  std::string text = fmt::format("\n{:<24} {:>10} {:<20} {:<20} {:>9}  {}\n", "material", "area m2",
                                 "diffuse", "specular", "shininess", "also");
  for (const Json& m : report["materials"]) {
    std::string also;
    if (!m["light_group"].is_null()) {
      also += fmt::format("emits {} lm/m2 in group {}; ", numbers(m["emit_lm_m2"]),
                          m["light_group"].get<std::string>());
    }
    const std::string black = "0 0 0";
    if (numbers(m["mirror"]) != black) also += "mirror " + numbers(m["mirror"]) + "; ";
    if (numbers(m["transmit"]) != black) also += "transmits " + numbers(m["transmit"]) + "; ";
    if (m["two_sided"].get<bool>()) also += "two-sided";
    for (const Json& texture : m.value("textures", Json::array())) {
      also += fmt::format("{}{} by {} ({} x {}, {:.3g} MiB)",
                          also.empty() || also.ends_with("; ") ? "" : "; ",
                          texture["use"].get<std::string>(), texture["file"].get<std::string>(),
                          texture["size"][0].get<int>(), texture["size"][1].get<int>(),
                          texture["mib"].get<double>());
    }
    text += fmt::format("{:<24} {:>10.5g} {:<20} {:<20} {:>9g}  {}\n", m["name"].get<std::string>(),
                        m["area_m2"].get<double>(), numbers(m["diffuse"]), numbers(m["specular"]),
                        m["shininess"].get<double>(), also);
  }
  return text;
}

std::string lights_table(const Json& report) {
  std::string text;
  for (const Json& lamp : report["lamps"]) {
    const Json& source = lamp["source"];
    text += fmt::format("lamp {}: {}{}, group {}, {} lm ({:.6g} by luminance), at {}\n",
                        lamp["name"].get<std::string>(), lamp["type"].get<std::string>(),
                        source.is_null() ? "" : " (" + source.get<std::string>() + ")",
                        lamp["group"].get<std::string>(), numbers(lamp["flux_lm"]),
                        luminance_of(lamp["flux_lm"]), numbers(lamp["position_m"]));
  }
  for (const Json& area : report["areas"]) {
    text += fmt::format("area {}: {:.6g} m2, for distributed lights\n",
                        area["name"].get<std::string>(), area["area_m2"].get<double>());
  }
  for (const char* name : {"sun", "earth"}) {
    const Json& body = report[name];
    if (body.is_null()) continue;
    text +=
        fmt::format("{}: toward {}{}\n", name, numbers(body["direction"], "{:.4f} {:.4f} {:.4f}"),
                    body["shines"].get<bool>() ? "" : " (gives no light)");
  }
  if (!report["orbit"].is_null()) text += orbit_line(report["orbit"]);
  for (const Json& camera : report["cameras"]) {
    text += fmt::format("camera {}: at {}, looks at {}, {:g} deg, {} x {}\n",
                        camera["name"].get<std::string>(), numbers(camera["position_m"]),
                        numbers(camera["look_at_m"]), camera["fov_deg"].get<double>(),
                        camera["resolution"][0].get<int>(), camera["resolution"][1].get<int>());
  }
  const std::string groups = joined(report["light_groups"]);
  text += "light groups: " + (groups.empty() ? "none: nothing gives light" : groups) + "\n";
  return text;
}

}  // namespace

std::string inspect_text(const Json& report) {
  std::string text = fmt::format("{} ({})\n", report["name"].get<std::string>(),
                                 report["scene"].get<std::string>());
  text += fmt::format("{} objects, {} triangles, {:.6g} m2", report["objects"].size(),
                      report["triangles"].get<std::size_t>(), report["area_m2"].get<double>());
  if (!report["bounding_box"].is_null()) {
    text += fmt::format(", from {} to {} m", numbers(report["bounding_box"]["min_m"]),
                        numbers(report["bounding_box"]["max_m"]));
  }
  text += "\n" + objects_table(report) + surfaces_table(report) + materials_table(report) + "\n" +
          lights_table(report);
  for (const Json& warning : report["warnings"]) {
    text += "warning: " + warning.get<std::string>() + "\n";
  }
  return text;
}

}  // namespace earthshine::app
