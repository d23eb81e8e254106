// SPDX-License-Identifier: Apache-2.0
#include "raytrace/camera/check.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace earthshine::raytrace {
namespace {

constexpr std::size_t ray_count = 96;
// Meshes with pinholes are meant to be closed; half a body (winding 0.5) is not.
constexpr double least_winding = 0.95;

bool back_is_black(const scenes::Material& material) {
  return !material.two_sided && base::max_component(material.transmit) <= 0.0;
}

// Fibonacci points: even over the sphere, and along no axis or diagonal where edges like to lie.
Vec3 direction(std::size_t k) {
  const double z = 1.0 - (2.0 * static_cast<double>(k) + 1.0) / ray_count;
  const double phi = 2.0 * base::pi * static_cast<double>(k) / std::numbers::phi;
  const double r = std::sqrt(1.0 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

[[noreturn]] void refuse(const scenes::Scene& scene, const scenes::Camera& camera,
                         std::size_t object) {
  const std::string found = "camera \"" + camera.name + "\" is inside \"" +
                            scene.objects[object].name + "\" and sees the black backs of its faces";
  const char* allowed = "a one-sided surface is seen from its front";
  const char* remedy =
      "Move the camera out; or, if the object is a room, give it inward = true or a two_sided "
      "material";
  if (camera.where.file.empty()) {
    throw base::Error(base::Blame::Input, scene.path.string(), found, allowed, remedy);
  }
  throw base::Error(base::Blame::Input, camera.where, found, allowed, remedy);
}

}  // namespace

double winding_number(const scenes::Scene& scene, std::uint32_t object, const Vec3& point) {
  const scenes::Object& body = scene.objects[object];
  double sum = 0.0;
  for (std::uint32_t t = body.first_triangle; t < body.first_triangle + body.triangle_count; ++t) {
    const scenes::Triangle& triangle = scene.triangles[t];
    if (!back_is_black(scene.materials[triangle.material])) continue;
    const Vec3 a = scene.vertices[triangle.vertex[0]] - point;
    const Vec3 b = scene.vertices[triangle.vertex[1]] - point;
    const Vec3 c = scene.vertices[triangle.vertex[2]] - point;
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    const double top = glm::dot(a, glm::cross(b, c));
    const double bottom =
        la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
    sum += 2.0 * std::atan2(top, bottom);
  }
  return sum / (4.0 * base::pi);
}

void check_camera(const scenes::Scene& scene, const scenes::RayQuery& query,
                  const scenes::Camera& camera) {
  std::vector<std::size_t> backs(scene.objects.size(), 0);
  std::size_t all_backs = 0;
  scenes::RayPacket rays;
  scenes::HitPacket hits;
  static_assert(ray_count % scenes::RayPacket::width == 0);
  for (std::size_t first = 0; first < ray_count; first += scenes::RayPacket::width) {
    for (std::size_t k = 0; k < scenes::RayPacket::width; ++k) {
      query.set(rays, k, camera.position, direction(first + k));
    }
    query.closest(rays, scenes::RayPacket::width, hits);
    for (std::size_t k = 0; k < scenes::RayPacket::width; ++k) {
      if (hits.triangle[k] == scenes::no_triangle || hits.front[k] != 0) continue;
      const scenes::Triangle& triangle = scene.triangles[hits.triangle[k]];
      if (!back_is_black(scene.materials[triangle.material])) continue;
      ++backs[triangle.object];
      ++all_backs;
    }
  }
  if (all_backs == 0) return;
  const auto most = std::max_element(backs.begin(), backs.end());
  const auto object = static_cast<std::size_t>(most - backs.begin());
  const bool encloses =
      2 * *most >= ray_count &&
      winding_number(scene, static_cast<std::uint32_t>(object), camera.position) >= least_winding;
  if (encloses || all_backs == ray_count) refuse(scene, camera, object);
}

}  // namespace earthshine::raytrace
