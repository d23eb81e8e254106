// SPDX-License-Identifier: Apache-2.0
#include "scenes/surface_offset.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"

namespace earthshine::scenes {
namespace {

constexpr double unit_roundoff = 0x1p-24;  // of single precision
constexpr double safety = 2.0;
constexpr double double_rounding = 0x1p-50;
// Share of a triangle's extent: lifts rays off a plane through the centre, where no rounding
// occurs.
constexpr double least_share = 1e-12;
constexpr double contact_share = 1e-5, most_contact_m = 2e-5;

Vec3 extent_of(const Corners& p) {
  return glm::max(p.a, glm::max(p.b, p.c)) - glm::min(p.a, glm::min(p.b, p.c));
}

// Terms of one component of a cross product.
double products(const Vec3& a, const Vec3& b, int i) {
  const int j = (i + 1) % 3, k = (i + 2) % 3;
  return std::abs(a[j] * b[k]) + std::abs(a[k] * b[j]);
}

// An instance's coordinates are rotated in single precision: the error has no preferred axis.
double instance_offset_m(const Corners& p) {
  const double away = std::max({glm::length(p.a), glm::length(p.b), glm::length(p.c)});
  return safety * unit_roundoff * (6.0 * away + 8.0 * glm::length(extent_of(p)));
}

struct Weighted {
  double at, weight;
};

double weighted_median(std::vector<Weighted>& values) {
  std::sort(values.begin(), values.end(),
            [](const Weighted& a, const Weighted& b) { return a.at < b.at; });
  double all = 0.0, sum = 0.0;
  for (const Weighted& value : values) all += value.weight;
  for (const Weighted& value : values) {
    sum += value.weight;
    if (sum >= 0.5 * all) return value.at;
  }
  return 0.0;
}

// Not inlined: inlined, GCC 12 drops the rounding of components that it vectorises.
[[gnu::noinline]] float in_single(double x) { return static_cast<float>(x); }

}  // namespace

double rounding_offset_m(const Corners& p) {
  const Vec3 extent = extent_of(p);
  const Vec3 most = glm::max(glm::abs(p.a), glm::max(glm::abs(p.b), glm::abs(p.c)));
  const Vec3 normal = p.normal();
  const double area2 = glm::length(normal);
  const double least = least_share * glm::length(extent);
  if (!(area2 > 0.0)) return least;
  double error = 0.0;
  for (int i = 0; i < 3; ++i) {
    // Corners and origin are rounded to single precision, half a unit in the last place each. The
    // differences, products and sums of the distance are rounded by as much of the triangle's
    // extent.
    error += std::abs(normal[i]) / area2 * (2.0 * most[i] + 6.0 * extent[i]);
    // The normal is a cross product of two edges; Embree uses the two with the smaller terms.
    const double terms =
        std::min(products(p.b - p.a, p.c - p.a, i), products(p.c - p.b, p.c - p.a, i));
    error += 2.0 * terms / area2 * extent[i];
  }
  return std::max(least, safety * unit_roundoff * error);
}

// Weighted median of the objects' positions. Small objects near a camera have the largest weights:
// rounding errors are small where they would be visible.
Vec3 centre_of_detail(const Scene& scene) {
  // By the triangles' own indices: a scene may be a subset of another one, with all of its objects.
  std::vector<Box> boxes;
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    const std::uint32_t object = scene.triangles[t].object;
    if (object >= boxes.size()) boxes.resize(object + std::size_t{1});
    const Corners p = corners_of(scene, t);
    boxes[object].add(p.a), boxes[object].add(p.b), boxes[object].add(p.c);
  }
  std::array<std::vector<Weighted>, 3> values;
  for (const Box& box : boxes) {
    if (!(box.low.x <= box.high.x)) continue;
    const double size = box.diagonal();
    double weight = scene.cameras.empty() ? 1.0 / size : 0.0;
    for (const Camera& camera : scene.cameras) {
      const Vec3 nearest = glm::clamp(camera.position, box.low, box.high);
      weight = std::max(weight, 1.0 / (size * (glm::length(camera.position - nearest) + size)));
    }
    for (int axis = 0; axis < 3; ++axis) {
      values[static_cast<std::size_t>(axis)].push_back({box.middle()[axis], weight});
    }
  }
  Vec3 centre;
  for (int axis = 0; axis < 3; ++axis) {
    centre[axis] = double(in_single(weighted_median(values[static_cast<std::size_t>(axis)])));
  }
  return centre;
}

double surface_offset_m(const Scene& scene, std::uint32_t triangle, const Vec3& centre) {
  const Corners in_scene = corners_of(scene, triangle), p = in_scene.seen_from(centre);
  const std::uint32_t object = scene.triangles[triangle].object;
  const bool placed = object < scene.objects.size() && scene.objects[object].instance;
  // Points are offset in scene coordinates, in double precision.
  const Vec3 far =
      glm::max(glm::abs(in_scene.a), glm::max(glm::abs(in_scene.b), glm::abs(in_scene.c)));
  const double least = double_rounding * std::max({far.x, far.y, far.z});
  return std::max({least, placed ? instance_offset_m(p) : 0.0, rounding_offset_m(p)});
}

SurfaceOffsets::SurfaceOffsets(const Scene& scene, const std::optional<Vec3>& centre) {
  if (scene.triangles.empty()) return;
  centre_ = centre ? *centre : centre_of_detail(scene);
  offset_m_.resize(scene.triangles.size());
  contact_m_.resize(scene.triangles.size());
  base::parallel_chunks(scene.triangles.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const auto triangle = static_cast<std::uint32_t>(t);
      const double offset = surface_offset_m(scene, triangle, centre_),
                   size = glm::length(extent_of(corners_of(scene, triangle)));
      offset_m_[t] = static_cast<float>(offset);
      contact_m_[t] =
          static_cast<float>(std::max(offset, std::min(most_contact_m, contact_share * size)));
    }
  });
}

double SurfaceOffsets::contact(std::uint32_t a, std::uint32_t b) const {
  return double(std::max({offset_m_[a], offset_m_[b], std::min(contact_m_[a], contact_m_[b])}));
}

}  // namespace earthshine::scenes
