// SPDX-License-Identifier: Apache-2.0
#include "scenes/ray_structure.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>

#include "scenes/triangle_point.h"

namespace earthshine::scenes {

void RayQuery::Embree::fail(const std::string& what) {
  throw base::Error(base::Blame::Work, "ray structure", what, "the scene must fit into memory",
                    "Use a smaller scene or a machine with more memory");
}

bool RayQuery::Embree::is_hole(const RTCFilterFunctionNArguments* found, unsigned k,
                               std::uint32_t triangle) const {
  return !masks.empty() && masks.is_hole(triangle, double(RTCHitN_u(found->hit, found->N, k)),
                                         double(RTCHitN_v(found->hit, found->N, k)));
}

// Filter for all rays: rays pass the holes of opacity masks.
void RayQuery::Embree::pass_holes(const RTCFilterFunctionNArguments* found) {
  const auto& embree = *static_cast<const Embree*>(found->geometryUserPtr);
  for (unsigned k = 0; k < found->N; ++k) {
    if (found->valid[k] != -1) continue;
    if (embree.is_hole(found, k, embree.triangle_of(found, k))) found->valid[k] = 0;
  }
}

// Filter for shadow rays: they pass holes, and surfaces that may transmit or reflect light.
void RayQuery::Embree::pass_shadow(const RTCFilterFunctionNArguments* found) {
  const auto& embree = *static_cast<const Embree*>(found->geometryUserPtr);
  auto& shadow = *static_cast<ShadowContext*>(found->context);
  for (unsigned k = 0; k < found->N; ++k) {
    if (found->valid[k] != -1) continue;
    const std::uint32_t triangle = embree.triangle_of(found, k);
    const bool hole = embree.is_hole(found, k, triangle);
    const bool passes =
        shadow.specular_paths != nullptr && shadow.specular_paths->face(triangle) != nullptr;
    if (!hole && passes) shadow.met |= 1U << RTCRayN_id(found->ray, found->N, k);
    if (hole || passes) found->valid[k] = 0;
  }
}

RTCScene RayQuery::Embree::new_scene() const {
  RTCScene made = rtcNewScene(device);
  // Robust mode: without it two of ten million rays slip through shared edges of a closed room.
  rtcSetSceneFlags(made, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(made, RTC_BUILD_QUALITY_HIGH);
  return made;
}

void RayQuery::Embree::add_triangles(RTCScene to, const Scene& source, std::size_t first,
                                     std::size_t count, std::size_t low, std::size_t high,
                                     const Vec3& centre, Which which) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), high - low + 1));
  auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), count));
  if (vertices == nullptr || indices == nullptr) fail("no memory for the triangles");
  for (std::size_t i = 0; i < high - low; ++i) {
    const Vec3 p = source.vertices[low + i] - centre;
    for (int axis = 0; axis < 3; ++axis)
      vertices[3 * i + static_cast<std::size_t>(axis)] = static_cast<float>(p[axis]);
  }
  // Embree leaves triangles out that are not finite.
  for (std::size_t k = 0; k < 3; ++k)
    vertices[3 * (high - low) + k] = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t i = 0; i < count; ++i) {
    const Triangle& triangle = source.triangles[first + i];
    const bool moves = which != Which::All && triangle.object < source.objects.size() &&
                       !source.objects[triangle.object].joint.empty();
    const bool left_out = which != Which::All && moves != (which == Which::Moving);
    for (std::size_t k = 0; k < 3; ++k)
      indices[3 * i + k] = static_cast<unsigned>(left_out ? high - low : triangle.vertex[k] - low);
  }
  rtcSetGeometryMask(geometry, all_rays);  // Embree 4 would default to 1
  rtcSetGeometryUserData(geometry, this);
  if (!masks.empty()) rtcSetGeometryIntersectFilterFunction(geometry, pass_holes);
  if (!masks.empty() || any_specular_paths)
    rtcSetGeometryOccludedFilterFunction(geometry, pass_shadow);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(to, geometry);
  rtcReleaseGeometry(geometry);
}

// Each original is centred on its own middle, so that single precision suffices for its size.
void RayQuery::Embree::add_instances(const Scene& source, const Vec3& centre) {
  struct Original {
    RTCScene scene = nullptr;
    Vec3 centre{0.0};
  };
  std::map<std::uint32_t, Original> originals;
  placed.resize(1);
  for (const Object& object : source.objects) {
    if (!object.instance) continue;
    const Instance& instance = *object.instance;
    Original& original = originals[instance.object];
    if (original.scene == nullptr) {
      const Object& first = source.objects[instance.object];
      const auto [begin, count] = vertices_of(source, first);
      original.centre = Vec3(bounds_of(source, first).middle_in_single());
      original.scene = new_scene();
      add_triangles(original.scene, source, first.first_triangle, first.triangle_count, begin,
                    std::size_t{begin} + count, original.centre, Which::All);
      rtcCommitScene(original.scene);
    }
    const Vec3 offset = instance.linear * original.centre + instance.offset_m - centre;
    std::array<float, 12> matrix;  // three columns and the translation
    std::size_t entry = 0;
    for (int column = 0; column < 4; ++column) {
      const Vec3& from = column < 3 ? instance.linear[column] : offset;
      for (int row = 0; row < 3; ++row) matrix[entry++] = static_cast<float>(from[row]);
    }
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, original.scene);
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, matrix.data());
    rtcSetGeometryMask(geometry, all_rays);
    rtcCommitGeometry(geometry);
    const unsigned number = rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    placed.resize(std::max<std::size_t>(placed.size(), number + 1));
    placed[number] = {object.first_triangle, glm::mat3(glm::inverse(instance.linear))};
  }
  for (const auto& [object, original] : originals) rtcReleaseScene(original.scene);
}

}  // namespace earthshine::scenes
