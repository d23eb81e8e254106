// SPDX-License-Identifier: Apache-2.0
// Rays against the scene's triangles. The only user of Embree (3.13 and 4.x).
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>

#include "scenes/coincident_faces.h"
#include "scenes/light_ways.h"
#include "scenes/scene.h"

namespace earthshine::scenes {

inline constexpr std::uint32_t no_triangle = 0xFFFFFFFFU;

// Up to 8 rays side by side, in the layout that the vector units want: single precision about the
// scene's centre. RayQuery::set fills a lane from the scene's own coordinates.
struct alignas(32) RayPacket {
  static constexpr std::size_t width = 8;
  float origin_x[width], origin_y[width], origin_z[width];
  float direction_x[width], direction_y[width], direction_z[width];
  float t_max[width];
};

// Hits of a packet. (u, v) are the weights of the triangle's second and third vertex.
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
  // taken off in double precision: a scene far from its origin loses nothing.
  void set(RayPacket& rays, std::size_t lane, const Vec3& origin, const Vec3& direction,
           double t_max_m = std::numeric_limits<double>::infinity()) const {
    rays.origin_x[lane] = static_cast<float>(origin.x - centre_.x);
    rays.origin_y[lane] = static_cast<float>(origin.y - centre_.y);
    rays.origin_z[lane] = static_cast<float>(origin.z - centre_.z);
    rays.direction_x[lane] = static_cast<float>(direction.x);
    rays.direction_y[lane] = static_cast<float>(direction.y);
    rays.direction_z[lane] = static_cast<float>(direction.z);
    rays.t_max[lane] = static_cast<float>(t_max_m);
  }

  // Nearest hit of the first `count` rays (at most 8); of faces that lie on each other the one that
  // is before the others. Safe on many threads.
  void closest(const RayPacket& rays, std::size_t count, HitPacket& hits) const;
  [[nodiscard]] Hit closest(const Vec3& origin, const Vec3& direction) const;

  // Bit k is set if ray k meets anything before t_max.
  [[nodiscard]] std::uint32_t occluded(const RayPacket& rays, std::size_t count) const;

  // Shadow rays, from a surface toward a source at t_max: of its light, the share that arrives.
  // mirrors: per ray the flat mirror of ways() that the light comes by, t_max the whole way; or
  // no_mirror. Glass that does not bend light lets its share through, all else casts a shadow.
  void light_shares(const RayPacket& rays, const std::uint32_t* mirrors, std::size_t count,
                    Rgb* shares) const;
  [[nodiscard]] const LightWays& ways() const { return ways_; }
  [[nodiscard]] const CoincidentFaces& coincident() const { return coincident_; }

  // How far to lift a ray's origin off its surface along the normal, m: a few units of single
  // precision at the scene's extent, so that no ray hits the surface it leaves and none leaks
  // through a neighbour.
  [[nodiscard]] double surface_offset_m() const;

  // What packets' origins are relative to.
  [[nodiscard]] const Vec3& centre() const { return centre_; }

 private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
  LightWays ways_;
  CoincidentFaces coincident_;
  Vec3 centre_{0.0};
};

// surface_offset_m of a query of the scene.
[[nodiscard]] double surface_offset_m(const Scene& scene);

// Point of a hit, found from the triangle's corners: more exact than origin + t direction.
[[nodiscard]] Vec3 hit_position(const Scene& scene, const Hit& hit);

// Unit normal of a triangle's front.
[[nodiscard]] Vec3 triangle_normal(const Scene& scene, std::uint32_t triangle);
[[nodiscard]] double triangle_area(const Scene& scene, std::uint32_t triangle);

}  // namespace earthshine::scenes
