// SPDX-License-Identifier: Apache-2.0
// RayQuery's Embree data (3.13 and 4.x) and how it is built. Used by these files and ray_query.cpp
// only.
#pragma once

// Embree 3 and 4 differ in the header's folder and in the query functions; the rest is common.
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#define EARTHSHINE_EMBREE_MAJOR 4
#else
#include <embree3/rtcore.h>
#define EARTHSHINE_EMBREE_MAJOR 3
#endif

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "scenes/ray_query.h"
#include "scenes/surface_texture.h"

namespace earthshine::scenes {

inline constexpr unsigned all_rays = 0xFFFFFFFFU;

#if EARTHSHINE_EMBREE_MAJOR == 4
using EmbreeContext = RTCRayQueryContext;
#else
using EmbreeContext = RTCIntersectContext;
#endif

// Context of shadow rays: surfaces in `specular_paths` do not stop them but are reported.
struct ShadowContext : EmbreeContext {
  const SpecularPaths* specular_paths = nullptr;  // null: all surfaces stop rays
  std::uint32_t met = 0;                          // bit k: ray k hit one of these
};

struct RayQuery::Embree {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  // What hangs on joints; null: nothing does. A structure of its own, so that a ray that meets none
  // of it has the same hit in all poses, even exactly on an edge, where the structure decides.
  RTCScene movers = nullptr;
  OpacityMasks masks;
  bool any_specular_paths = false;  // some faces let shadow rays continue
  // Instances share the Embree scene of their original, which is built once. Indexed by the
  // geometry number in the top scene; the first geometry holds all other triangles.
  struct Placed {
    std::uint32_t first_triangle = 0;
    glm::mat3 to_original{1.0F};  // of directions
  };
  std::vector<Placed> placed;

  ~Embree() {
    if (movers != nullptr) rtcReleaseScene(movers);
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }

  // Calls cast(scene) for each structure. Embree keeps the nearer hit of both.
  template <class Cast>
  void cast_into_each(Cast cast) const {
    cast(scene);
    if (movers != nullptr) cast(movers);
  }

  [[nodiscard]] std::uint32_t hidden_bits(RTCRay8& rays, std::size_t count,
                                          ShadowContext& context) const;

  [[nodiscard]] std::uint32_t triangle(unsigned instance, unsigned primitive) const {
    return instance == RTC_INVALID_GEOMETRY_ID ? primitive
                                               : placed[instance].first_triangle + primitive;
  }
  [[nodiscard]] std::uint32_t triangle_of(const RTCFilterFunctionNArguments* found,
                                          unsigned k) const {
    return triangle(RTCHitN_instID(found->hit, found->N, k, 0),
                    RTCHitN_primID(found->hit, found->N, k));
  }
  [[nodiscard]] bool is_hole(const RTCFilterFunctionNArguments* found, unsigned k,
                             std::uint32_t triangle) const;
  // Whether a ray comes from the front. Embree returns normals in the original's frame.
  [[nodiscard]] bool is_front(unsigned instance, const glm::vec3& normal,
                              glm::vec3 direction) const {
    if (instance != RTC_INVALID_GEOMETRY_ID) direction = placed[instance].to_original * direction;
    return normal.x * direction.x + normal.y * direction.y + normal.z * direction.z < 0.0F;
  }

  static void pass_holes(const RTCFilterFunctionNArguments* found);
  static void pass_shadow(const RTCFilterFunctionNArguments* found);
  [[noreturn]] static void fail(const std::string& what);
  [[nodiscard]] RTCScene new_scene() const;
  enum class Which { All, Standing, Moving };
  // Adds triangles first .. first + count - 1 and vertices low .. high - 1, relative to `centre`;
  // those of other objects keep their numbers and meet no ray.
  void add_triangles(RTCScene to, const Scene& source, std::size_t first, std::size_t count,
                     std::size_t low, std::size_t high, const Vec3& centre, Which which);
  void add_instances(const Scene& source, const Vec3& centre);
};

}  // namespace earthshine::scenes
