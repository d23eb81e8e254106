// SPDX-License-Identifier: Apache-2.0
// The scene's feature edges as a camera sees them, hidden lines taken out: what is laid over a
// photograph to find out where its camera stood and where it looked.
#pragma once

#include <cstdint>
#include <vector>

#include "raytrace/camera/camera.h"
#include "scenes/ray_query.h"

namespace earthshine::raytrace {

// An edge of the surface. Triangles are taken as joined where their corners have the same
// coordinates, whether or not they share vertices.
struct FeatureEdge {
  Vec3 from{0.0}, to{0.0};  // m
  std::uint32_t object = 0;
  // Only an outline: both triangles at it bend by less than the crease angle, and it is drawn when
  // one faces the camera and the other does not.
  bool silhouette_only = false;
  Vec3 normal[2] = {Vec3(0.0), Vec3(0.0)};  // of the two triangles, for the silhouette
};

// Borders (one triangle, or more than two), changes of object or material, creases of at least
// crease_deg between the normals, and the candidates for the silhouette. Sorted by the place of
// their first triangle in the scene: the same scene gives the same list.
[[nodiscard]] std::vector<FeatureEdge> feature_edges(const scenes::Scene& scene, double crease_deg);

// A visible stretch, in pixels from the top left corner (CameraModel::ray). Its ends may lie up to
// a pixel outside the picture.
struct WireSegment {
  double x0 = 0.0, y0 = 0.0, x1 = 0.0, y1 = 0.0;
  std::uint32_t object = 0;
};

// The edges through the pinhole at the middle of the lens, cut to the picture and to what no
// triangle hides. An edge is probed once a pixel, ends of visible stretches are found to 1/16 px;
// what is nearer to the edge than about a pixel's width does not hide it, so that the surfaces at
// the edge itself never do. Same result on any number of threads.
[[nodiscard]] std::vector<WireSegment> visible_wire(const std::vector<FeatureEdge>& edges,
                                                    const scenes::RayQuery& query,
                                                    const CameraModel& camera);

}  // namespace earthshine::raytrace
