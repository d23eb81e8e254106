// SPDX-License-Identifier: Apache-2.0
#include "scenes/health/box_join.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace earthshine::scenes {
namespace {

constexpr std::size_t few = 16, many = std::size_t{1} << 12U;
constexpr int deepest = 22;  // single precision resolves no smaller cells

float longest_of(const glm::vec3& size) { return std::max({size.x, size.y, size.z}); }

class Join {
 public:
  explicit Join(const std::function<void(std::uint32_t, std::uint32_t)>& take) : take_(take) {}

  // Joins boxes that overlap low <= x < high, by halving the space along its long sides. Boxes that
  // fill it completely are compared with the others here and do not descend.
  void within(std::vector<LabelledBox> boxes, const glm::vec3& low, const glm::vec3& high,
              int depth) const {
    const auto rest = std::partition(boxes.begin(), boxes.end(), [&](const LabelledBox& box) {
      return glm::all(glm::lessThanEqual(box.low, low)) &&
             glm::all(glm::greaterThanEqual(box.high, high));
    });
    for (auto box = boxes.begin(); box != rest; ++box)
      compare(*box, box + 1, boxes.end(), low, high);
    boxes.erase(boxes.begin(), rest);
    const glm::vec3 size = high - low, middle = 0.5F * (low + high);
    const float longest = longest_of(size);
    float sum = 0.0F;
    for (const LabelledBox& box : boxes) sum += longest_of(box.high - box.low);
    // Cells smaller than the boxes would contain them repeatedly.
    if (boxes.size() <= few || depth == deepest ||
        longest * static_cast<float>(boxes.size()) < 2.0F * sum) {
      for (auto box = boxes.begin(); box != boxes.end(); ++box) {
        compare(*box, box + 1, boxes.end(), low, high);
      }
      return;
    }
    // For each box the octants that it overlaps, one bit each.
    constexpr std::array<std::uint8_t, 3> lower{0x55, 0x33, 0x0F};
    std::vector<std::uint8_t> reaches(boxes.size(), 0xFF);
    struct Octant {
      std::size_t count = 0;
      std::uint32_t label = 0;
      bool mixed = false;
    };
    std::array<Octant, 8> octants;
    for (std::size_t k = 0; k < boxes.size(); ++k) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto i = static_cast<int>(axis);
        const bool parts = size[i] > 0.5F * longest;
        std::uint8_t sides = 0;
        if (!parts || boxes[k].low[i] < middle[i]) sides |= lower[axis];
        if (parts && boxes[k].high[i] >= middle[i])
          sides |= static_cast<std::uint8_t>(~lower[axis]);
        reaches[k] &= sides;
      }
      for (std::size_t o = 0; o < 8; ++o) {
        if (((reaches[k] >> o) & 1U) == 0) continue;
        Octant& octant = octants[o];
        octant.mixed = octant.mixed || (octant.count > 0 && boxes[k].label != octant.label);
        octant.label = boxes[k].label;
        ++octant.count;
      }
    }
    for (std::size_t o = 0; o < 8; ++o) {
      if (!octants[o].mixed) continue;
      std::vector<LabelledBox> inside;
      inside.reserve(octants[o].count);
      for (std::size_t k = 0; k < boxes.size(); ++k) {
        if (((reaches[k] >> o) & 1U) != 0) inside.push_back(boxes[k]);
      }
      glm::vec3 from = low, to = high;
      for (int axis = 0; axis < 3; ++axis) {
        if (size[axis] > 0.5F * longest) (((o >> axis) & 1U) != 0 ? from : to)[axis] = middle[axis];
      }
      within(std::move(inside), from, to, depth + 1);
    }
  }

 private:
  // Reports a pair only in the cell that contains the low corner of its overlap.
  using Boxes = std::vector<LabelledBox>::const_iterator;
  void compare(const LabelledBox& a, Boxes first, Boxes end, const glm::vec3& low,
               const glm::vec3& high) const {
    for (; first != end; ++first) {
      const LabelledBox& b = *first;
      if (a.label == b.label) continue;
      const glm::vec3 begin = glm::max(a.low, b.low);
      if (glm::all(glm::lessThanEqual(begin, glm::min(a.high, b.high))) &&
          glm::all(glm::greaterThanEqual(begin, low)) && glm::all(glm::lessThan(begin, high))) {
        take_(a.item, b.item);
      }
    }
  }

  const std::function<void(std::uint32_t, std::uint32_t)>& take_;
};

// A grid over all boxes that marks cells with several labels: in a fine mesh most boxes are far
// from other labels.
class Meetings {
 public:
  Meetings(const std::vector<LabelledBox>& boxes, const glm::vec3& low, const glm::vec3& high)
      : low_(low) {
    const glm::vec3 size = high - low;
    // About as many cells as boxes, nearly cubic; a flat scene has one layer.
    const float volume = std::max(size.x, 1e-3F * longest_of(size)) *
                         std::max(size.y, 1e-3F * longest_of(size)) *
                         std::max(size.z, 1e-3F * longest_of(size));
    edge_ = std::cbrt(volume / static_cast<float>(boxes.size()));
    for (int axis = 0; axis < 3; ++axis) count_[axis] = 1 + static_cast<int>(size[axis] / edge_);
    std::size_t cells = 0;
    for (const LabelledBox& box : boxes) {
      const glm::ivec3 span = cell_of(box.high) - cell_of(box.low) + 1;
      cells += std::size_t(span.x) * std::size_t(span.y) * std::size_t(span.z);
    }
    if (cells > most_cells_a_box * boxes.size()) return;  // for needles and walls
    labels_.assign(std::size_t(count_.x) * std::size_t(count_.y) * std::size_t(count_.z), nobody);
    for (const LabelledBox& box : boxes) {
      any_cell(box, [&](std::uint32_t& label) {
        label = label == nobody || label == box.label ? box.label : several;
        return false;
      });
    }
  }
  [[nodiscard]] bool meets_others(const LabelledBox& box) {
    return labels_.empty() || any_cell(box, [](std::uint32_t label) { return label == several; });
  }

 private:
  static constexpr std::size_t most_cells_a_box = 16;
  static constexpr std::uint32_t nobody = 0xFFFFFFFFU, several = 0xFFFFFFFEU;

  [[nodiscard]] glm::ivec3 cell_of(const glm::vec3& p) const {
    return glm::ivec3((p - low_) / edge_);
  }
  // Whether any cell that the box overlaps satisfies `is`.
  template <class Is>
  bool any_cell(const LabelledBox& box, const Is& is) {
    const glm::ivec3 from = cell_of(box.low), to = cell_of(box.high);
    for (int z = from.z; z <= to.z; ++z) {
      for (int y = from.y; y <= to.y; ++y) {
        const std::size_t row =
            (std::size_t(z) * std::size_t(count_.y) + std::size_t(y)) * std::size_t(count_.x);
        for (int x = from.x; x <= to.x; ++x) {
          if (is(labels_[row + std::size_t(x)])) return true;
        }
      }
    }
    return false;
  }

  glm::vec3 low_;
  float edge_;
  glm::ivec3 count_{1};
  std::vector<std::uint32_t> labels_;
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
  if (boxes.size() >= many) {
    Meetings meetings(boxes, low, high);
    std::erase_if(boxes, [&](const LabelledBox& box) { return !meetings.meets_others(box); });
  }
  Join(take).within(std::move(boxes), low, high, 0);
}

}  // namespace earthshine::scenes
