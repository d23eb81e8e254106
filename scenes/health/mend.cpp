// SPDX-License-Identifier: Apache-2.0
#include "scenes/health/mend.h"

#include "scenes/health/doubled_faces.h"
#include "scenes/health/orienter.h"
#include "scenes/health/sheets.h"
#include "scenes/health/topology.h"

namespace earthshine::scenes {
namespace {

Orienter orient_all(Scene& scene, bool bodies_alone) {
  Orienter orienter(scene);
  for (std::size_t o = 0; o < scene.objects.size(); ++o) orienter.orient(o, bodies_alone);
  return orienter;
}

}  // namespace

FaceParts mend_surfaces(Scene& scene) {
  Sheets sheets(scene);
  for (const Object& object : scene.objects) {
    if (object.orient != Orient::TwoSided) continue;
    for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
      Triangle& triangle = scene.triangles[object.first_triangle + t];
      triangle.material = sheets.of(triangle.material);
    }
  }
  if (has_doubled_faces(scene)) {
    // Bodies first: where one that is inside out touches another, their faces look alike.
    orient_all(scene, true);
    mend_doubled_faces(scene, sheets);
  }
  return orient_all(scene, false).parts();
}

std::vector<SurfaceHealth> surface_health(const Scene& scene) {
  std::size_t own_vertices = scene.vertices.size();
  for (const Object& object : scene.objects) {
    if (!object.instance) continue;
    own_vertices = object.instance->first_vertex;
    break;
  }
  const std::vector<std::uint32_t> ids = welded(std::span(scene.vertices).first(own_vertices));
  std::vector<SurfaceHealth> all;
  for (const Object& object : scene.objects) {
    if (object.instance) {
      all.push_back(all[object.instance->object]);
      continue;
    }
    SurfaceHealth health;
    for (const SurfacePart& part : surface_parts(scene, object, ids)) {
      ++health.parts;
      health.open_edges += part.open_edges;
      health.non_manifold_edges += part.crowded_edges;
      health.mixed_edges += part.mixed_edges;
      if (!part.closed()) continue;
      ++health.closed_parts;
      if (part.is_body() && part.volume_m3 < 0.0) ++health.inward_parts;
    }
    all.push_back(health);
  }
  return all;
}

}  // namespace earthshine::scenes
