// SPDX-License-Identifier: Apache-2.0
// What RayQuery keeps of Embree (3.13 and 4.x), and how it is built. Of these files and
// ray_query.cpp alone.
#pragma once

// Embree 3 and 4 differ in the header's folder and in how a query is called; everything else here
// is common.
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

// Of shadow rays: what goes on from `specular_paths` stops none of them, but is reported.
struct ShadowContext : EmbreeContext {
  const SpecularPaths* specular_paths = nullptr;  // null: all surfaces stop rays
  std::uint32_t met = 0;                          // bit k: ray k met one that does not
};

struct RayQuery::Embree {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  OpacityMasks masks;
  bool any_specular_paths = false;  // some faces let shadow rays go on
  // Instances have the structure of their original's triangles, once; by the number of their
  // geometry in the scene, of which the first is that of all other triangles.
  struct Placed {
    std::uint32_t first_triangle = 0;
    glm::mat3 to_original{1.0F};  // of directions
  };
  std::vector<Placed> placed;

  ~Embree() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }

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
  // Whether a ray comes from the front. Embree has normals as the original has them.
  [[nodiscard]] bool is_front(unsigned instance, const glm::vec3& normal, glm::vec3 way) const {
    if (instance != RTC_INVALID_GEOMETRY_ID) way = placed[instance].to_original * way;
    return normal.x * way.x + normal.y * way.y + normal.z * way.z < 0.0F;
  }

  static void pass_holes(const RTCFilterFunctionNArguments* found);
  static void pass_shadow(const RTCFilterFunctionNArguments* found);
  [[noreturn]] static void fail(const std::string& what);
  [[nodiscard]] RTCScene new_scene() const;
  // Triangles first .. first + count - 1 and vertices low .. high - 1, about `centre`.
  void add_triangles(RTCScene to, const Scene& source, std::size_t first, std::size_t count,
                     std::size_t low, std::size_t high, const Vec3& centre);
  void add_instances(const Scene& source, const Vec3& centre);
};

}  // namespace earthshine::scenes
