// SPDX-License-Identifier: Apache-2.0
#include "scenes/coincident_faces.h"

#include <algorithm>

#include "scenes/triangle_point.h"

namespace earthshine::scenes {

CoincidentFaces::CoincidentFaces(const Scene& scene) {
  if (scene.coincident.empty()) return;
  number_.assign(scene.triangles.size(), none);
  const auto face_of = [&](std::uint32_t triangle) -> Face& {
    std::uint32_t& number = number_[triangle];
    if (number == none) {
      number = static_cast<std::uint32_t>(faces_.size());
      const auto& v = scene.triangles[triangle].vertex;
      const Vec3 corner = scene.vertices[v[0]];
      const Vec3 edge1 = scene.vertices[v[1]] - corner, edge2 = scene.vertices[v[2]] - corner;
      faces_.push_back({triangle, corner, edge1, edge2, glm::cross(edge1, edge2)});
    }
    return faces_[number];
  };
  for (const FacePair& pair : scene.coincident) {
    ++face_of(pair.a).end;
    ++face_of(pair.b).end;
  }
  std::uint32_t first = 0;
  for (Face& face : faces_) {
    face.first = first;
    first += face.end;
    face.end = face.first;
  }
  others_.resize(first);
  const auto lay = [&](std::uint32_t other, Face& on, bool before, bool hides_both) {
    others_[on.end++] = {number_[other], before, hides_both};
    on.covered[before ? 0 : 1] = true;
  };
  for (const FacePair& pair : scene.coincident) {
    const auto sheet = [&](std::uint32_t t) {
      return scene.materials[scene.triangles[t].material].two_sided;
    };
    const bool both = pair.a_before_b && pair.b_before_a && !sheet(pair.a) && !sheet(pair.b);
    lay(pair.b, face_of(pair.a), pair.b_before_a, both);
    lay(pair.a, face_of(pair.b), pair.a_before_b, both);
  }
}

std::optional<CoincidentFaces::Met> CoincidentFaces::first_met(std::uint32_t triangle,
                                                               const Vec3& at,
                                                               const Vec3& direction) const {
  std::uint32_t now = number_[triangle];
  if (now == none) return std::nullopt;
  std::optional<Met> met;
  // Each step goes to a face nearer to where the light comes from; more than all of them it cannot.
  for (std::size_t steps = 0; steps < faces_.size(); ++steps) {
    const bool front = glm::dot(direction, faces_[now].normal) < 0.0;
    const auto next =
        std::find_if(others_.begin() + faces_[now].first, others_.begin() + faces_[now].end,
                     [&](const Other& other) {
                       if (other.hides_both || other.before != front) return false;
                       const Face& face = faces_[other.face];
                       const auto [u, v] = barycentric(at, face.corner, face.edge1, face.edge2);
                       if (u < 0.0 || v < 0.0 || u + v > 1.0) return false;
                       met = Met{face.triangle, u, v, glm::dot(direction, face.normal) < 0.0};
                       return true;
                     });
    if (next == others_.begin() + faces_[now].end) break;
    now = next->face;
  }
  return met;
}

bool CoincidentFaces::covers(std::uint32_t triangle, bool front, const Vec3& at) const {
  if (!is_covered(triangle, front)) return false;
  const Face& face = faces_[number_[triangle]];
  return std::any_of(others_.begin() + face.first, others_.begin() + face.end,
                     [&](const Other& other) {
                       if (other.before != front) return false;
                       const Face& on = faces_[other.face];
                       const auto [u, v] = barycentric(at, on.corner, on.edge1, on.edge2);
                       return u >= 0.0 && v >= 0.0 && u + v <= 1.0;
                     });
}

}  // namespace earthshine::scenes
