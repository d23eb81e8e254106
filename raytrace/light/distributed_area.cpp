// SPDX-License-Identifier: Apache-2.0
#include "raytrace/light/distributed_area.h"

#include <fmt/format.h>

#include "radiosity/direct/lambert.h"
#include "radiosity/exact/polygon/convex_polygon.h"
#include "scenes/light/lamp_light.h"
#include "scenes/sky/sky.h"
#include "scenes/triangle_point.h"

namespace earthshine::raytrace {
namespace {

using base::Blame;
using base::Error;

const scenes::Area& find_area(const scenes::Scene& scene, const std::string& name) {
  std::vector<std::string> names;
  for (const scenes::Area& area : scene.areas) {
    if (area.name == name) return area;
    names.push_back(area.name);
  }
  throw Error(Blame::Input, scene.path.string(), "has no [[area]] \"" + name + "\"",
              names.empty() ? "" : fmt::format("its areas are {}", fmt::join(names, ", ")),
              names.empty() ? "Add [[area]] with name, center, edge_u and edge_v" : "");
}

// Share of the view of a plate facing `normal` that the area's shining side fills.
double share_of_view(const scenes::Area& area, const Vec3& point, const Vec3& normal) {
  if (glm::dot(point - area.center, area.normal) <= 0.0) return 0.0;
  const Vec3 u = 0.5 * area.edge_u, v = 0.5 * area.edge_v;
  const radiosity::ConvexPolygon whole = radiosity::make_polygon(
      {area.center - u - v, area.center + u - v, area.center + u + v, area.center - u + v},
      area.normal);
  const radiosity::ConvexPolygon seen = radiosity::clip(whole, {point, normal}, 0.0);
  radiosity::LambertSum sum(normal);
  for (int k = 0; k < seen.count; ++k) sum.add(seen[k] - point, seen.next(k) - point);
  return sum.share();
}

}  // namespace

Vec3 scene_centre(const scenes::Scene& scene) {
  if (scene.vertices.empty()) return Vec3(0.0);
  return scenes::box_around(scene.vertices).middle();
}

Rgb earth_illuminance_lx(const scenes::Scene& scene) {
  // The terminator of a Lambert Earth is the only edge in the disc: errors below 1e-3 of E.
  constexpr int rings = 64, sectors = 256;
  const double half_angle = base::radians(scene.earth->half_angle_deg);
  Rgb sum(0.0);
  for (int i = 0; i < rings; ++i) {
    for (int k = 0; k < sectors; ++k) {
      const Vec3 direction = scenes::sample_cone(scene.earth->direction, half_angle,
                                                 (i + 0.5) / rings, (k + 0.5) / sectors);
      sum += scenes::earth_radiance(scene, direction) * glm::dot(direction, scene.earth->direction);
    }
  }
  return sum * (scenes::cone_solid_angle_sr(half_angle) / (rings * sectors));
}

std::optional<scenes::Lamp> earth_area(const scenes::Scene& scene, const std::string& name) {
  if (name.empty()) return std::nullopt;
  const scenes::Area& area = find_area(scene, name);
  const std::string where = fmt::format("[[area]] \"{}\"", name);
  if (!scene.earth) {
    throw Error(Blame::Input, where, "stands for the Earth, and the scene has none", {},
                "Add [earth] or [orbit]");
  }
  const Vec3 centre = scene_centre(scene);
  const double share = share_of_view(area, centre, scene.earth->direction);
  if (!(share > 1e-6)) {
    throw Error(
        Blame::Input, where,
        fmt::format("does not light the scene's centre ({:.3g}, {:.3g}, {:.3g}) from the Earth's "
                    "side",
                    centre.x, centre.y, centre.z),
        "it lies between the scene and the Earth and shines along edge_u x edge_v",
        "Move it, or swap edge_u and edge_v");
  }
  scenes::Lamp lamp;
  lamp.name = area.name;
  lamp.kind = scenes::LampKind::Rectangle;
  lamp.position = area.center;
  lamp.axis = area.normal;
  lamp.edge_u = area.edge_u;
  lamp.edge_v = area.edge_v;
  lamp.exitance = earth_illuminance_lx(scene) / share;
  return lamp;
}

}  // namespace earthshine::raytrace
