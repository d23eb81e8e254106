// SPDX-License-Identifier: Apache-2.0
#include "scenes/health/doubled_faces.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "base/numbers/random.h"
#include "scenes/health/topology.h"
#include "scenes/text/message_text.h"
#include "scenes/triangle_point.h"

namespace earthshine::scenes {
namespace {

// Polygons that may share all corners with another one: groups with equal corner digests.
std::vector<Face> faces_of(const Scene& scene, std::span<const std::uint32_t> ids) {
  const auto& triangles = scene.triangles;
  Face face;
  const auto corners_from = [&](std::uint32_t first, std::uint32_t end) {
    face.corners.clear();
    for (std::uint32_t t = first; t < end; ++t) {
      for (const std::uint32_t v : triangles[t].vertex) face.corners.push_back(ids[v]);
    }
    std::sort(face.corners.begin(), face.corners.end());
    face.corners.erase(std::unique(face.corners.begin(), face.corners.end()), face.corners.end());
  };
  const auto digest_of = [&](std::uint32_t first, std::uint32_t end) {
    // A sum, independent of the first corner.
    std::uint64_t digest = 0;
    if (end == first + 1) {  // most of a large mesh
      for (const std::uint32_t v : triangles[first].vertex) digest += base::mix64(ids[v]);
    } else {
      corners_from(first, end);
      for (const std::uint32_t corner : face.corners) digest += base::mix64(corner);
    }
    return digest;
  };
  const auto each = [&](const auto& take) {
    std::size_t number = 0;
    for (std::uint32_t t = 0, end = 0; t < triangles.size(); t = end, ++number) {
      while (end < triangles.size() && triangles[end].polygon == triangles[t].polygon) ++end;
      take(number, t, end);
    }
  };
  std::vector<std::uint32_t> digests;
  each([&](std::size_t, std::uint32_t first, std::uint32_t end) {
    digests.push_back(static_cast<std::uint32_t>(digest_of(first, end) >> 32U));
  });
  // Counts 0, 1, more.
  std::vector<std::uint8_t> seen(
      std::min(std::bit_ceil(4 * digests.size() + 1), std::size_t{1} << 32U), 0);
  for (const std::uint32_t digest : digests) {
    std::uint8_t& times = seen[digest & (seen.size() - 1)];
    times = times == 0 ? 1 : 2;
  }
  std::vector<Face> faces;
  each([&](std::size_t number, std::uint32_t first, std::uint32_t end) {
    if (seen[digests[number] & (seen.size() - 1)] < 2) return;
    corners_from(first, end);
    face.first = first;
    face.count = end - first;
    faces.push_back(face);
  });
  return faces;
}

// Vector area along its normal, m^2.
Vec3 area_of(const Scene& scene, const Face& face) {
  Vec3 area{0.0};
  for (std::uint32_t t = face.first; t < face.first + face.count; ++t) {
    area += 0.5 * corners_of(scene, t).normal();
  }
  return area;
}

// Numbers of faces found between two objects (or within one).
struct Found {
  std::size_t twice = 0, back_to_back = 0, left = 0;
};

// Polygons with the same corners cover the same place if they have the same area: another order of
// the corners encloses another area.
bool same_place(const Vec3& area, const Vec3& other) {
  const double size = glm::length(area);
  return std::min(glm::length(area - other), glm::length(area + other)) <= 1e-9 * size;
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
        object.area_m2 -= 0.5 * glm::length(corners_of(scene, t).normal());
        continue;
      }
      if (triangle.polygon != polygon) ++object.polygon_count;
      polygon = triangle.polygon;
      kept.push_back(triangle);
    }
    object.triangle_count = static_cast<std::uint32_t>(kept.size()) - object.first_triangle;
  }
  scene.triangles = std::move(kept);
}

// Throws for an object all of whose faces duplicate faces of earlier objects with equal winding.
void refuse_doubles(const Scene& scene, const std::vector<std::size_t>& doubled) {
  for (std::size_t o = 0; o < doubled.size(); ++o) {
    if (doubled[o] == 0 || doubled[o] < scene.objects[o].polygon_count) continue;
    throw base::Error(base::Blame::Input, scene.path.string(),
                      fmt::format("all faces of the object {} stand at the same place in objects "
                                  "before it",
                                  in_quotes(scene.objects[o].name)),
                      "a surface is in the scene once", "Remove one of them, or move it");
  }
}

}  // namespace

DoubledFaces find_doubled_faces(const Scene& scene, std::span<const std::uint32_t> ids) {
  std::vector<Face> faces = faces_of(scene, ids);
  std::stable_sort(faces.begin(), faces.end(),
                   [](const Face& a, const Face& b) { return a.corners < b.corners; });
  DoubledFaces groups;
  for (auto begin = faces.begin(), end = begin; begin != faces.end(); begin = end) {
    while (end != faces.end() && end->corners == begin->corners) ++end;
    if (end - begin < 2) continue;
    std::vector<Face> group;
    for (auto face = begin; face != end; ++face) {
      const Triangle& triangle = scene.triangles[face->first];
      if (scene.objects[triangle.object].orient != Orient::AsIs) group.push_back(*face);
    }
    if (group.size() > 1) groups.push_back(std::move(group));
  }
  return groups;
}

bool mend_doubled_faces(Scene& scene, const DoubledFaces& doubled, Sheets& sheets,
                        const FaceParts& parts) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, Found> found;
  std::vector<std::size_t> doubles(scene.objects.size(), 0);
  std::vector<char> gone(scene.triangles.size(), 0);
  // Faces of two bodies: where bodies touch, each hides the other's face.
  const auto apart = [&](std::uint32_t a, std::uint32_t b) {
    const std::uint32_t one = parts.of[a], two = parts.of[b];
    return one != two && parts.kind[one] != FaceParts::Kind::Open &&
           parts.kind[two] != FaceParts::Kind::Open;
  };
  for (const std::vector<Face>& group : doubled) {
    // Each later face is compared with the first one at the same place.
    for (auto other = group.begin() + 1; other != group.end(); ++other) {
      const Face& face = *other;
      const Vec3 area = area_of(scene, face);
      const auto at = std::find_if(group.begin(), other, [&](const Face& f) {
        return gone[f.first] == 0 && same_place(area_of(scene, f), area);
      });
      if (at == other) continue;
      const Face& kept = *at;
      const Triangle &keeps = scene.triangles[kept.first], &goes = scene.triangles[face.first];
      const bool same_orientation = glm::dot(area_of(scene, kept), area) > 0.0;
      const bool touch = apart(kept.first, face.first);
      if (!same_orientation && touch) continue;
      Found& count = found[{keeps.object, goes.object}];
      const bool same = sheets.alike(keeps.material, goes.material);
      if (same && same_orientation && keeps.object != goes.object) ++doubles[goes.object];
      const bool sheet = same && !same_orientation && keeps.object == goes.object &&
                         !sheets.is_glass(keeps.material);
      if (!sheet && !(same && same_orientation && !touch)) {
        if (sheets.is_glass(keeps.material) || sheets.is_glass(goes.material)) ++count.left;
        continue;
      }
      ++(same_orientation ? count.twice : count.back_to_back);
      for (std::uint32_t t = 0; t < face.count; ++t) gone[face.first + t] = 1;
      if (!sheet && !scene.materials[goes.material].two_sided) continue;
      const std::uint32_t both = sheets.of(keeps.material);
      for (std::uint32_t t = 0; t < kept.count; ++t)
        scene.triangles[kept.first + t].material = both;
    }
  }
  if (found.empty()) return false;
  refuse_doubles(scene, doubles);
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
    if (count.left > 0) {
      scene.warnings.push_back(fmt::format(
          "{}: {} exactly on another, one of the two is glass: what is opaque is seen, of two of "
          "glass either; remove one of each, move it by some 0.1 mm, or say orient = \"as-is\" "
          "where that is meant",
          place, count.left == 1 ? "a face lies" : fmt::format("{} faces lie", count.left)));
    }
  }
  const bool any = std::find(gone.begin(), gone.end(), 1) != gone.end();
  if (any) drop(scene, gone);
  return any;
}

}  // namespace earthshine::scenes
