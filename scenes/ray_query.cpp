// SPDX-License-Identifier: Apache-2.0
#include "scenes/ray_query.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <utility>

#include "base/free_memory.h"
#include "scenes/ray_structure.h"
#include "scenes/shadow_path.h"
#include "scenes/triangle_point.h"

namespace earthshine::scenes {
namespace {

#if EARTHSHINE_EMBREE_MAJOR == 4
void intersect8(const int* valid, RTCScene scene, RTCRayHit8& rays) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  rtcIntersect8(valid, scene, &rays, &arguments);
}
void occluded8(const int* valid, RTCScene scene, RTCRay8& rays, ShadowContext& context) {
  rtcInitRayQueryContext(&context);
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &context;
  rtcOccluded8(valid, scene, &rays, &arguments);
}
void intersect1(RTCScene scene, RTCRayHit& ray) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  rtcIntersect1(scene, &ray, &arguments);
}
#else
void intersect8(const int* valid, RTCScene scene, RTCRayHit8& rays) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect8(valid, scene, &context, &rays);
}
void occluded8(const int* valid, RTCScene scene, RTCRay8& rays, ShadowContext& context) {
  rtcInitIntersectContext(&context);
  rtcOccluded8(valid, scene, &context, &rays);
}
void intersect1(RTCScene scene, RTCRayHit& ray) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &ray);
}
#endif

void fill(const RayPacket& rays, RTCRay8& ray) {
  static_assert(sizeof(ray.org_x) == sizeof(rays.origin_x));
  std::memcpy(ray.org_x, rays.origin_x, sizeof(ray.org_x));
  std::memcpy(ray.org_y, rays.origin_y, sizeof(ray.org_y));
  std::memcpy(ray.org_z, rays.origin_z, sizeof(ray.org_z));
  std::memcpy(ray.dir_x, rays.direction_x, sizeof(ray.dir_x));
  std::memcpy(ray.dir_y, rays.direction_y, sizeof(ray.dir_y));
  std::memcpy(ray.dir_z, rays.direction_z, sizeof(ray.dir_z));
  std::memcpy(ray.tfar, rays.t_max, sizeof(ray.tfar));
  for (std::size_t k = 0; k < RayPacket::width; ++k) {
    ray.tnear[k] = 0.0F;
    ray.time[k] = 0.0F;
    ray.mask[k] = all_rays;
    ray.id[k] = static_cast<unsigned>(k);
    ray.flags[k] = 0;
  }
}

// Embree's lane mask for each count of active lanes.
constexpr auto lane_masks() {
  std::array<std::array<int, 8>, 9> masks{};
  for (std::size_t count = 0; count <= 8; ++count) {
    for (std::size_t lane = 0; lane < 8; ++lane) masks[count][lane] = lane < count ? -1 : 0;
  }
  return masks;
}
alignas(32) constexpr std::array<std::array<int, 8>, 9> valid_lanes = lane_masks();

// Factor on the distance of the farthest surface: rays from beyond start at the scene's bounds.
constexpr double far_extents = 2.0;
// Share of a point's distance from the centre: a few roundings of its coordinates.
constexpr double point_offset = 0x1p-21;
// Point with these weights, moved off the edges by their rounding error, which could put it behind
// a neighbour and let light leak from a closed room.
Vec3 inside(const Corners& p, const Barycentric& at) {
  constexpr double rounding = 0x1p-22;
  const double u = std::clamp(at.u, rounding, 1.0 - 2.0 * rounding),
               v = std::clamp(at.v, rounding, 1.0 - rounding - u);
  return (1.0 - u - v) * p.a + u * p.b + v * p.c;
}

// Cosine of incidence below which rays keep Embree's hit point.
constexpr double least_fall = 1e-6;

}  // namespace

// Casts shadow rays. Bit k is set if ray k met anything.
std::uint32_t RayQuery::Embree::hidden_bits(RTCRay8& rays, std::size_t count,
                                            ShadowContext& context) const {
  cast_into_each([&](RTCScene each) { occluded8(valid_lanes[count].data(), each, rays, context); });
  std::uint32_t bits = 0;
  for (std::size_t k = 0; k < count; ++k) {
    if (rays.tfar[k] < 0.0F) bits |= 1U << k;
  }
  return bits;
}

RayQuery::RayQuery(const Scene& source, const std::optional<Vec3>& about)
    : embree_(std::make_unique<Embree>()),
      offsets_(source, about),
      specular_paths_(source, offsets_),
      coincident_(source) {
  embree_->device = rtcNewDevice(nullptr);
  if (embree_->device == nullptr) Embree::fail("Embree could not start");
  embree_->scene = embree_->new_scene();

  std::size_t own_triangles = source.triangles.size(), own_vertices = source.vertices.size();
  for (const Object& object : source.objects) {
    if (!object.instance) continue;
    own_triangles = object.first_triangle;
    own_vertices = object.instance->first_vertex;
    break;
  }
  // Measured peak while Embree 3.13 builds at its highest quality; a third remains afterwards.
  constexpr std::uint64_t bytes_per_triangle = 450;
  std::vector<bool> is_original(source.objects.size(), false);  // stored once more for instances
  for (const Object& object : source.objects) {
    if (object.instance) is_original[object.instance->object] = true;
  }
  std::uint64_t built = own_triangles;
  for (std::size_t o = 0; o < is_original.size(); ++o) {
    if (is_original[o]) built += source.objects[o].triangle_count;
  }
  base::check_room(built * bytes_per_triangle, source.path.string());
  if (!source.triangles.empty()) {
    for (const Vec3& vertex : source.vertices) bounds_.add(vertex - centre());
    far_m_ = far_extents * glm::length(glm::max(-bounds_.low, bounds_.high));
    embree_->masks = OpacityMasks(source);
    embree_->any_specular_paths = !specular_paths_.empty();
    const bool any_moves = std::ranges::any_of(source.objects, [](const Object& object) {
      return !object.joint.empty() && !object.instance;
    });
    const auto add = [&](RTCScene to, Embree::Which which) {
      embree_->add_triangles(to, source, 0, own_triangles, 0, own_vertices, centre(), which);
    };
    add(embree_->scene, any_moves ? Embree::Which::Standing : Embree::Which::All);
    if (any_moves) {
      embree_->movers = embree_->new_scene();
      add(embree_->movers, Embree::Which::Moving);
      rtcCommitScene(embree_->movers);
    }
    embree_->add_instances(source, centre());
  }
  rtcCommitScene(embree_->scene);
  if (const RTCError error = rtcGetDeviceError(embree_->device); error != RTC_ERROR_NONE) {
    Embree::fail("Embree error " + std::to_string(static_cast<int>(error)));
  }
}

RayQuery::~RayQuery() = default;
RayQuery::RayQuery(RayQuery&&) noexcept = default;
RayQuery& RayQuery::operator=(RayQuery&&) noexcept = default;

double RayQuery::offset_at_m(const Vec3& point) const {
  const Vec3 from = glm::abs(point - centre());
  return point_offset * std::max({from.x, from.y, from.z});
}

double RayQuery::distance_to_bounds_m(const Vec3& from, const Vec3& direction) const {
  const double margin = 1e-3 * far_m_;
  double first = 0.0, last = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double low = (bounds_.low[axis] - margin - from[axis]) / direction[axis],
                 high = (bounds_.high[axis] + margin - from[axis]) / direction[axis];
    // NaN if the ray lies in the plane of a face: no bound.
    if (low < high || high < low) {
      first = std::max(first, std::min(low, high));
      last = std::min(last, std::max(low, high));
    }
  }
  return first <= last ? first : std::max(0.0, -glm::dot(from, direction));
}

void RayQuery::closest(const RayPacket& rays, std::size_t count, HitPacket& hits) const {
  RTCRayHit8 query;
  fill(rays, query.ray);
  for (unsigned& id : query.hit.geomID) id = RTC_INVALID_GEOMETRY_ID;
  for (unsigned& id : query.hit.instID[0]) id = RTC_INVALID_GEOMETRY_ID;
  embree_->cast_into_each(
      [&](RTCScene scene) { intersect8(valid_lanes[count].data(), scene, query); });
  for (std::size_t k = 0; k < RayPacket::width; ++k) {
    const bool hit = query.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID;
    const unsigned instance = query.hit.instID[0][k];
    hits.triangle[k] = hit ? embree_->triangle(instance, query.hit.primID[k]) : no_triangle;
    hits.u[k] = query.hit.u[k];
    hits.v[k] = query.hit.v[k];
    hits.t[k] = query.ray.tfar[k] + rays.start[k];
    const bool front =
        embree_->is_front(instance, {query.hit.Ng_x[k], query.hit.Ng_y[k], query.hit.Ng_z[k]},
                          {query.ray.dir_x[k], query.ray.dir_y[k], query.ray.dir_z[k]});
    hits.front[k] = front ? 1U : 0U;
    if (coincident_.empty() || !hit) continue;
    const Vec3 direction(rays.direction_x[k], rays.direction_y[k], rays.direction_z[k]);
    const Vec3 at = centre() + Vec3(rays.origin_x[k], rays.origin_y[k], rays.origin_z[k]) +
                    double(query.ray.tfar[k]) * direction;
    if (const auto first = coincident_.first_met(hits.triangle[k], at, direction)) {
      hits.triangle[k] = first->triangle;
      hits.u[k] = static_cast<float>(first->u);
      hits.v[k] = static_cast<float>(first->v);
      hits.front[k] = first->front ? 1U : 0U;
    }
  }
}

Hit RayQuery::closest(const Vec3& origin, const Vec3& direction) const {
  RTCRayHit query{};
  Vec3 from = origin - centre();
  const double start = is_far(from) ? distance_to_bounds_m(from, direction) : 0.0;
  from += start * direction;
  const glm::vec3 o(from), d(direction);
  query.ray.org_x = o.x;
  query.ray.org_y = o.y;
  query.ray.org_z = o.z;
  query.ray.dir_x = d.x;
  query.ray.dir_y = d.y;
  query.ray.dir_z = d.z;
  query.ray.tfar = std::numeric_limits<float>::infinity();
  query.ray.mask = all_rays;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  embree_->cast_into_each([&](RTCScene scene) { intersect1(scene, query); });
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  const unsigned instance = query.hit.instID[0];
  const bool front =
      embree_->is_front(instance, {query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z}, d);
  const Hit found{embree_->triangle(instance, query.hit.primID), query.hit.u, query.hit.v,
                  start + double(query.ray.tfar), front};
  if (coincident_.empty()) return found;
  const auto first = coincident_.first_met(found.triangle, origin + found.t * direction, direction);
  return first ? Hit{first->triangle, first->u, first->v, found.t, first->front} : found;
}

std::uint32_t RayQuery::occluded(const RayPacket& rays, std::size_t count) const {
  RTCRay8 query;
  fill(rays, query);
  ShadowContext context;
  return embree_->hidden_bits(query, count, context);
}

Vec3 hit_position(const Scene& scene, const Hit& hit) {
  return inside(corners_of(scene, hit.triangle), {hit.u, hit.v});
}

Vec3 hit_position(const Scene& scene, const Hit& hit, const Vec3& origin, const Vec3& direction) {
  const Corners p = corners_of(scene, hit.triangle);
  const Vec3 normal = p.normal();
  const double fall = glm::dot(normal, direction);
  if (std::abs(fall) <= least_fall * glm::length(normal)) return hit_position(scene, hit);
  const Vec3 at = origin + glm::dot(normal, p.a - origin) / fall * direction;
  return inside(p, barycentric(at, p.a, p.b - p.a, p.c - p.a));
}

Vec3 triangle_normal(const Scene& scene, std::uint32_t triangle) {
  return glm::normalize(corners_of(scene, triangle).normal());
}

double triangle_area(const Scene& scene, std::uint32_t triangle) {
  return 0.5 * glm::length(corners_of(scene, triangle).normal());
}

void RayQuery::light_shares(const RayPacket& rays, const std::uint32_t* mirrors, std::size_t count,
                            Rgb* shares) const {
  RTCRay8 query;
  fill(rays, query);
  ShadowContext context;
  context.specular_paths = specular_paths_.empty() ? nullptr : &specular_paths_;
  std::array<Vec3, RayPacket::width> origin, direction;
  for (std::size_t k = 0; k < count && context.specular_paths != nullptr; ++k) {
    origin[k] = centre() + Vec3(rays.origin_x[k], rays.origin_y[k], rays.origin_z[k]);
    direction[k] = Vec3(rays.direction_x[k], rays.direction_y[k], rays.direction_z[k]);
    if (mirrors[k] == no_mirror) continue;
    // Only occluders in front of the mirror count.
    const FlatMirror& mirror = specular_paths_.mirrors()[mirrors[k]];
    const double fall = -glm::dot(direction[k], mirror.normal);
    const double to_mirror =
        (mirror.height_m(origin[k]) - 2.0 * mirror.offset_m) / std::max(fall, 1e-12);
    query.tfar[k] = std::min(query.tfar[k], static_cast<float>(std::max(0.0, to_mirror)));
  }
  const std::uint32_t hidden = embree_->hidden_bits(query, count, context);
  for (std::size_t k = 0; k < count; ++k) {
    const bool reflects = context.specular_paths != nullptr && mirrors[k] != no_mirror;
    if (((hidden >> k) & 1U) != 0) {
      shares[k] = Rgb(0.0);
    } else if (!reflects && ((context.met >> k) & 1U) == 0) {
      shares[k] = Rgb(1.0);
    } else {
      shares[k] = ShadowPath(*this, origin[k], direction[k], double(rays.t_max[k]), mirrors[k])
                      .follow(closest(origin[k], direction[k]));
    }
  }
}

}  // namespace earthshine::scenes
