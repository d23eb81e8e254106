// SPDX-License-Identifier: Apache-2.0
#include "scenes/health/small_objects.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "scenes/ray_query.h"
#include "scenes/text/message_text.h"
#include "scenes/triangle_point.h"

namespace earthshine::scenes {
namespace {

constexpr double lifts = 20.0;
constexpr double much_narrower = 0.5;   // times as wide
constexpr double least_scene_m = 1e-5;  // smaller ones have lifts of a fixed size

Box box_of(const Scene& scene, const Object& object) {
  Box box;
  for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
    const auto [a, b, c] = corners_of(scene, object.first_triangle + t);
    box.add(a), box.add(b), box.add(c);
  }
  return box;
}

Box both(Box box, const Box& other) {
  box.add(other);
  return box;
}

// What the scene is across without one of the boxes, for each.
std::vector<double> without_each(const std::vector<Box>& boxes) {
  std::vector<Box> before(boxes.size() + 1), after(boxes.size() + 1);
  for (std::size_t k = 0; k < boxes.size(); ++k) before[k + 1] = both(before[k], boxes[k]);
  for (std::size_t k = boxes.size(); k-- > 0;) after[k] = both(after[k + 1], boxes[k]);
  std::vector<double> across;
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    across.push_back(both(before[k], after[k + 1]).diagonal());
  }
  return across;
}

}  // namespace

void name_small_objects(Scene& scene) {
  const double lift_m = surface_offset_m(scene);
  std::vector<std::string> names, small;
  std::vector<Box> boxes;
  Box all;
  for (const Object& object : scene.objects) {
    if (object.triangle_count == 0) continue;
    names.push_back(in_quotes(object.name));
    boxes.push_back(box_of(scene, object));
    all.add(boxes.back());
    if (boxes.back().diagonal() < lifts * lift_m) small.push_back(names.back());
  }
  if (small.empty() || all.diagonal() < least_scene_m) return;
  const std::vector<double> without = without_each(boxes);
  const auto narrows = [&](double across) { return across < much_narrower * all.diagonal(); };
  std::string across = fmt::format("{:.3g} m across", all.diagonal()),
              advice = "the objects' places and scales";
  // Of two objects far apart each does it: neither is the one.
  if (std::ranges::count_if(without, narrows) == 1) {
    const auto one = std::ranges::find_if(without, narrows);
    const std::string& name = names[static_cast<std::size_t>(one - without.begin())];
    across += fmt::format(", {:.3g} m without {}", *one, name);
    advice = "that object's place and scale";
  }
  scene.warnings.push_back(fmt::format(
      "{} {} smaller than {:.2g} m, in a scene that is {}, so that rays start {:.2g} m off "
      "surfaces: light and shadow from nearer than that is lost; look at {}, or leave out what is "
      "far away",
      listed(small), small.size() == 1 ? "is" : "are", lifts * lift_m, across, lift_m, advice));
}

}  // namespace earthshine::scenes
