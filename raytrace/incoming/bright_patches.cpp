// SPDX-License-Identifier: Apache-2.0
#include "raytrace/incoming/bright_patches.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "raytrace/tuning.h"

namespace earthshine::raytrace {
namespace {

// The greatest number below 1: a child of probability 0 is never chosen.
constexpr double below_one = 1.0 - 0x1p-53;

}  // namespace

BrightPatches::BrightPatches(const radiosity::Solution& solution) : source_(&solution.patches) {
  const std::size_t count = solution.patches.count();
  if (solution.radiosity.empty()) return;
  std::vector<double> power(count, 0.0);
  double all_power = 0.0, area = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    double luminance = 0.0;
    for (std::size_t k = 0; k < solution.columns; k += 3) {
      const float* b = &solution.radiosity[i * solution.columns + k];
      luminance += base::luminance({b[0], b[1], b[2]});
    }
    power[i] = luminance * solution.patches.area_m2[i];
    all_power += power[i];
    area += solution.patches.area_m2[i];
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    if (power[i] * area > tuning::bright_ratio * all_power * solution.patches.area_m2[i]) {
      patches_.push_back(i);
    }
  }
  if (patches_.empty()) return;
  nodes_.resize(2 * patches_.size() - 1);
  build(all(), power);
  number_.assign(count, none);
  for (std::uint32_t k = 0; k < patches_.size(); ++k) number_[patches_[k]] = k;
}

void BrightPatches::build(const Span& span, const std::vector<double>& flux) {
  Vec3 low(std::numeric_limits<double>::infinity()), high(-low);
  Node& node = nodes_[span.node];
  for (std::uint32_t k = span.begin; k < span.end; ++k) {
    const auto [from, to] = source_->box(patches_[k]);
    low = glm::min(low, from);
    high = glm::max(high, to);
    node.flux += flux[patches_[k]];
  }
  node.centre = 0.5 * (low + high);
  node.half = 0.5 * (high - low);
  node.radius_m = glm::length(node.half);
  if (span.end - span.begin < 2) return;
  const Vec3& size = node.half;
  const int axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
  const auto at = patches_.begin();
  std::nth_element(at + span.begin, at + span.middle(), at + span.end,
                   [&](std::uint32_t a, std::uint32_t b) {
                     const double first = source_->point(a, 0.5, 0.5)[axis],
                                  second = source_->point(b, 0.5, 0.5)[axis];
                     return first != second ? first < second : a < b;
                   });
  build(span.first(), flux);
  build(span.second(), flux);
}

double BrightPatches::Node::sent_to(const Place& place) const {
  const Vec3 offset = centre - place.position;
  const double highest = glm::dot(offset, place.normal) + glm::dot(half, glm::abs(place.normal));
  if (highest <= 0.0) return 0.0;
  const double distance_m = std::max(glm::length(offset), radius_m);
  return flux * std::min(highest / distance_m, 1.0) / (distance_m * distance_m);
}

double BrightPatches::first_share(const Span& span, const Place& from) const {
  const double first = nodes_[span.first().node].sent_to(from),
               both = first + nodes_[span.second().node].sent_to(from);
  return both > 0.0 ? first / both : -1.0;
}

std::optional<BrightPatches::Aim> BrightPatches::aim(const Place& from, double choice, double x,
                                                     double y) const {
  Span span = all();
  while (span.end - span.begin > 1) {
    const double share = first_share(span, from);
    if (share < 0.0) return {};
    const bool to_first = choice < share;
    choice = to_first ? choice / share : std::min((choice - share) / (1.0 - share), below_one);
    span = to_first ? span.first() : span.second();
  }
  const std::uint32_t patch = patches_[span.begin];
  const radiosity::SurfacePoint at = source_->at(patch, x, y);
  const std::uint32_t triangle =
      source_->is_several(patch) ? source_->on_triangle(patch, x, y).triangle : scenes::no_triangle;
  return Aim{patch, triangle, at.position, at.normal};
}

double BrightPatches::density_per_sr(const Place& from, std::uint32_t patch, double distance_m,
                                     double cosine_at_patch) const {
  const std::uint32_t number = number_[patch];
  if (number == none) return 0.0;
  double probability = 1.0;
  for (Span span = all(); span.end - span.begin > 1;) {
    const double share = first_share(span, from);
    if (share < 0.0) return 0.0;
    const bool in_first = number < span.middle();
    probability *= in_first ? share : 1.0 - share;
    span = in_first ? span.first() : span.second();
  }
  return probability / source_->area_m2[patch] * distance_m * distance_m /
         std::max(std::abs(cosine_at_patch), 1e-9);
}

}  // namespace earthshine::raytrace
