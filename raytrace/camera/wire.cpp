// SPDX-License-Identifier: Apache-2.0
#include "raytrace/camera/wire.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <tuple>

#include "base/parallel.h"
#include "scenes/health/topology.h"

namespace earthshine::raytrace {
namespace {

constexpr std::size_t edges_per_chunk = 64;
constexpr int halvings = 4;               // of a probe's step of 1 px
constexpr double margin_px = 1.0;         // around the picture
constexpr double near_share = 1e-6;       // of the edge's length: clipping distance from the camera
constexpr double least_stretch_px = 1.5;  // of a partly hidden edge
constexpr double depth_slack_px = 1;      // pixel widths that an occluder must be in front
constexpr double offset_slack = 4.0;      // or this many ray offsets from points on the edge

// ---- edges of the surface

// One side of a triangle between two welded points, low < high.
struct Side {
  std::uint32_t low = 0, high = 0, triangle = 0;
};

std::vector<Side> sides_of(const scenes::Scene& scene) {
  const std::vector<std::uint32_t> welded = scenes::welded(scene.vertices);
  std::vector<Side> sides;
  sides.reserve(3 * scene.triangles.size());
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = welded[scene.triangles[t].vertex[k]];
      const std::uint32_t b = welded[scene.triangles[t].vertex[(k + 1) % 3]];
      if (a != b) sides.push_back({std::min(a, b), std::max(a, b), t});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tuple(a.low, a.high, a.triangle) < std::tuple(b.low, b.high, b.triangle);
  });
  return sides;
}

// Empty for an edge inside a flat face.
std::optional<FeatureEdge> classify(const scenes::Scene& scene, std::span<const Side> sides,
                                    double crease_cosine) {
  const scenes::Triangle& first = scene.triangles[sides[0].triangle];
  FeatureEdge edge{scene.vertices[sides[0].low], scene.vertices[sides[0].high], first.object};
  if (sides.size() != 2) return edge;
  const scenes::Triangle& second = scene.triangles[sides[1].triangle];
  if (first.object != second.object || first.material != second.material) return edge;
  edge.normal[0] = scenes::triangle_normal(scene, sides[0].triangle);
  edge.normal[1] = scenes::triangle_normal(scene, sides[1].triangle);
  const double cosine = glm::dot(edge.normal[0], edge.normal[1]);
  if (cosine <= crease_cosine) return edge;
  constexpr double flat = 1.0 - 1e-12;
  if (cosine >= flat) return std::nullopt;
  edge.silhouette_only = true;
  return edge;
}

// ---- visible parts of edges

class Prober {
 public:
  Prober(const FeatureEdge& edge, const scenes::RayQuery& query, const CameraModel& camera)
      : edge_(edge), query_(query), camera_(camera) {}

  void append_visible(std::vector<WireSegment>& out) {
    if (!in_front() || !in_picture()) return;
    const double length = glm::length(last_ - first_);
    const auto steps = static_cast<std::size_t>(std::ceil(std::max(1.0, length)));
    std::vector<bool> seen(steps + 1);
    for (std::size_t at = 0; at <= steps; at += scenes::RayPacket::width) {
      const std::size_t count = std::min(scenes::RayPacket::width, steps + 1 - at);
      scenes::RayPacket rays;
      for (std::size_t k = 0; k < count; ++k) {
        aim(rays, k, static_cast<double>(at + k) / static_cast<double>(steps));
      }
      const std::uint32_t hidden = query_.occluded(rays, count);
      for (std::size_t k = 0; k < count; ++k) seen[at + k] = (hidden >> k & 1U) == 0;
    }
    const double step = 1.0 / static_cast<double>(steps);
    for (std::size_t k = 0; k <= steps; ++k) {
      if (!seen[k]) continue;
      std::size_t end = k;
      while (end < steps && seen[end + 1]) ++end;
      const double from = static_cast<double>(k) * step, to = static_cast<double>(end) * step;
      append(k > 0 ? edge_of_sight(from, from - step) : from,
             end < steps ? edge_of_sight(to, to + step) : to, out);
      k = end;
    }
  }

 private:
  // Clips parts behind the camera. (a_, b_): the ends in camera axes.
  bool in_front() {
    a_ = camera_.to_camera(edge_.from);
    b_ = camera_.to_camera(edge_.to);
    const double near = near_share * glm::length(b_ - a_);
    if (a_.z <= near && b_.z <= near) return false;
    if (a_.z < near) a_ += (b_ - a_) * ((near - a_.z) / (b_.z - a_.z));
    if (b_.z < near) b_ += (a_ - b_) * ((near - b_.z) / (a_.z - b_.z));
    return true;
  }

  // Clips to the picture and its margin (Liang and Barsky 1984), together with (a_, b_). (first_,
  // last_): ends in pixels.
  bool in_picture() {
    const glm::dvec2 p = pixel(a_), q = pixel(b_);
    double t0 = 0.0, t1 = 1.0;
    const glm::dvec2 low(-margin_px), high(camera_.columns + margin_px, camera_.rows + margin_px);
    for (int axis = 0; axis < 2; ++axis) {
      const double d = q[axis] - p[axis];
      const double to_low = low[axis] - p[axis], to_high = high[axis] - p[axis];
      if (d == 0.0) {
        if (to_low > 0.0 || to_high < 0.0) return false;
        continue;
      }
      t0 = std::max(t0, std::min(to_low / d, to_high / d));
      t1 = std::min(t1, std::max(to_low / d, to_high / d));
    }
    if (!(t0 < t1)) return false;
    first_ = p + t0 * (q - p);
    last_ = p + t1 * (q - p);
    const Vec3 a = in_space(a_, b_, t0), b = in_space(a_, b_, t1);
    a_ = a;
    b_ = b;
    return true;
  }

  [[nodiscard]] glm::dvec2 pixel(const Vec3& p) const {
    const glm::dvec2 at = camera_.projection.place(p);
    return {at.x * camera_.columns, at.y * camera_.rows};
  }

  // The point of the edge from a to b at the fraction t of its image: 1/z is linear there.
  [[nodiscard]] static Vec3 in_space(const Vec3& a, const Vec3& b, double t) {
    const double share = t * a.z / (t * a.z + (1.0 - t) * b.z);
    return a + share * (b - a);
  }

  void aim(scenes::RayPacket& rays, std::size_t lane, double t) const {
    const Vec3 p = in_space(a_, b_, t);
    const double distance = glm::length(p);
    const Vec3 direction =
        (p.x * camera_.right - p.y * camera_.up + p.z * camera_.forward) / distance;
    const double slack =
        std::max(depth_slack_px * p.z * camera_.pixel_angle(direction),
                 offset_slack * (query_.offset_at_m(camera_.position + distance * direction) +
                                 query_.distance_error_m(distance)));
    query_.set(rays, lane, camera_.position, direction, std::max(0.0, distance - slack));
  }

  // Bisects between a visible and a hidden position; returns the farthest visible one.
  [[nodiscard]] double edge_of_sight(double visible, double hidden) const {
    for (int k = 0; k < halvings; ++k) {
      const double middle = 0.5 * (visible + hidden);
      scenes::RayPacket ray;
      aim(ray, 0, middle);
      (query_.occluded(ray, 1) == 0 ? visible : hidden) = middle;
    }
    return visible;
  }

  void append(double t0, double t1, std::vector<WireSegment>& out) const {
    // A hidden edge appears visible for a short distance next to a visible corner (depth_slack_px).
    const bool cut = t0 > 0.0 || t1 < 1.0;
    if (cut && (t1 - t0) * glm::length(last_ - first_) < least_stretch_px) return;
    const glm::dvec2 p = first_ + t0 * (last_ - first_), q = first_ + t1 * (last_ - first_);
    out.push_back({p.x, p.y, q.x, q.y, edge_.object});
  }

  const FeatureEdge& edge_;
  const scenes::RayQuery& query_;
  const CameraModel& camera_;
  Vec3 a_{0.0}, b_{0.0};
  glm::dvec2 first_{0.0}, last_{0.0};
};

bool on_silhouette(const FeatureEdge& edge, const Vec3& eye) {
  const Vec3 view = edge.from - eye;
  return (glm::dot(edge.normal[0], view) < 0.0) != (glm::dot(edge.normal[1], view) < 0.0);
}

}  // namespace

std::vector<FeatureEdge> feature_edges(const scenes::Scene& scene, double crease_deg) {
  const double crease_cosine = std::cos(base::radians(crease_deg));
  const std::vector<Side> sides = sides_of(scene);
  std::vector<std::pair<std::uint32_t, FeatureEdge>> found;
  for (std::size_t first = 0; first < sides.size();) {
    std::size_t end = first + 1;
    while (end < sides.size() && sides[end].low == sides[first].low &&
           sides[end].high == sides[first].high) {
      ++end;
    }
    const auto edge = classify(scene, std::span(sides).subspan(first, end - first), crease_cosine);
    if (edge) found.emplace_back(sides[first].triangle, *edge);
    first = end;
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<FeatureEdge> edges;
  edges.reserve(found.size());
  for (const auto& [triangle, edge] : found) edges.push_back(edge);
  return edges;
}

std::vector<WireSegment> visible_wire(const std::vector<FeatureEdge>& edges,
                                      const scenes::RayQuery& query, const CameraModel& camera) {
  const std::size_t chunks = (edges.size() + edges_per_chunk - 1) / edges_per_chunk;
  std::vector<std::vector<WireSegment>> parts(chunks);
  base::parallel_chunks(chunks, 1, [&](std::size_t chunk, std::size_t) {
    const std::size_t end = std::min(edges.size(), (chunk + 1) * edges_per_chunk);
    for (std::size_t k = chunk * edges_per_chunk; k < end; ++k) {
      if (edges[k].silhouette_only && !on_silhouette(edges[k], camera.position)) continue;
      for_straight_pieces(camera, edges[k].from, edges[k].to,
                          [&](const Vec3& from, const Vec3& to) {
                            FeatureEdge piece = edges[k];
                            piece.from = from;
                            piece.to = to;
                            Prober(piece, query, camera).append_visible(parts[chunk]);
                          });
    }
  });
  std::vector<WireSegment> segments;
  for (const auto& part : parts) segments.insert(segments.end(), part.begin(), part.end());
  return segments;
}

}  // namespace earthshine::raytrace
