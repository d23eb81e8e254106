// SPDX-License-Identifier: Apache-2.0
// earthshine inspect: what was read.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "app/command.h"
#include "app/console.h"
#include "app/options.h"
#include "app/tools/orbit_facts.h"
#include "scenes/light/lamp_light.h"

namespace earthshine::app {
namespace {

struct InspectCall {
  SceneInput scene;
  bool json = false;
};

Json objects_of(const scenes::Scene& scene) {
  Json objects = Json::array();
  for (const scenes::Object& object : scene.objects) {
    std::set<std::string> materials;
    for (std::uint32_t k = 0; k < object.triangle_count; ++k) {
      const auto& triangle = scene.triangles[object.first_triangle + k];
      materials.insert(scene.materials[triangle.material].name);
    }
    objects.push_back({{"name", object.name},
                       {"source", object.source},
                       {"polygons", object.polygon_count},
                       {"triangles", object.triangle_count},
                       {"degenerate", object.degenerate_count},
                       {"area_m2", object.area_m2},
                       {"materials", materials},
                       {"target", object.target}});
  }
  return objects;
}

// Diffuse, highlight (its share is 2 k_s / (n + 2)), mirror and transmitted light together.
Rgb reflected_share(const scenes::Material& m) {
  return m.diffuse + m.specular * (2.0 / (m.shininess + 2.0)) + m.mirror + m.transmit;
}

Json materials_of(const scenes::Scene& scene) {
  Json materials = Json::array();
  for (const scenes::Material& m : scene.materials) {
    materials.push_back({{"name", m.name},
                         {"diffuse", to_json(m.diffuse)},
                         {"specular", to_json(m.specular)},
                         {"shininess", m.shininess},
                         {"mirror", to_json(m.mirror)},
                         {"transmit", to_json(m.transmit)},
                         {"ior", m.ior},
                         {"emit_lm_m2", to_json(m.emit)},
                         {"light_group", m.emits() ? Json(m.light_group) : Json()},
                         {"two_sided", m.two_sided},
                         {"reflected_share", to_json(reflected_share(m))}});
  }
  return materials;
}

std::string kind_of(const scenes::Lamp& lamp) {
  switch (lamp.kind) {
    case scenes::LampKind::Point:
      return "point";
    case scenes::LampKind::Spot:
      return "spot";
    case scenes::LampKind::Rectangle:
      return "rectangle";
    case scenes::LampKind::Disk:
      return "disk";
    case scenes::LampKind::Measured:
      return "ies";
  }
  return "";
}

Json lights_of(const scenes::Scene& scene) {
  Json lamps = Json::array();
  for (const scenes::Lamp& lamp : scene.lamps) {
    lamps.push_back({{"name", lamp.name},
                     {"group", lamp.group},
                     {"type", kind_of(lamp)},
                     {"source", lamp.source.empty() ? Json() : Json(lamp.source)},
                     {"position_m", to_json(lamp.position)},
                     {"flux_lm", to_json(scenes::lamp_flux_lm(lamp))}});
  }
  return lamps;
}

Json areas_of(const scenes::Scene& scene) {
  Json areas = Json::array();
  for (const scenes::Area& area : scene.areas) {
    areas.push_back({{"name", area.name},
                     {"center_m", to_json(area.center)},
                     {"normal", to_json(area.normal)},
                     {"area_m2", glm::length(glm::cross(area.edge_u, area.edge_v))}});
  }
  return areas;
}

Json sky_of(const scenes::Scene& scene, const LoadedScene& loaded) {
  Json sky;
  sky["sun"] = Json();
  if (scene.sun) {
    sky["sun"] = {{"direction", to_json(scene.sun->direction)},
                  {"illuminance_lx", to_json(scene.sun->illuminance_lx)},
                  {"angular_radius_deg", scene.sun->angular_radius_deg},
                  {"shines", loaded.effects.sun}};
  }
  sky["earth"] = Json();
  if (scene.earth) {
    sky["earth"] = {
        {"direction", to_json(scene.earth->direction)},
        {"half_angle_deg", scene.earth->half_angle_deg},
        {"model", scene.earth->model == scenes::EarthModel::Lambert ? "lambert" : "uniform"},
        {"shines", loaded.effects.earth}};
  }
  return sky;
}

Json cameras_of(const scenes::Scene& scene) {
  Json cameras = Json::array();
  for (const scenes::Camera& camera : scene.cameras) {
    cameras.push_back({{"name", camera.name},
                       {"position_m", to_json(camera.position)},
                       {"look_at_m", to_json(camera.look_at)},
                       {"fov_deg", camera.fov_deg},
                       {"resolution", {camera.columns, camera.rows}},
                       {"cctv", camera.cctv.empty() ? Json() : Json(camera.cctv)}});
  }
  return cameras;
}

Json bounding_box_of(const scenes::Scene& scene) {
  if (scene.vertices.empty()) return {};
  Vec3 least = scene.vertices.front(), most = least;
  for (const Vec3& vertex : scene.vertices) {
    least = glm::min(least, vertex);
    most = glm::max(most, vertex);
  }
  return {{"min_m", to_json(least)}, {"max_m", to_json(most)}};
}

Json report_of(const LoadedScene& loaded) {
  const scenes::Scene& scene = loaded.scene;
  double area_m2 = 0.0;
  for (const scenes::Object& object : scene.objects) area_m2 += object.area_m2;
  Json report;
  report["scene"] = scene.path.string();
  report["name"] = scene.name;
  report["triangles"] = scene.triangles.size();
  report["area_m2"] = area_m2;
  report["bounding_box"] = bounding_box_of(scene);
  report["objects"] = objects_of(scene);
  report["materials"] = materials_of(scene);
  report["lamps"] = lights_of(scene);
  report["areas"] = areas_of(scene);
  report.update(sky_of(scene, loaded));
  report["orbit"] = orbit_facts(scene);
  report["ambient_radiance_cd_m2"] = to_json(scene.ambient_radiance);
  report["light_groups"] = loaded.groups.names;
  report["cameras"] = cameras_of(scene);
  report["warnings"] = scene.warnings;
  return report;
}

std::string numbers(const Json& three, const char* format = "{:g} {:g} {:g}") {
  return fmt::format(fmt::runtime(format), three[0].get<double>(), three[1].get<double>(),
                     three[2].get<double>());
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

std::string materials_table(const Json& report) {
  std::string text = fmt::format("\n{:<24} {:<20} {:<20} {:>9}  {}\n", "material", "diffuse",
                                 "specular", "shininess", "also");
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
    text += fmt::format("{:<24} {:<20} {:<20} {:>9g}  {}\n", m["name"].get<std::string>(),
                        numbers(m["diffuse"]), numbers(m["specular"]), m["shininess"].get<double>(),
                        also);
  }
  return text;
}

std::string lights_table(const Json& report) {
  std::string text;
  for (const Json& lamp : report["lamps"]) {
    const Json& source = lamp["source"];
    text += fmt::format("lamp {}: {}{}, group {}, {} lm, at {}\n", lamp["name"].get<std::string>(),
                        lamp["type"].get<std::string>(),
                        source.is_null() ? "" : " (" + source.get<std::string>() + ")",
                        lamp["group"].get<std::string>(), numbers(lamp["flux_lm"]),
                        numbers(lamp["position_m"]));
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

std::string inspect_text(const Json& report) {
  std::string text = fmt::format("{} ({})\n", report["name"].get<std::string>(),
                                 report["scene"].get<std::string>());
  text += fmt::format("{} objects, {} triangles, {:.6g} m2", report["objects"].size(),
                      report["triangles"].get<std::size_t>(), report["area_m2"].get<double>());
  if (!report["bounding_box"].is_null()) {
    text += fmt::format(", from {} to {} m", numbers(report["bounding_box"]["min_m"]),
                        numbers(report["bounding_box"]["max_m"]));
  }
  text += "\n" + objects_table(report) + materials_table(report) + "\n" + lights_table(report);
  for (const Json& warning : report["warnings"]) {
    text += "warning: " + warning.get<std::string>() + "\n";
  }
  return text;
}

}  // namespace

Command add_inspect(CLI::App& program) {
  CLI::App* parser = program.add_subcommand("inspect", "Show what was read from a scene file");
  const auto call = std::make_shared<InspectCall>();
  add_scene_options(*parser, call->scene);
  parser->add_flag("--json", call->json, "JSON on standard output");
  return {parser, [call](const Common&) {
            const Json report = report_of(load(call->scene, true));
            print(call->json ? dump(report) : inspect_text(report));
          }};
}

}  // namespace earthshine::app
