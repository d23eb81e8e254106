// SPDX-License-Identifier: Apache-2.0
#include "scenes/health/small_objects.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "scenes/surface_offset.h"
#include "scenes/text/message_text.h"
#include "scenes/triangle_point.h"

namespace earthshine::scenes {
namespace {

constexpr double least_offsets = 20.0;  // least size of an object

}  // namespace

void name_small_objects(Scene& scene) {
  const SurfaceOffsets offsets(scene);
  std::vector<std::string> small;
  double most_offset_m = 0.0, farthest_m = 0.0;
  for (const Object& object : scene.objects) {
    Box box;
    double offset_m = 0.0;
    for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
      const auto [a, b, c] = corners_of(scene, object.first_triangle + t);
      box.add(a), box.add(b), box.add(c);
      offset_m = std::max(offset_m, offsets.of(object.first_triangle + t));
    }
    if (object.triangle_count == 0 || box.diagonal() >= least_offsets * offset_m) continue;
    small.push_back(in_quotes(object.name));
    most_offset_m = std::max(most_offset_m, offset_m);
    farthest_m = std::max(farthest_m, glm::length(box.middle() - offsets.centre()));
  }
  if (small.empty()) return;
  scene.warnings.push_back(fmt::format(
      "{} {} too small for single precision {:.3g} m from the scene's centre of detail: rays start "
      "{:.2g} m off surfaces there, and light and shadow from nearer than that are lost. Check the "
      "place and scale of {}, or leave out distant objects",
      listed(small), small.size() == 1 ? "is" : "are", farthest_m, most_offset_m,
      small.size() == 1 ? "that object" : "the objects"));
}

}  // namespace earthshine::scenes
