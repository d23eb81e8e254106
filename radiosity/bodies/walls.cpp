// SPDX-License-Identifier: Apache-2.0
#include "radiosity/bodies/walls.h"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "base/free_memory.h"
#include "radiosity/bodies/closed_bodies.h"
#include "radiosity/bodies/closed_parts.h"
#include "scenes/light/lamp_light.h"
#include "scenes/triangle_point.h"

namespace earthshine::radiosity {
namespace {

// Peak memory of the search, measured: sorted edges, then vertices with their edges.
constexpr std::uint64_t bytes_per_triangle = 180;

struct Ball {
  Vec3 centre;
  double radius_m;
};

// Squared distance of a point from a triangle: from the plane if its projection is inside, else
// from the nearest edge.
double squared_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = glm::cross(b - a, c - a);
  const auto inside = [&](const Vec3& from, const Vec3& to) {
    return glm::dot(glm::cross(normal, to - from), p - from) >= 0.0;
  };
  const double square = glm::dot(normal, normal);
  if (square > 0.0 && inside(a, b) && inside(b, c) && inside(c, a)) {
    const double along = glm::dot(normal, p - a);
    return along * along / square;
  }
  const auto from_edge = [&p](const Vec3& from, const Vec3& to) {
    const Vec3 edge = to - from, offset = p - from;
    const double length2 = glm::dot(edge, edge);
    const double t = length2 > 0.0 ? std::clamp(glm::dot(offset, edge) / length2, 0.0, 1.0) : 0.0;
    const Vec3 left = offset - t * edge;
    return glm::dot(left, left);
  };
  return std::min({from_edge(a, b), from_edge(b, c), from_edge(c, a)});
}

struct Wall {
  std::vector<Vec3> corners;  // three per triangle
  ClosedSurface surface;

  explicit Wall(std::vector<Vec3> all) : corners(std::move(all)), surface(corners) {}
  [[nodiscard]] bool meets(const Ball& ball) const {
    for (std::size_t k = 0; k < corners.size(); k += 3) {
      if (squared_distance(ball.centre, corners[k], corners[k + 1], corners[k + 2]) <=
          ball.radius_m * ball.radius_m) {
        return true;
      }
    }
    return false;
  }
};

// Objects that are closed and have none of these points in their box: they enclose none of them,
// and no other surface uses them.
std::vector<char> around_nothing(const scenes::Scene& scene, const std::vector<Vec3>& points) {
  std::vector<char> found;
  for (const scenes::Object& object : scene.objects) {
    const scenes::SurfaceHealth& surface = object.surface;
    bool alone = surface.parts > 0 && surface.open_edges == 0 && surface.non_manifold_edges == 0 &&
                 surface.mixed_edges == 0;
    scenes::Box box;
    for (std::uint32_t t = object.first_triangle;
         alone && t < object.first_triangle + object.triangle_count; ++t) {
      const scenes::Material& material = scene.materials[scene.triangles[t].material];
      alone = !material.two_sided && !material.lets_light_through();
      for (const std::uint32_t v : scene.triangles[t].vertex) box.add(scene.vertices[v]);
    }
    found.push_back(alone && std::none_of(points.begin(), points.end(),
                                          [&](const Vec3& p) {
                                            return glm::all(glm::lessThanEqual(box.low, p)) &&
                                                   glm::all(glm::lessThanEqual(p, box.high));
                                          })
                        ? 1
                        : 0);
  }
  return found;
}

class Walls {
 public:
  // around: centres of all balls of later queries.
  Walls(const scenes::Scene& scene, const std::vector<Vec3>& around) {
    const std::vector<char> left_out = around_nothing(scene, around);
    std::uint64_t triangles = 0;
    for (std::size_t k = 0; k < left_out.size(); ++k) {
      if (left_out[k] == 0) triangles += scene.objects[k].triangle_count;
    }
    base::check_room(triangles * bytes_per_triangle, scene.path.string());
    margin_m_ = scene.vertices.empty()
                    ? 0.0
                    : body_rounding * scenes::box_around(scene.vertices).diagonal();
    const ClosedParts parts = find_closed_parts(scene, left_out);
    std::vector<char> holds(parts.closed);
    for (std::uint32_t t = 0; t < parts.of.size(); ++t) {
      const scenes::Material& material = scene.materials[scene.triangles[t].material];
      if (material.passes_light_on() || material.two_sided) holds[parts.of[t]] = 0;
    }
    for (const auto& of_part :
         triangles_by_part(parts, [&](std::uint32_t part) { return holds[part] != 0; })) {
      std::vector<Vec3> corners;
      for (const std::uint32_t t : of_part) {
        for (const std::uint32_t v : scene.triangles[t].vertex) {
          corners.push_back(scene.vertices[v]);
        }
      }
      walls_.emplace_back(std::move(corners));
    }
  }

  [[nodiscard]] Ball ball(const Vec3& centre, double radius_m) const {
    return {centre, radius_m + margin_m_};
  }
  [[nodiscard]] bool keep_apart(const Ball& a, const Ball& b) const {
    return std::any_of(walls_.begin(), walls_.end(), [&](const Wall& wall) {
      return wall.surface.winding(a.centre) != wall.surface.winding(b.centre) && !wall.meets(a) &&
             !wall.meets(b);
    });
  }
  [[nodiscard]] bool keep_out_sky(const Ball& ball) const {
    return std::any_of(walls_.begin(), walls_.end(), [&](const Wall& wall) {
      return wall.surface.winding(ball.centre) != 0 && !wall.meets(ball);
    });
  }

 private:
  double margin_m_ = 0.0;
  std::vector<Wall> walls_;
};

// Radius of the lamp's bounding sphere.
double radius_of(const scenes::Lamp& lamp) {
  const auto radius = scenes::row_of(lamp.kind).radius;
  return radius == nullptr ? 0.0 : radius(lamp);
}

}  // namespace

scenes::HiddenLights hidden_lights(const scenes::Scene& scene,
                                   std::vector<const scenes::Camera*> cameras) {
  if (cameras.empty()) {
    for (const scenes::Camera& camera : scene.cameras) cameras.push_back(&camera);
  }
  scenes::HiddenLights hidden;
  hidden.lamps.assign(scene.lamps.size(), false);
  if (cameras.empty()) return hidden;
  std::vector<Vec3> around;
  for (const scenes::Camera* camera : cameras) around.push_back(camera->position);
  for (const scenes::Lamp& lamp : scene.lamps) {
    if (!lamp.is_distant()) around.push_back(lamp.position);
  }
  const Walls walls(scene, around);
  std::vector<Ball> lenses;
  for (const scenes::Camera* camera : cameras) {
    lenses.push_back(walls.ball(camera->position, 0.5 * camera->aperture_m));
  }
  const auto all = [&lenses](const auto& kept) {
    return std::all_of(lenses.begin(), lenses.end(), kept);
  };
  hidden.sky = all([&](const Ball& lens) { return walls.keep_out_sky(lens); });
  for (std::size_t k = 0; k < scene.lamps.size(); ++k) {
    hidden.lamps[k] = hidden.sky;
    if (scene.lamps[k].is_distant()) continue;
    const Ball lamp = walls.ball(scene.lamps[k].position, radius_of(scene.lamps[k]));
    hidden.lamps[k] = all([&](const Ball& lens) { return walls.keep_apart(lamp, lens); });
  }
  return hidden;
}

}  // namespace earthshine::radiosity
