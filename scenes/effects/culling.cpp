// SPDX-License-Identifier: Apache-2.0
#include "scenes/effects/culling.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "scenes/light/lamp_light.h"
#include "scenes/ray_query.h"

namespace earthshine::scenes {
namespace {

constexpr double rounding = 1e-6;             // of sines, and relative to the scene's extent
constexpr double small_share = 1e-3;          // share of the wanted error
constexpr std::size_t most_triangles = 2048;  // up to which all pairs are tested

struct Face {
  std::array<Vec3, 3> corner;
  Vec3 normal;
  bool both_sides;  // sheets and glass: they receive light from behind
};

double along(const Face& face, const Vec3& point) {
  return glm::dot(face.normal, point - face.corner[0]);
}

class CullingPass {
 public:
  explicit CullingPass(const Scene& scene) : scene_(scene) {
    if (scene.triangles.empty()) return;
    const Vec3 first = scene.vertices[scene.triangles[0].vertex[0]];
    for (const Triangle& triangle : scene.triangles) {
      for (const std::uint32_t v : triangle.vertex) {
        extent_ = std::max(extent_, glm::length(scene.vertices[v] - first));
      }
    }
  }

  // Whether a disc of directions lies below the horizon of every surface.
  [[nodiscard]] bool below_every_horizon(const Vec3& direction, double radius_rad) const {
    return no_face([&](const Face& face) {
      return face.both_sides || glm::dot(face.normal, direction) > -std::sin(radius_rad) - rounding;
    });
  }

  [[nodiscard]] bool lights_nothing(const Lamp& lamp,
                                    const std::vector<const Camera*>& cameras) const {
    if (lamp.is_distant()) return below_every_horizon(-lamp.axis, 0.0);
    if (is_wide(lamp.kind) &&
        std::any_of(cameras.begin(), cameras.end(), [&](const Camera* camera) {
          return glm::dot(lamp.axis, camera->position - lamp.position) >
                 -0.5 * camera->aperture_m - slack();
        })) {
      return false;
    }
    return no_face([&](const Face& face) { return may_light(lamp, face); });
  }

  // Whether any two surfaces are in front of each other.
  [[nodiscard]] bool any_facing() const {
    if (scene_.triangles.size() > most_triangles) return true;
    std::vector<Face> faces;
    for (std::uint32_t t = 0; t < scene_.triangles.size(); ++t) faces.push_back(face_of(t));
    const auto reaches = [this](const Face& from, const Face& to) {
      return from.both_sides || std::any_of(to.corner.begin(), to.corner.end(), [&](const Vec3& p) {
               return along(from, p) > slack();
             });
    };
    for (std::size_t a = 0; a < faces.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        if (reaches(faces[a], faces[b]) && reaches(faces[b], faces[a])) return true;
      }
    }
    return false;
  }

  [[nodiscard]] double largest_reflectance() const {
    double largest = 0.0;
    for (const Triangle& t : scene_.triangles) {
      const Material& material = scene_.materials[t.material];
      // A texture has places brighter than its mean.
      largest = std::max(largest, material.maps ? 1.0 : base::max_component(material.diffuse));
    }
    return largest;
  }

 private:
  [[nodiscard]] Face face_of(std::uint32_t t) const {
    const Triangle& triangle = scene_.triangles[t];
    const Material& material = scene_.materials[triangle.material];
    Face face;
    for (std::size_t k = 0; k < 3; ++k) face.corner[k] = scene_.vertices[triangle.vertex[k]];
    face.normal = triangle_normal(scene_, t);
    face.both_sides = material.two_sided || base::max_component(material.transmit) > 0.0;
    return face;
  }
  // Stops at the first match, usually among the first faces.
  [[nodiscard]] bool no_face(const std::function<bool(const Face&)>& is) const {
    for (std::uint32_t t = 0; t < scene_.triangles.size(); ++t) {
      if (is(face_of(t))) return false;
    }
    return true;
  }

  [[nodiscard]] double slack() const { return rounding * std::max(extent_, 1e-3); }

  [[nodiscard]] bool may_light(const Lamp& lamp, const Face& face) const {
    // Half the lamp's extent along the face's normal.
    double reach = 0.0;
    if (lamp.kind == LampKind::Rectangle) {
      reach = 0.5 * (std::abs(glm::dot(face.normal, lamp.edge_u)) +
                     std::abs(glm::dot(face.normal, lamp.edge_v)));
    } else if (lamp.kind == LampKind::Disk) {
      reach = lamp.radius_m;
    }
    if (!face.both_sides && along(face, lamp.position) + reach <= -slack()) return false;
    const bool half_space =
        is_wide(lamp.kind) || (lamp.kind == LampKind::Spot && lamp.field_deg <= 180.0);
    const bool in_front = std::any_of(face.corner.begin(), face.corner.end(), [&](const Vec3& p) {
      return glm::dot(lamp.axis, p - lamp.position) > -slack();
    });
    if (half_space && !in_front) return false;
    return lamp.kind != LampKind::Spot || meets_cone(lamp, face);
  }

  // Bounding sphere of the triangle against the cone of the spot.
  [[nodiscard]] static bool meets_cone(const Lamp& lamp, const Face& face) {
    const Vec3 middle = (face.corner[0] + face.corner[1] + face.corner[2]) / 3.0;
    double radius = 0.0;
    for (const Vec3& p : face.corner) radius = std::max(radius, glm::length(p - middle));
    const Vec3 offset = middle - lamp.position;
    const double distance = glm::length(offset);
    if (distance <= radius) return true;
    const double off_axis =
        std::acos(std::clamp(glm::dot(lamp.axis, offset) / distance, -1.0, 1.0));
    return off_axis - std::asin(radius / distance) <=
           0.5 * base::radians(lamp.field_deg) + rounding;
  }

  const Scene& scene_;
  double extent_ = 0.0;  // m
};

// Runs after the other decisions: bounds of the light between surfaces.
std::vector<Culling> skip_interreflection(const CullingPass& finder, double wanted_error,
                                          Effects& effects) {
  const bool read_otherwise = effects.phong || effects.mirror || effects.refraction ||
                              effects.emitters || effects.earth_by_gather;
  if (!effects.solution || read_otherwise) return {};
  Culling culled{"interreflection", "cannot matter: no surface is in front of another"};
  const double r = finder.largest_reflectance();
  const double error = r < 1.0 ? r / (1.0 - r) : 1.0;
  if (error <= small_share * wanted_error) {
    culled.error = error;
    culled.why = fmt::format(
        "cannot matter: reflectances up to {:.2g} leave out {:.2g} of the "
        "light at most, the wanted error is {:g}",
        r, error, wanted_error);
  } else if (finder.any_facing()) {
    return {};
  }
  effects.interreflection = effects.solution = false;
  return {culled};
}

}  // namespace

std::vector<Culling> cull_effects(const Scene& scene, const Asked& asked, double wanted_error,
                                  const HiddenLights& hidden, LightGroups& groups,
                                  Effects& effects) {
  std::vector<Culling> culled;
  const CullingPass finder(scene);
  std::vector<const Camera*> cameras = asked.cameras;
  for (const Camera& camera : scene.cameras) {
    if (asked.cameras.empty()) cameras.push_back(&camera);
  }
  const char* const walled = "cannot matter: closed walls stand between it and every camera";
  const bool sun_culled =
      effects.sun &&
      (hidden.sky || finder.below_every_horizon(scene.sun->direction,
                                                base::radians(scene.sun->angular_radius_deg)));
  const bool earth_culled =
      effects.earth && !asked.earth_on_area &&
      (hidden.sky || finder.below_every_horizon(scene.earth->direction,
                                                base::radians(scene.earth->half_angle_deg)));
  bool lamp_culled = false;
  for (std::size_t k = 0; k < scene.lamps.size(); ++k) {
    if (groups.lamp[k] == no_group) continue;
    const Lamp& lamp = scene.lamps[k];
    const bool shut_in = k < hidden.lamps.size() && hidden.lamps[k];
    if (!shut_in && !finder.lights_nothing(lamp, cameras)) continue;
    groups.lamp[k] = no_group;
    lamp_culled = true;
    culled.push_back(
        {std::string(effect_of(kind_of(lamp.kind))),
         shut_in
             ? fmt::format("cannot matter: closed walls stand between lamp \"{}\" and every camera",
                           lamp.name)
             : fmt::format("cannot matter: no surface and no camera is in reach of lamp \"{}\"",
                           lamp.name)});
  }
  if (lamp_culled) effects = find_effects(scene, groups, asked);
  if (sun_culled) {
    if (effects.penumbra) {
      culled.push_back({"penumbra", "cannot matter: no sunlight reaches a visible surface"});
    }
    effects.sun = effects.penumbra = false;
    culled.push_back(
        {"sun", hidden.sky ? walled : "cannot matter: it is below the horizon of every surface"});
  }
  if (earth_culled) {
    effects.earth = effects.earth_by_gather = false;
    culled.push_back(
        {"earth",
         hidden.sky ? walled : "cannot matter: its disc is below the horizon of every surface"});
  }
  if (culled.empty()) return skip_interreflection(finder, wanted_error, effects);
  const bool lit =
      effects.sun || effects.sun_parts || effects.earth || effects.lamps || effects.emitters;
  const auto forget = [&](const char* effect, bool& runs, const char* why) {
    if (runs) culled.push_back({effect, why});
    runs = false;
  };
  const bool goes_on = asked.paths == LightPaths::All || asked.paths == LightPaths::Traced;
  if (!lit) {
    const char* const dark = "cannot matter: no light is left that could reach a surface";
    forget("interreflection", effects.interreflection, dark);
    forget("phong lobe", effects.phong, dark);
    forget("glossy reflection", effects.glossy, dark);
    effects.solution = false;
  } else if (!goes_on && !effects.earth_by_gather) {
    forget("glossy reflection", effects.glossy, "cannot matter: it has the Earth alone to show");
  }
  for (Culling& row : skip_interreflection(finder, wanted_error, effects)) {
    culled.push_back(std::move(row));
  }
  return culled;
}

}  // namespace earthshine::scenes
