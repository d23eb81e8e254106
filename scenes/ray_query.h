// SPDX-License-Identifier: Apache-2.0
// Ray queries on the scene's triangles. The only user of Embree (3.13 and 4.x).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>

#include "scenes/coincident_faces.h"
#include "scenes/scene.h"
#include "scenes/specular_paths.h"
#include "scenes/surface_offset.h"

namespace earthshine::scenes {

inline constexpr std::uint32_t no_triangle = 0xFFFFFFFFU;

// Up to 8 rays in SIMD layout, single precision, relative to RayQuery::centre(). RayQuery::set
// fills a lane from scene coordinates.
struct alignas(32) RayPacket {
  static constexpr std::size_t width = 8;
  float origin_x[width], origin_y[width], origin_z[width];
  float direction_x[width], direction_y[width], direction_z[width];
  float t_max[width];
  float start[width] = {};  // distance from the caller's origin to the start, m (RayQuery::set)
};

// Hits of a packet. (u, v) are the weights of the triangle's second and third vertex; t is the
// distance from the caller's origin, m.
struct alignas(32) HitPacket {
  std::uint32_t triangle[RayPacket::width];  // no_triangle: the ray escapes
  float u[RayPacket::width], v[RayPacket::width], t[RayPacket::width];
  std::uint32_t front[RayPacket::width];  // 1 if the ray came from the triangle's front
};

struct Hit {
  std::uint32_t triangle = no_triangle;
  double u = 0.0, v = 0.0, t = 0.0;
  bool front = true;
  [[nodiscard]] bool missed() const { return triangle == no_triangle; }
};

class RayQuery {
 public:
  // Builds the acceleration structure from a centred single-precision copy of the triangles. Throws
  // base::Error (Work) if Embree reports an error.
  // about: the centre() of another pose of the scene, so that rays have the same bytes in both.
  explicit RayQuery(const Scene& scene, const std::optional<Vec3>& about = std::nullopt);
  ~RayQuery();
  RayQuery(RayQuery&&) noexcept;
  RayQuery& operator=(RayQuery&&) noexcept;

  // origin in metres in the scene's frame, direction of unit length, t_max in metres. Subtracts the
  // centre in double precision, so that scenes far from their origin lose no accuracy. A ray from
  // far outside the scene starts where it enters the scene's bounds.
  void set(RayPacket& rays, std::size_t lane, const Vec3& origin, const Vec3& direction,
           double t_max_m = std::numeric_limits<double>::infinity()) const {
    Vec3 from = origin - centre();
    double start = 0.0;
    if (is_far(from)) {
      start = distance_to_bounds_m(from, direction);
      from += start * direction;
      t_max_m = std::max(0.0, t_max_m - start);
    }
    rays.origin_x[lane] = static_cast<float>(from.x);
    rays.origin_y[lane] = static_cast<float>(from.y);
    rays.origin_z[lane] = static_cast<float>(from.z);
    rays.direction_x[lane] = static_cast<float>(direction.x);
    rays.direction_y[lane] = static_cast<float>(direction.y);
    rays.direction_z[lane] = static_cast<float>(direction.z);
    rays.t_max[lane] = static_cast<float>(t_max_m);
    rays.start[lane] = static_cast<float>(start);
  }

  // Nearest hits of the first `count` rays (at most 8). Where faces lie on each other, returns the
  // front one. Thread-safe.
  void closest(const RayPacket& rays, std::size_t count, HitPacket& hits) const;
  [[nodiscard]] Hit closest(const Vec3& origin, const Vec3& direction) const;

  // Bit k is set if ray k hits anything before t_max.
  [[nodiscard]] std::uint32_t occluded(const RayPacket& rays, std::size_t count) const;

  // Shadow rays from a surface to a source at t_max: share of its light that arrives. mirrors: per
  // ray the flat mirror of specular_paths() that reflects the light, or no_mirror; t_max is the
  // length of the whole path. Glass that does not refract transmits its share; all other surfaces
  // occlude.
  void light_shares(const RayPacket& rays, const std::uint32_t* mirrors, std::size_t count,
                    Rgb* shares) const;
  [[nodiscard]] const SpecularPaths& specular_paths() const { return specular_paths_; }
  [[nodiscard]] const CoincidentFaces& coincident() const { return coincident_; }

  // Distance along the normal at which rays that leave a triangle start, m.
  [[nodiscard]] double offset_m(std::uint32_t triangle) const { return offsets_.of(triangle); }
  [[nodiscard]] const SurfaceOffsets& offsets() const { return offsets_; }
  // Offset for a point that lies on no surface, such as a lamp's position, m.
  [[nodiscard]] double offset_at_m(const Vec3& point) const;

  // Error of a hit distance t, m: single precision, from the point where the ray enters the scene's
  // bounds.
  [[nodiscard]] double distance_error_m(double t) const { return 0x1p-22 * std::min(t, far_m_); }

  // Origin of the packets' coordinates.
  [[nodiscard]] const Vec3& centre() const { return offsets_.centre(); }
  // Origin for a camera's single-precision coordinates: its position, or centre() if the camera is
  // far outside the scene.
  [[nodiscard]] const Vec3& near(const Vec3& camera) const {
    return is_far(camera - centre()) ? centre() : camera;
  }

 private:
  struct Embree;
  // Whether a point (relative to the centre) is several times farther away than any surface.
  [[nodiscard]] bool is_far(const Vec3& point) const {
    return std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)}) > far_m_;
  }
  // Distance along a ray to the scene's bounds, or to the point nearest to the centre if the ray
  // misses them, m.
  [[nodiscard]] double distance_to_bounds_m(const Vec3& from, const Vec3& direction) const;

  std::unique_ptr<Embree> embree_;
  SurfaceOffsets offsets_;
  SpecularPaths specular_paths_;
  CoincidentFaces coincident_;
  Box bounds_;  // relative to the centre
  double far_m_ = 0.0;
};

// Hit point from the triangle's corners: more accurate than origin + t direction.
[[nodiscard]] Vec3 hit_position(const Scene& scene, const Hit& hit);
// Hit point as the intersection of the ray, with its origin in double precision, and the triangle's
// plane. For triangles of kilometres (u, v) are accurate to a millimetre only.
[[nodiscard]] Vec3 hit_position(const Scene& scene, const Hit& hit, const Vec3& origin,
                                const Vec3& direction);

// Unit normal of a triangle's front.
[[nodiscard]] Vec3 triangle_normal(const Scene& scene, std::uint32_t triangle);
[[nodiscard]] double triangle_area(const Scene& scene, std::uint32_t triangle);

}  // namespace earthshine::scenes
