// SPDX-License-Identifier: Apache-2.0
#include "scenes/specular_paths.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "scenes/ray_query.h"
#include "scenes/triangle_point.h"

namespace earthshine::scenes {
namespace {

constexpr std::size_t most_mirrors = 32;
constexpr double least_part = 0.02;  // of all reflecting area
// Triangles share a plane if their normals and distances agree within these tolerances. The image
// is off by at most twice the normal tolerance times the distance.
constexpr double same_normal = 1e-4;
constexpr double same_distance = 1e-5;  // of the object's extent

// One side of a plane, while its area is summed.
struct Plane {
  Vec3 normal{0.0}, point{0.0};
  Vec3 low{0.0}, high{0.0};
  double reflecting = 0.0;  // area times share
  std::vector<std::uint32_t> triangles;
};

class Planes {
 public:
  explicit Planes(const Scene& scene) : scene_(scene), low_(box_around(scene.vertices).low) {}

  // side: 1 the front, -1 the back.
  void add(std::uint32_t triangle, double side, double share) {
    const auto& v = scene_.triangles[triangle].vertex;
    const Vec3 normal = side * triangle_normal(scene_, triangle);
    const Vec3& corner = scene_.vertices[v[0]];
    find_step(scene_.triangles[triangle].object);
    // Rounding may put two halves of a square into adjacent cells.
    std::size_t& at = last_[side > 0.0 ? 0 : 1];
    if (at >= planes.size() || !agrees(planes[at], normal, corner)) {
      const auto [entry, fresh] = known_.emplace(key_of(normal, corner), planes.size());
      at = entry->second;
      if (fresh) planes.push_back({normal, corner, corner, corner, 0.0, {}});
    }
    Plane& plane = planes[at];
    plane.reflecting += share * triangle_area(scene_, triangle);
    plane.triangles.push_back(triangle);
    for (const std::uint32_t k : v) {
      plane.low = glm::min(plane.low, scene_.vertices[k]);
      plane.high = glm::max(plane.high, scene_.vertices[k]);
    }
  }

  std::vector<Plane> planes;

 private:
  using Key = std::array<std::int64_t, 5>;
  [[nodiscard]] Key key_of(const Vec3& normal, const Vec3& corner) const {
    const Vec3 n = normal / same_normal;
    return {std::llround(n.x), std::llround(n.y), std::llround(n.z), step_exponent_,
            std::llround(glm::dot(normal, corner - low_) / step_m_)};
  }
  // A power of two, so that objects of similar size share planes.
  void find_step(std::uint32_t object) {
    if (object == object_) return;
    object_ = object;
    const Object& of = scene_.objects[object];
    Box box;
    for (std::uint32_t t = 0; t < of.triangle_count; ++t) {
      const Corners p = corners_of(scene_, of.first_triangle + t);
      box.add(p.a), box.add(p.b), box.add(p.c);
    }
    const double step_m = same_distance * std::max(box.diagonal(), 1e-6);
    step_exponent_ = std::lround(std::log2(step_m));
    step_m_ = std::exp2(static_cast<double>(step_exponent_));
  }
  [[nodiscard]] bool agrees(const Plane& plane, const Vec3& normal, const Vec3& corner) const {
    return glm::length(plane.normal - normal) < same_normal &&
           std::abs(glm::dot(plane.normal, corner - plane.point)) < step_m_;
  }

  const Scene& scene_;
  Vec3 low_;
  double step_m_ = 0.0;  // of object_
  std::int64_t step_exponent_ = 0;
  std::uint32_t object_ = ~0U;
  std::map<Key, std::size_t> known_;
  std::size_t last_[2] = {~std::size_t{0}, ~std::size_t{0}};  // plane of the previous triangle
};

}  // namespace

bool is_straight_glass(const Material& material) {
  return base::max_component(material.transmit) > 0.0 &&
         (material.two_sided || material.ior == 1.0);
}

std::optional<Vec3> straight_through(const Scene& scene, std::uint32_t triangle,
                                     const Vec3& position, const Vec3& direction, double offset_m) {
  constexpr double least_cosine = 0.01;
  const Corners corners = corners_of(scene, triangle);
  const Vec3 normal = corners.normal();  // its length is twice the area
  const double area2 = glm::length(normal);
  const double cosine = std::abs(glm::dot(direction, normal)) / area2;
  if (!(cosine > least_cosine)) return std::nullopt;
  const Vec3 behind = position + (offset_m / cosine) * direction;
  const std::array<Vec3, 3> corner = {corners.a, corners.b, corners.c};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3& from = corner[k];
    if (glm::dot(glm::cross(corner[(k + 1) % 3] - from, behind - from), normal) <= 0.0) {
      return std::nullopt;
    }
  }
  return behind;
}

SpecularPaths::SpecularPaths(const Scene& scene, const SurfaceOffsets& offsets) {
  const auto sends_on = [](const Material& material) {
    return is_straight_glass(material) || base::max_component(material.mirror) > 0.0;
  };
  if (std::none_of(scene.materials.begin(), scene.materials.end(), sends_on)) return;
  number_.assign(scene.triangles.size(), no_mirror);
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    const Material& material = scene.materials[scene.triangles[t].material];
    if (!sends_on(material)) continue;
    number_[t] = static_cast<std::uint32_t>(faces_.size());
    const Vec3 normal = triangle_normal(scene, t);
    faces_.push_back({normal,
                      glm::dot(normal, corners_of(scene, t).a),
                      is_straight_glass(material) ? material.transmit : Rgb(0.0),
                      material.mirror,
                      {no_mirror, no_mirror}});
  }
  if (!faces_.empty()) find_mirrors(scene, offsets);
}

void SpecularPaths::find_mirrors(const Scene& scene, const SurfaceOffsets& offsets) {
  Planes found(scene);
  double all = 0.0;
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    const Material& material = scene.materials[scene.triangles[t].material];
    const double share = base::luminance(material.mirror);
    if (share <= 0.0) continue;
    found.add(t, 1.0, share);
    const bool both = material.two_sided || is_straight_glass(material);
    if (both) found.add(t, -1.0, share);
    all += (both ? 2.0 : 1.0) * share * triangle_area(scene, t);
  }
  std::vector<Plane>& planes = found.planes;
  std::stable_sort(planes.begin(), planes.end(),
                   [](const Plane& a, const Plane& b) { return a.reflecting > b.reflecting; });
  for (const Plane& plane : planes) {
    if (mirrors_.size() == most_mirrors || plane.reflecting < least_part * all) break;
    double offset_m = 0.0;
    for (const std::uint32_t t : plane.triangles) {
      offset_m = std::max(offset_m, offsets.of(t));
      Face& face = faces_[number_[t]];
      face.mirror[glm::dot(face.normal, plane.normal) > 0.0 ? 0 : 1] =
          static_cast<std::uint32_t>(mirrors_.size());
    }
    mirrors_.push_back({plane.point, plane.normal, 0.5 * (plane.low + plane.high),
                        0.5 * glm::length(plane.high - plane.low), offset_m});
  }
}

Rgb SpecularPaths::kept(std::uint32_t triangle, bool front) const {
  const Face* at = face(triangle);
  if (at == nullptr) return Rgb(1.0);
  const Rgb thrown = at->mirror[front ? 0 : 1] != no_mirror ? at->reflected : Rgb(0.0);
  return glm::max(Rgb(0.0), Rgb(1.0) - at->through - thrown);
}

}  // namespace earthshine::scenes
