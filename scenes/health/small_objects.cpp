// SPDX-License-Identifier: Apache-2.0
#include "scenes/health/small_objects.h"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "scenes/ray_query.h"
#include "scenes/text/message_text.h"
#include "scenes/triangle_point.h"

namespace earthshine::scenes {
namespace {

constexpr double lifts = 20.0;

double diagonal_of(const Scene& scene, const Object& object) {
  Vec3 low = corners_of(scene, object.first_triangle).a, high = low;
  for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
    const auto [a, b, c] = corners_of(scene, object.first_triangle + t);
    low = glm::min(low, glm::min(a, glm::min(b, c)));
    high = glm::max(high, glm::max(a, glm::max(b, c)));
  }
  return glm::length(high - low);
}

}  // namespace

void name_small_objects(Scene& scene) {
  const double lift_m = surface_offset_m(scene);
  std::vector<std::string> small;
  const Object* largest = nullptr;
  double most_m = 0.0;
  for (const Object& object : scene.objects) {
    if (object.triangle_count == 0) continue;
    const double size_m = diagonal_of(scene, object);
    if (size_m < lifts * lift_m) small.push_back(in_quotes(object.name));
    if (size_m > most_m) largest = &object, most_m = size_m;
  }
  if (small.empty()) return;
  scene.warnings.push_back(fmt::format(
      "{} {} smaller than {:.2g} m, in a scene that the object {} ({:.3g} m) makes so wide that "
      "rays start {:.2g} m off surfaces: light and shadow from nearer than that is lost; look at "
      "that object's scale, or leave out what is far away",
      listed(small), small.size() == 1 ? "is" : "are", lifts * lift_m, in_quotes(largest->name),
      most_m, lift_m));
}

}  // namespace earthshine::scenes
