// SPDX-License-Identifier: Apache-2.0
// The scene's feature edges in a camera's picture without hidden lines, as an overlay to find the
// position and direction of a photograph's camera.
#pragma once

#include <cstdint>
#include <vector>

#include "raytrace/camera/camera.h"
#include "scenes/ray_query.h"

namespace earthshine::raytrace {

// An edge of the surface. Triangles are joined where their corners have the same coordinates,
// whether or not they share vertices.
struct FeatureEdge {
  Vec3 from{0.0}, to{0.0};  // m
  std::uint32_t object = 0;
  // The two triangles bend by less than the crease angle: the edge is drawn only if one faces the
  // camera and the other does not.
  bool silhouette_only = false;
  Vec3 normal[2] = {Vec3(0.0), Vec3(0.0)};  // of the two triangles, for the silhouette
};

// Borders (one triangle, or more than two), changes of object or material, creases of at least
// crease_deg between the normals, and the candidates for the silhouette. Sorted by their first
// triangle in the scene: the same scene gives the same list.
[[nodiscard]] std::vector<FeatureEdge> feature_edges(const scenes::Scene& scene, double crease_deg);

// A visible segment, in pixels from the top left corner (CameraModel::ray). Its ends may be up to a
// pixel outside the picture.
struct WireSegment {
  double x0 = 0.0, y0 = 0.0, x1 = 0.0, y1 = 0.0;
  std::uint32_t object = 0;
};

// The edges as seen from the centre of the lens, clipped to the picture and to their visible parts.
// Edges are probed once per pixel; ends of visible segments are accurate to 1/16 px. Occluders
// closer to the edge than about a pixel's width are ignored, so that its own surfaces never hide
// it. The same result for any number of threads.
[[nodiscard]] std::vector<WireSegment> visible_wire(const std::vector<FeatureEdge>& edges,
                                                    const scenes::RayQuery& query,
                                                    const CameraModel& camera);

}  // namespace earthshine::raytrace
