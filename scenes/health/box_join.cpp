// SPDX-License-Identifier: Apache-2.0
#include "scenes/health/box_join.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace earthshine::scenes {
namespace {

constexpr std::size_t few = 16;
constexpr int most_halvings = 60;

class Join {
 public:
  explicit Join(const std::function<void(std::uint32_t, std::uint32_t)>& take) : take_(take) {}

  // Boxes that reach into low <= x < high.
  void within(std::vector<LabelledBox> boxes, glm::vec3 low, glm::vec3 high, int halvings) const {
    const bool alone = std::all_of(boxes.begin(), boxes.end(), [&](const LabelledBox& box) {
      return box.label == boxes.front().label;
    });
    if (alone) return;
    const glm::vec3 size = high - low;
    const int axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    const float middle = 0.5F * (low[axis] + high[axis]);
    const bool halves =
        boxes.size() > few && halvings < most_halvings && middle > low[axis] && middle < high[axis];
    std::vector<LabelledBox> upper;
    std::size_t lower = boxes.size();
    if (halves) {
      std::copy_if(boxes.begin(), boxes.end(), std::back_inserter(upper),
                   [&](const LabelledBox& box) { return box.high[axis] >= middle; });
      lower = static_cast<std::size_t>(
          std::count_if(boxes.begin(), boxes.end(),
                        [&](const LabelledBox& box) { return box.low[axis] < middle; }));
    }
    if (!halves || (upper.size() == boxes.size() && lower == boxes.size())) {
      return compare(boxes, low, high);
    }
    std::erase_if(boxes, [&](const LabelledBox& box) { return box.low[axis] >= middle; });
    glm::vec3 end = high, start = low;
    end[axis] = start[axis] = middle;
    within(std::move(boxes), low, end, halvings + 1);
    within(std::move(upper), start, high, halvings + 1);
  }

 private:
  // A pair is of the space where both begin: of no other.
  void compare(const std::vector<LabelledBox>& boxes, const glm::vec3& low,
               const glm::vec3& high) const {
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      for (std::size_t j = i + 1; j < boxes.size(); ++j) {
        const LabelledBox &a = boxes[i], &b = boxes[j];
        if (a.label == b.label) continue;
        const glm::vec3 begin = glm::max(a.low, b.low);
        if (glm::any(glm::greaterThan(begin, glm::min(a.high, b.high)))) continue;
        if (glm::any(glm::lessThan(begin, low)) || glm::any(glm::greaterThanEqual(begin, high))) {
          continue;
        }
        take_(a.item, b.item);
      }
    }
  }

  const std::function<void(std::uint32_t, std::uint32_t)>& take_;
};

}  // namespace

void join_boxes(std::vector<LabelledBox> boxes,
                const std::function<void(std::uint32_t, std::uint32_t)>& take) {
  if (boxes.empty()) return;
  glm::vec3 low = boxes.front().low, high = boxes.front().high;
  for (const LabelledBox& box : boxes) {
    low = glm::min(low, box.low);
    high = glm::max(high, box.high);
  }
  for (int axis = 0; axis < 3; ++axis) {
    high[axis] = std::nextafter(high[axis], std::numeric_limits<float>::infinity());
  }
  Join(take).within(std::move(boxes), low, high, 0);
}

}  // namespace earthshine::scenes
