// SPDX-License-Identifier: Apache-2.0
// The data of each target in a plan.
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/units.h"
#include "studies/sight/sight.h"

namespace earthshine::studies {
namespace {

constexpr int most_parts = 8;
constexpr std::size_t least_pixels = 16;

// Sectors around the centre of the measured pixels, with equal numbers of these.
std::vector<SightTarget::Part> parts_of(const TargetView& view, int columns) {
  const auto count = static_cast<int>(
      std::min<std::size_t>(most_parts, view.measured.size() / (2 * least_pixels)));
  if (count < 2 || view.surround.empty()) return {};
  const auto width = static_cast<std::uint32_t>(columns);
  double x = 0.0, y = 0.0;
  for (const std::uint32_t pixel : view.measured) {
    x += static_cast<double>(pixel % width);
    y += static_cast<double>(pixel / width);
  }
  x /= static_cast<double>(view.measured.size());
  y /= static_cast<double>(view.measured.size());
  const auto angle = [&](std::uint32_t pixel) {
    return std::atan2(static_cast<double>(pixel / width) - y,
                      static_cast<double>(pixel % width) - x);
  };
  std::vector<double> angles;
  for (const std::uint32_t pixel : view.measured) angles.push_back(angle(pixel));
  std::sort(angles.begin(), angles.end());
  std::vector<double> ends;
  for (int k = 1; k < count; ++k) {
    ends.push_back(
        angles[angles.size() * static_cast<std::size_t>(k) / static_cast<std::size_t>(count)]);
  }
  std::vector<SightTarget::Part> parts(static_cast<std::size_t>(count));
  const auto part_of = [&](std::uint32_t pixel) -> SightTarget::Part& {
    const auto at = std::upper_bound(ends.begin(), ends.end(), angle(pixel)) - ends.begin();
    return parts[static_cast<std::size_t>(at)];
  };
  for (const std::uint32_t pixel : view.measured) part_of(pixel).target.push_back(pixel);
  for (const std::uint32_t pixel : view.surround) part_of(pixel).surround.push_back(pixel);
  std::erase_if(parts, [](const SightTarget::Part& part) {
    return part.target.size() < least_pixels || part.surround.size() < least_pixels;
  });
  if (parts.size() < 2) return {};
  double all = 0.0;
  for (const SightTarget::Part& part : parts) all += static_cast<double>(part.target.size());
  for (SightTarget::Part& part : parts) part.share = static_cast<double>(part.target.size()) / all;
  return parts;
}

}  // namespace

SightPlan plan_sight(const scenes::Camera& camera, ObjectMap map, std::vector<TargetView> views) {
  SightPlan plan;
  plan.fov_deg = camera.fov_deg;
  for (TargetView& view : views) {
    SightTarget target;
    for (std::size_t i = 0; view.in_view() && i < map.object.size(); ++i) {
      if (map.object[i] == static_cast<std::int32_t>(view.object)) {
        target.seen.push_back(static_cast<std::uint32_t>(i));
      }
    }
    if (!target.seen.empty()) {
      target.extent = least_extent(target.seen, camera, map.columns, map.rows);
      target.parts = parts_of(view, map.columns);
    }
    target.view = std::move(view);
    plan.targets.push_back(std::move(target));
  }
  plan.map = std::move(map);
  return plan;
}

}  // namespace earthshine::studies
