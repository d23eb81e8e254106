// SPDX-License-Identifier: Apache-2.0
// Rays against the scene's triangles. The only user of Embree (3.13 and 4.x).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>

#include "scenes/coincident_faces.h"
#include "scenes/scene.h"
#include "scenes/specular_paths.h"
#include "scenes/surface_offset.h"

namespace earthshine::scenes {

inline constexpr std::uint32_t no_triangle = 0xFFFFFFFFU;

// Up to 8 rays side by side, in the layout that the vector units want: single precision about
// RayQuery::centre(). RayQuery::set fills a lane from the scene's own coordinates.
struct alignas(32) RayPacket {
  static constexpr std::size_t width = 8;
  float origin_x[width], origin_y[width], origin_z[width];
  float direction_x[width], direction_y[width], direction_z[width];
  float t_max[width];
  float start[width] = {};  // m from where the caller has the origin (RayQuery::set)
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
  // Builds the acceleration structure. The scene's triangles are copied, centred, in single
  // precision. Throws base::Error (Work) if Embree reports an error.
  explicit RayQuery(const Scene& scene);
  ~RayQuery();
  RayQuery(RayQuery&&) noexcept;
  RayQuery& operator=(RayQuery&&) noexcept;

  // origin in metres in the scene's frame, direction of unit length, t_max in metres. The centre is
  // taken off in double precision: a scene far from its origin loses nothing. A ray that comes
  // from far outside the scene starts where it enters the scene's bounds.
  void set(RayPacket& rays, std::size_t lane, const Vec3& origin, const Vec3& direction,
           double t_max_m = std::numeric_limits<double>::infinity()) const {
    Vec3 from = origin - centre();
    double start = 0.0;
    if (is_far(from)) {
      start = way_to_bounds_m(from, direction);
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

  // Nearest hit of the first `count` rays (at most 8); of faces that lie on each other the one that
  // is before the others. Safe on many threads.
  void closest(const RayPacket& rays, std::size_t count, HitPacket& hits) const;
  [[nodiscard]] Hit closest(const Vec3& origin, const Vec3& direction) const;

  // Bit k is set if ray k meets anything before t_max.
  [[nodiscard]] std::uint32_t occluded(const RayPacket& rays, std::size_t count) const;

  // Shadow rays, from a surface toward a source at t_max: of its light, the share that arrives.
  // mirrors: per ray the flat mirror of specular_paths() that the light comes by, t_max the whole way; or
  // no_mirror. Glass that does not bend light lets its share through, all else casts a shadow.
  void light_shares(const RayPacket& rays, const std::uint32_t* mirrors, std::size_t count,
                    Rgb* shares) const;
  [[nodiscard]] const SpecularPaths& specular_paths() const { return specular_paths_; }
  [[nodiscard]] const CoincidentFaces& coincident() const { return coincident_; }

  // How far off a triangle, along its normal, rays start that leave it, m.
  [[nodiscard]] double offset_m(std::uint32_t triangle) const { return offsets_.of(triangle); }
  [[nodiscard]] const SurfaceOffsets& offsets() const { return offsets_; }
  // The same of a point that lies on no surface, such as a lamp's.
  [[nodiscard]] double offset_at_m(const Vec3& point) const;

  // The error of a distance t that a ray finds, m: single precision, from where the ray enters the
  // scene's bounds.
  [[nodiscard]] double distance_error_m(double t) const { return 0x1p-22 * std::min(t, far_m_); }

  // What packets' origins are relative to.
  [[nodiscard]] const Vec3& centre() const { return offsets_.centre(); }
  // What coordinates in single precision may be relative to that serve a camera: its position, or
  // centre() where the camera is far outside the scene.
  [[nodiscard]] const Vec3& near(const Vec3& camera) const {
    return is_far(camera - centre()) ? centre() : camera;
  }

 private:
  struct Embree;
  // A point about the centre, several times as far from it as any surface.
  [[nodiscard]] bool is_far(const Vec3& point) const {
    return std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)}) > far_m_;
  }
  // Along a ray from there: to the bounds, or to where it passes the centre if it misses them.
  [[nodiscard]] double way_to_bounds_m(const Vec3& from, const Vec3& direction) const;

  std::unique_ptr<Embree> embree_;
  SurfaceOffsets offsets_;
  SpecularPaths specular_paths_;
  CoincidentFaces coincident_;
  Box bounds_;  // about the centre
  double far_m_ = 0.0;
};

// Point of a hit, found from the triangle's corners: more exact than origin + t direction.
[[nodiscard]] Vec3 hit_position(const Scene& scene, const Hit& hit);
// The same of a ray whose origin is known in double precision, where it meets the triangle's plane:
// on a triangle of kilometres (u, v) are exact to a millimetre.
[[nodiscard]] Vec3 hit_position(const Scene& scene, const Hit& hit, const Vec3& origin,
                                const Vec3& direction);

// Unit normal of a triangle's front.
[[nodiscard]] Vec3 triangle_normal(const Scene& scene, std::uint32_t triangle);
[[nodiscard]] double triangle_area(const Scene& scene, std::uint32_t triangle);

}  // namespace earthshine::scenes
