// SPDX-License-Identifier: Apache-2.0
#include "scenes/coincident_faces.h"

#include <algorithm>

#include "scenes/triangle_point.h"

namespace earthshine::scenes {
namespace {

constexpr std::uint32_t no_glass = 0xFFFFFFFFU;

bool holds(double u, double v) { return u >= 0.0 && v >= 0.0 && u + v <= 1.0; }

}  // namespace

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
  const auto material = [&](std::uint32_t t) -> const Material& {
    return scene.materials[scene.triangles[t].material];
  };
  // The glass face of a pair, if one is glass: the other face covers both of its sides.
  const auto glass_of = [&](const FacePair& pair) {
    if (material(pair.a).lets_light_through()) return pair.a;
    return material(pair.b).lets_light_through() ? pair.b : no_glass;
  };
  for (const FacePair& pair : scene.coincident) {
    const std::uint32_t glass = glass_of(pair);
    for (const std::uint32_t t : {pair.a, pair.b}) {
      face_of(t).end += glass == no_glass ? 1 : glass == t ? 2 : 0;
    }
  }
  std::uint32_t first = 0;
  for (Face& face : faces_) {
    face.first = first;
    first += face.end;
    face.end = face.first;
  }
  others_.resize(first);
  const auto lay = [&](std::uint32_t other, std::uint32_t under, bool before, bool hides_both) {
    const std::uint32_t number = number_[other];
    Face& on = faces_[number_[under]];
    others_[on.end++] = {number, before, hides_both};
    on.covered[before ? 0 : 1] = true;
  };
  for (const FacePair& pair : scene.coincident) {
    if (const std::uint32_t glass = glass_of(pair); glass != no_glass) {
      const std::uint32_t over = glass == pair.a ? pair.b : pair.a;
      for (const bool front : {true, false}) lay(over, glass, front, false);
      continue;
    }
    const bool both = pair.a_before_b && pair.b_before_a && !material(pair.a).two_sided &&
                      !material(pair.b).two_sided;
    lay(pair.b, pair.a, pair.b_before_a, both);
    lay(pair.a, pair.b, pair.a_before_b, both);
  }
}

std::optional<CoincidentFaces::Met> CoincidentFaces::first_met(std::uint32_t triangle,
                                                               const Vec3& at,
                                                               const Vec3& direction) const {
  if (number_[triangle] == none) return std::nullopt;
  // Each step goes to a face nearer to the light's origin.
  const auto step = [&](std::uint32_t from) -> std::optional<Met> {
    const Face& now = faces_[number_[from]];
    const bool front = glm::dot(direction, now.normal) < 0.0;
    for (std::uint32_t k = now.first; k < now.end; ++k) {
      const Other& other = others_[k];
      if (other.hides_both || other.before != front) continue;
      const Face& face = faces_[other.face];
      const auto [u, v] = barycentric(at, face.corner, face.edge1, face.edge2);
      if (!holds(u, v)) continue;
      return Met{face.triangle, u, v, glm::dot(direction, face.normal) < 0.0};
    }
    return std::nullopt;
  };
  std::optional<Met> met = step(triangle);
  if (!met) return std::nullopt;  // almost every ray: no path is stored
  std::vector<Met> path{{triangle, 0.0, 0.0, false}};
  for (; met; met = step(path.back().triangle)) {
    const auto seen = std::find_if(path.begin(), path.end(), [&](const Met& before) {
      return before.triangle == met->triangle;
    });
    if (seen != path.end()) {
      // A cycle, as between the two sides of one sheet and another sheet. One of its faces must be
      // hit, or no light would be. The last one in the scene is the same for every caller.
      *seen = *met;
      path.back() = *std::max_element(
          seen, path.end(), [](const Met& a, const Met& b) { return a.triangle < b.triangle; });
      break;
    }
    path.push_back(*met);
  }
  return path.back().triangle == triangle ? std::nullopt : std::optional(path.back());
}

bool CoincidentFaces::covers(std::uint32_t triangle, bool front, const Vec3& at) const {
  if (!is_covered(triangle, front)) return false;
  const Face& face = faces_[number_[triangle]];
  const auto [u, v] = barycentric(at, face.corner, face.edge1, face.edge2);
  if (!holds(u, v)) return false;  // outside it, as on the other half of a parallelogram
  const bool between = std::any_of(
      others_.begin() + face.first, others_.begin() + face.end, [&](const Other& other) {
        if (!other.hides_both || other.before != front) return false;
        const Face& on = faces_[other.face];
        const auto [s, t] = barycentric(at, on.corner, on.edge1, on.edge2);
        return holds(s, t);
      });
  return between || first_met(triangle, at, front ? -face.normal : face.normal).has_value();
}

}  // namespace earthshine::scenes
