// SPDX-License-Identifier: Apache-2.0
#include "scenes/health/mend.h"

#include <optional>
#include <utility>

#include "scenes/health/doubled_faces.h"
#include "scenes/health/orienter.h"
#include "scenes/health/sheets.h"

namespace earthshine::scenes {
FaceParts mend_surfaces(Scene& scene) {
  Sheets sheets(scene);
  for (const Object& object : scene.objects) {
    if (object.orient != Orient::TwoSided) continue;
    for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
      Triangle& triangle = scene.triangles[object.first_triangle + t];
      triangle.material = sheets.of(triangle.material);
    }
  }
  std::optional<Orienter> orienter(std::in_place, scene);
  if (has_doubled_faces(scene)) {
    // Bodies first: where one that is inside out touches another, their faces look alike.
    orienter->orient_all(true);
    if (mend_doubled_faces(scene, sheets, orienter->parts())) orienter.emplace(scene);
  }
  orienter->orient_all(false);
  return orienter->parts();
}

}  // namespace earthshine::scenes
