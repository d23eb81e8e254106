// SPDX-License-Identifier: Apache-2.0
// earthshine inspect: describes the scene as read.
#include <fmt/format.h>

#include <set>

#include "app/command.h"
#include "app/console.h"
#include "app/options.h"
#include "app/tools/inspect_text.h"
#include "scenes/effects/effects.h"
#include "scenes/health/crossings.h"
#include "scenes/light/lamp_light.h"
#include "scenes/ray_query.h"
#include "scenes/reflect/energy.h"
#include "scenes/surface_texture.h"
#include "scenes/texture/texture.h"
#include "scenes/triangle_point.h"

namespace earthshine::app {
namespace {

struct InspectCall {
  SceneInput scene;
  bool json = false;
};

Json objects_of(const scenes::Scene& scene) {
  Json objects = Json::array();
  std::vector<std::set<std::uint32_t>> on_others(scene.objects.size());  // coincident triangles
  for (const scenes::FacePair& pair : scene.coincident) {
    for (const std::uint32_t t : {pair.a, pair.b}) {
      on_others[scene.triangles[t].object].insert(t);
    }
  }
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const scenes::Object& object = scene.objects[o];
    std::set<std::uint32_t> worn;
    for (std::uint32_t k = 0; k < object.triangle_count; ++k) {
      worn.insert(scene.triangles[object.first_triangle + k].material);
    }
    std::set<std::string> materials;
    for (const std::uint32_t m : worn) materials.insert(scene.materials[m].name);
    const scenes::Box bounds = scenes::bounds_of(scene, object);
    objects.push_back(
        {{"name", object.name},
         {"source", object.source},
         {"polygons", object.polygon_count},
         {"triangles", object.triangle_count},
         {"degenerate", object.degenerate_count},
         {"area_m2", object.area_m2},
         {"bounds", {{"min_m", to_json(bounds.low)}, {"max_m", to_json(bounds.high)}}},
         {"materials", materials},
         {"target", object.target},
         {"surface",
          {{"parts", object.surface.parts},
           {"closed_parts", object.surface.closed_parts},
           {"inward_parts", object.surface.inward_parts},
           {"open_edges", object.surface.open_edges},
           {"non_manifold_edges", object.surface.non_manifold_edges},
           {"mixed_edges", object.surface.mixed_edges},
           {"triangles_on_others", on_others[o].size()}}},
         {"unused", object.unused}});
    if (object.instance) {
      objects.back()["instance_of"] = scene.objects[object.instance->object].name;
    }
  }
  return objects;
}

// Intersecting objects, by pairs.
Json crossings_of(const scenes::Scene& scene) {
  const scenes::Crossings found = scenes::find_crossings(scene);
  Json pairs = Json::array();
  for (const scenes::Crossing& pair : found.pairs) {
    pairs.push_back({{"objects", {scene.objects[pair.a].name, scene.objects[pair.b].name}},
                     {"triangles", pair.triangles},
                     {"line_m", pair.line_m}});
  }
  return {{"pairs", pairs}, {"complete", found.complete}};
}

// Use, file and size of each texture.
Json textures_of(const scenes::MaterialMaps& maps) {
  Json textures = Json::array();
  const auto add = [&](const char* use, const scenes::TextureMap& map) {
    if (!map.texture) return;
    textures.push_back({{"use", use},
                        {"file", map.texture->name()},
                        {"size", {map.texture->width(), map.texture->height()}},
                        {"mib", static_cast<double>(map.texture->bytes()) / 1048576.0}});
  };
  add("diffuse", maps.diffuse);
  add("emit", maps.emit);
  add("opacity", maps.opacity);
  return textures;
}

Json materials_of(const scenes::Scene& scene) {
  std::vector<double> area_m2(scene.materials.size(), 0.0);
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    area_m2[scene.triangles[t].material] += scenes::triangle_area(scene, t);
  }
  Json materials = Json::array();
  for (std::size_t k = 0; k < scene.materials.size(); ++k) {
    const scenes::Material& m = scene.materials[k];
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
                         {"even_lobe", m.even_lobe},
                         {"area_m2", area_m2[k]},
                         {"reflected_share", to_json(scenes::reflected_share(m))}});
    if (m.maps) materials.back()["textures"] = textures_of(*m.maps);
  }
  return materials;
}

Json lights_of(const scenes::Scene& scene) {
  Json lamps = Json::array();
  for (const scenes::Lamp& lamp : scene.lamps) {
    lamps.push_back(
        {{"name", lamp.name},
         {"group", lamp.group},
         {"type", std::string(scenes::row_of(lamp.kind).type)},
         {"source", lamp.source.empty() ? Json() : Json(lamp.source)},
         {"position_m", lamp.is_distant() ? Json() : to_json(lamp.position)},
         {"flux_lm", lamp.is_distant() ? Json() : to_json(scenes::lamp_flux_lm(lamp))}});
    if (!lamp.is_distant()) continue;
    lamps.back()["direction"] = to_json(-lamp.axis);
    lamps.back()["illuminance_lx"] = to_json(lamp.illuminance_lx);
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
  Json sky, why;
  for (const auto& row : scenes::describe_effects(scene, loaded.groups, loaded.asked)) {
    why[row.effect] = row.reason;
  }
  sky["sun"] = Json();
  if (scene.sun) {
    sky["sun"] = {{"direction", to_json(scene.sun->direction)},
                  {"illuminance_lx", to_json(scene.sun->illuminance_lx)},
                  {"angular_radius_deg", scene.sun->angular_radius_deg},
                  {"shines", loaded.effects.sun},
                  {"why", why["sun"]}};
  }
  sky["earth"] = Json();
  if (scene.earth) {
    sky["earth"] = {
        {"direction", to_json(scene.earth->direction)},
        {"half_angle_deg", scene.earth->half_angle_deg},
        {"model", scene.earth->model == scenes::EarthModel::Lambert ? "lambert" : "uniform"},
        {"shines", loaded.effects.earth},
        {"why", why["earth"]}};
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
  const scenes::Box box = scenes::box_around(scene.vertices);
  return {{"min_m", to_json(box.low)}, {"max_m", to_json(box.high)}};
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
  report["crossings"] = crossings_of(scene);
  report["materials"] = materials_of(scene);
  report["lamps"] = lights_of(scene);
  report["areas"] = areas_of(scene);
  report.update(sky_of(scene, loaded));
  report["orbit"] = orbit_facts(scene);
  report["mission"] = mission_facts(scene);
  if (const std::size_t bytes = scenes::texture_bytes(scene); bytes > 0) {
    report["texture_mib"] = static_cast<double>(bytes) / 1048576.0;
  }
  report["ambient_radiance_cd_m2"] = to_json(scene.ambient_radiance);
  report["light_groups"] = loaded.groups.names;
  report["cameras"] = cameras_of(scene);
  report["warnings"] = scene.warnings;
  return report;
}

}  // namespace

Command add_inspect(CLI::App& program) {
  CLI::App* parser =
      add_subcommand(program, "inspect", "Lists the contents of a scene file, with warnings");
  const auto call = std::make_shared<InspectCall>();
  add_scene(*parser, call->scene);
  parser->add_flag("--json", call->json, "JSON on standard output");
  return {parser, [call](const Common&) {
            LoadedScene loaded = load(call->scene, true);
            scenes::SceneUse use;
            use.shows_facts = true;
            try {
              (void)ray_query(loaded, use, true);
            } catch (const base::Error& error) {
              if (error.blame() != base::Blame::Work) throw;
              loaded.scene.warnings.emplace_back(
                  "checks that need rays are left out: they do not fit into memory");
            }
            const Json report = report_of(loaded);
            print(call->json ? dump(report) : inspect_text(report));
          }};
}

}  // namespace earthshine::app
