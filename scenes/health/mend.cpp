// SPDX-License-Identifier: Apache-2.0
#include "scenes/health/mend.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "scenes/health/doubled_faces.h"
#include "scenes/health/sheets.h"
#include "scenes/health/topology.h"
#include "scenes/text/message_text.h"

namespace earthshine::scenes {
namespace {

class Orienter {
 public:
  explicit Orienter(Scene& scene) : scene_(scene), ids_(welded(scene.vertices)) {}

  void orient(std::size_t number) {
    const Object& object = scene_.objects[number];
    if (object.orient == Orient::AsIs || object.orient == Orient::TwoSided) return;
    const bool told = object.orient == Orient::Outward;
    std::vector<SurfacePart> parts = surface_parts(scene_, object, ids_);
    std::size_t bodies = 0, faces = 0, left = 0, twisted = 0;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      SurfacePart& part = parts[p];
      if (!part.orientable) {
        ++twisted;
        continue;
      }
      if (!part.closed() && !told) {
        left += part.mixed_edges;
        continue;
      }
      // An open part is outward where it has the volume of its faces' pyramids about the middle.
      const bool inward = (part.closed() ? part.volume_m3 : cup_volume(part)) < 0.0;
      if (!told && part.mixed_edges == 0 && (!inward || is_room(number, parts, p))) continue;
      const bool turn_all = inward && (told || !is_room(number, parts, p));
      std::size_t turned = 0;
      for (std::size_t k = 0; k < part.triangles.size(); ++k) {
        if ((part.turned[k] != 0) == turn_all) continue;
        auto& vertex = scene_.triangles[part.triangles[k]].vertex;
        std::swap(vertex[1], vertex[2]);
        ++turned;
      }
      keep_parallelograms(part, turn_all);
      if (turned == part.triangles.size())
        ++bodies;
      else
        faces += turned;
    }
    say(object, bodies, faces, left, twisted);
  }

 private:
  // (0,1,2), (0,2,3) of a parallelogram have become (0,2,1), (0,3,2), and stand the other way
  // about.
  void keep_parallelograms(const SurfacePart& part, bool turn_all) {
    const auto is_turned = [&](std::size_t k) { return (part.turned[k] != 0) != turn_all; };
    auto& triangles = scene_.triangles;
    for (std::size_t k = 0; k + 1 < part.triangles.size(); ++k) {
      const std::uint32_t t = part.triangles[k];
      const auto same = [&](std::uint32_t other) {
        return other < triangles.size() && triangles[other].polygon == triangles[t].polygon;
      };
      if (!is_turned(k) || !is_turned(k + 1) || part.triangles[k + 1] != t + 1) continue;
      if (same(t + 1) && !same(t + 2) && !(t > 0 && same(t - 1))) {
        std::swap(triangles[t], triangles[t + 1]);
      }
    }
  }

  void say(const Object& object, std::size_t bodies, std::size_t faces, std::size_t left,
           std::size_t twisted) {
    const std::string name = in_quotes(object.name);
    auto& warnings = scene_.warnings;
    if (bodies > 0) {
      warnings.push_back(fmt::format(
          "object {}: {} inside out, turned outward; orient = \"as-is\" leaves its faces as they "
          "are",
          name, bodies == 1 ? "a surface was" : fmt::format("{} surfaces were", bodies)));
    }
    if (faces > 0) {
      warnings.push_back(
          fmt::format("object {}: {} of {} triangles were wound against their neighbours, turned; "
                      "orient = \"as-is\" leaves them",
                      name, faces, object.triangle_count));
    }
    if (left > 0) {
      warnings.push_back(fmt::format(
          "object {}: at {} edges of open surfaces the faces on both sides are wound against each "
          "other; backs are black. Say orient = \"outward\" or \"two-sided\", or \"as-is\"",
          name, left));
    }
    if (twisted > 0) {
      warnings.push_back(fmt::format(
          "object {}: {} have no two sides (like a Moebius strip); backs are black. Say "
          "orient = \"two-sided\", or \"as-is\"",
          name, twisted == 1 ? "a surface does" : fmt::format("{} surfaces", twisted)));
    }
  }

  [[nodiscard]] double cup_volume(const SurfacePart& part) const {
    const Vec3 middle = 0.5 * (part.low + part.high);
    double volume = 0.0;
    for (std::size_t k = 0; k < part.triangles.size(); ++k) {
      const auto& v = scene_.triangles[part.triangles[k]].vertex;
      const Vec3 a = scene_.vertices[v[0]] - middle, b = scene_.vertices[v[1]] - middle,
                 c = scene_.vertices[v[2]] - middle;
      volume += (part.turned[k] != 0 ? -1.0 : 1.0) * glm::dot(a, glm::cross(b, c));
    }
    return volume;
  }

  // Whether the inside of a closed part is what is looked at: something stands in it, or it is a
  // cavity of a body.
  [[nodiscard]] bool is_room(std::size_t number, const std::vector<SurfacePart>& parts,
                             std::size_t p) const {
    const SurfacePart& part = parts[p];
    const auto holds = [&](const Vec3& point) { return surrounds(scene_, part, point); };
    for (const Camera& camera : scene_.cameras) {
      if (holds(camera.position)) return true;
    }
    for (const Lamp& lamp : scene_.lamps) {
      if (holds(lamp.position)) return true;
    }
    for (std::size_t o = 0; o < scene_.objects.size(); ++o) {
      if (o != number && holds(middle_of(scene_.objects[o].first_triangle))) return true;
    }
    for (std::size_t q = 0; q < parts.size(); ++q) {
      if (q == p) continue;
      if (holds(middle_of(parts[q].triangles.front()))) return true;
      if (parts[q].closed() && surrounds(scene_, parts[q], middle_of(part.triangles.front()))) {
        return true;
      }
    }
    return false;
  }

  [[nodiscard]] Vec3 middle_of(std::uint32_t triangle) const {
    const auto& v = scene_.triangles[triangle].vertex;
    return (scene_.vertices[v[0]] + scene_.vertices[v[1]] + scene_.vertices[v[2]]) / 3.0;
  }

  Scene& scene_;
  std::vector<std::uint32_t> ids_;
};

}  // namespace

void mend_surfaces(Scene& scene) {
  Sheets sheets(scene);
  for (const Object& object : scene.objects) {
    if (object.orient != Orient::TwoSided) continue;
    for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
      Triangle& triangle = scene.triangles[object.first_triangle + t];
      triangle.material = sheets.of(triangle.material);
    }
  }
  mend_doubled_faces(scene, sheets);
  Orienter orienter(scene);
  for (std::size_t o = 0; o < scene.objects.size(); ++o) orienter.orient(o);
}

std::vector<SurfaceHealth> surface_health(const Scene& scene) {
  const std::vector<std::uint32_t> ids = welded(scene.vertices);
  std::vector<SurfaceHealth> all;
  for (const Object& object : scene.objects) {
    SurfaceHealth health;
    for (const SurfacePart& part : surface_parts(scene, object, ids)) {
      ++health.parts;
      health.open_edges += part.open_edges;
      health.non_manifold_edges += part.crowded_edges;
      health.mixed_edges += part.mixed_edges;
      if (!part.closed()) continue;
      ++health.closed_parts;
      if (part.volume_m3 < 0.0) ++health.inward_parts;
    }
    all.push_back(health);
  }
  return all;
}

}  // namespace earthshine::scenes
