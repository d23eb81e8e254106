// SPDX-License-Identifier: Apache-2.0
#include "scenes/health/doubled_faces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "scenes/health/topology.h"
#include "scenes/text/message_text.h"

namespace earthshine::scenes {
namespace {

// The triangles of a polygon of the file; they follow each other in the scene.
struct Face {
  std::uint32_t first = 0, count = 0;
  std::vector<std::uint32_t> corners;  // welded, ascending, each once
  Vec3 area{0.0};                      // m^2, along its normal
};

std::vector<Face> faces_of(const Scene& scene) {
  const std::vector<std::uint32_t> ids = welded(scene.vertices);
  std::vector<Face> faces;
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    const Triangle& triangle = scene.triangles[t];
    if (t == 0 || triangle.polygon != scene.triangles[t - 1].polygon)
      faces.push_back({t, 0, {}, {}});
    Face& face = faces.back();
    ++face.count;
    const Vec3 a = scene.vertices[triangle.vertex[0]];
    face.area += 0.5 * glm::cross(scene.vertices[triangle.vertex[1]] - a,
                                  scene.vertices[triangle.vertex[2]] - a);
    for (const std::uint32_t v : triangle.vertex) face.corners.push_back(ids[v]);
  }
  for (Face& face : faces) {
    std::sort(face.corners.begin(), face.corners.end());
    face.corners.erase(std::unique(face.corners.begin(), face.corners.end()), face.corners.end());
  }
  return faces;
}

// Which bodies faces belong to. Only asked about faces that lie on others, so found object by
// object.
class Bodies {
 public:
  explicit Bodies(const Scene& scene) : scene_(scene), ids_(welded(scene.vertices)) {}

  // Whether two faces turned against each other are where two bodies touch, each hiding the
  // other's. A sheet with both windings is closed too, but has no volume.
  [[nodiscard]] bool touch(std::uint32_t triangle, std::uint32_t other) {
    const SurfacePart *one = body_of(triangle), *two = body_of(other);
    return one != nullptr && two != nullptr && one != two;
  }

 private:
  [[nodiscard]] const SurfacePart* body_of(std::uint32_t triangle) {
    const std::uint32_t object = scene_.triangles[triangle].object;
    const auto [entry, fresh] = parts_.try_emplace(object);
    if (fresh) entry->second = surface_parts(scene_, scene_.objects[object], ids_);
    for (const SurfacePart& part : entry->second) {
      if (!std::binary_search(part.triangles.begin(), part.triangles.end(), triangle)) continue;
      const double edge = glm::length(part.high - part.low);
      return part.closed() && std::abs(part.volume_m3) > 1e-9 * edge * edge * edge ? &part
                                                                                   : nullptr;
    }
    return nullptr;
  }

  const Scene& scene_;
  std::vector<std::uint32_t> ids_;
  std::map<std::uint32_t, std::vector<SurfacePart>> parts_;
};

// What was found between two objects (or within one).
struct Found {
  std::size_t twice = 0, back_to_back = 0, unlike = 0;
};

// Two polygons of the same corners cover the same place if they have the same area: corners in
// another order enclose another one.
bool same_place(const Face& a, const Face& b) {
  const double size = glm::length(a.area);
  return std::min(glm::length(a.area - b.area), glm::length(a.area + b.area)) <= 1e-9 * size;
}

std::string where(const Scene& scene, std::uint32_t kept, std::uint32_t other) {
  const std::string name = in_quotes(scene.objects[other].name);
  return kept == other
             ? "object " + name
             : fmt::format("objects {} and {}", in_quotes(scene.objects[kept].name), name);
}

std::string faces_text(std::size_t count) {
  return count == 1 ? "a face" : fmt::format("{} faces", count);
}

void drop(Scene& scene, const std::vector<char>& gone) {
  std::vector<Triangle> kept;
  kept.reserve(scene.triangles.size());
  for (Object& object : scene.objects) {
    const std::uint32_t first = object.first_triangle, end = first + object.triangle_count;
    object.first_triangle = static_cast<std::uint32_t>(kept.size());
    std::uint32_t polygon = ~0U;
    object.polygon_count = 0;
    for (std::uint32_t t = first; t < end; ++t) {
      const Triangle& triangle = scene.triangles[t];
      if (gone[t] != 0) {
        const Vec3 a = scene.vertices[triangle.vertex[0]];
        object.area_m2 -= 0.5 * glm::length(glm::cross(scene.vertices[triangle.vertex[1]] - a,
                                                       scene.vertices[triangle.vertex[2]] - a));
        continue;
      }
      if (triangle.polygon != polygon) ++object.polygon_count;
      polygon = triangle.polygon;
      kept.push_back(triangle);
    }
    object.triangle_count = static_cast<std::uint32_t>(kept.size()) - object.first_triangle;
    if (object.triangle_count > 0) continue;
    throw base::Error(base::Blame::Input, scene.path.string(),
                      fmt::format("all faces of the object {} stand at the same place in objects "
                                  "before it",
                                  in_quotes(object.name)),
                      "a surface is in the scene once", "Remove one of them, or move it");
  }
  scene.triangles = std::move(kept);
}

}  // namespace

void mend_doubled_faces(Scene& scene, Sheets& sheets) {
  const std::vector<Face> faces = faces_of(scene);
  std::vector<std::uint32_t> order(faces.size());
  for (std::uint32_t f = 0; f < order.size(); ++f) order[f] = f;
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::tie(faces[a].corners, a) < std::tie(faces[b].corners, b);
  });
  std::map<std::pair<std::uint32_t, std::uint32_t>, Found> found;
  std::vector<char> gone(scene.triangles.size(), 0);
  std::optional<Bodies> bodies;
  bool any = false;
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    while (end < order.size() && faces[order[end]].corners == faces[order[begin]].corners) ++end;
    for (std::size_t k = begin; k < end; ++k) {
      const Face& kept = faces[order[k]];
      if (gone[kept.first] != 0) continue;
      for (std::size_t other = k + 1; other < end; ++other) {
        const Face& face = faces[order[other]];
        if (gone[face.first] != 0 || !same_place(kept, face)) continue;
        const bool alike = glm::dot(kept.area, face.area) > 0.0;
        if (!bodies) bodies.emplace(scene);
        if (!alike && bodies->touch(kept.first, face.first)) continue;
        const Triangle &keeps = scene.triangles[kept.first], &goes = scene.triangles[face.first];
        Found& count = found[{keeps.object, goes.object}];
        const std::uint32_t sheet = keeps.material;
        const bool same = sheet == goes.material ||
                          (scene.materials[sheet].two_sided && sheets.of(goes.material) == sheet);
        const bool glass = base::max_component(scene.materials[sheet].transmit) > 0.0;
        if (!same || (!alike && glass)) {
          ++count.unlike;
          continue;
        }
        ++(alike ? count.twice : count.back_to_back);
        for (std::uint32_t t = 0; t < face.count; ++t) gone[face.first + t] = 1;
        any = true;
        if (alike) continue;
        const std::uint32_t both = sheets.of(sheet);
        for (std::uint32_t t = 0; t < kept.count; ++t) {
          scene.triangles[kept.first + t].material = both;
        }
      }
    }
  }
  for (const auto& [objects, count] : found) {
    const std::string place = where(scene, objects.first, objects.second);
    if (count.twice > 0) {
      scene.warnings.push_back(
          fmt::format("{}: {} stood twice at the same place; one of each is kept", place,
                      faces_text(count.twice)));
    }
    if (count.back_to_back > 0) {
      scene.warnings.push_back(
          fmt::format("{}: {} stood back to back with another; each pair is one two-sided sheet",
                      place, faces_text(count.back_to_back)));
    }
    if (count.unlike > 0) {
      scene.warnings.push_back(
          fmt::format("{}: {} lie exactly on another of another material, and which is seen is "
                      "undecided; remove one of each, or move it by some 0.1 mm",
                      place, faces_text(count.unlike)));
    }
  }
  if (any) drop(scene, gone);
}

}  // namespace earthshine::scenes
