// SPDX-License-Identifier: Apache-2.0
#include "scenes/light/light_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "scenes/light/lamp_light.h"
#include "scenes/light/photometry.h"

namespace earthshine::scenes {
namespace {

using base::pi;

// Below this squared distance, in square metres, no bound is computed.
constexpr double nearest2 = 1e-12;

// cos and sin of max(0, a - b) for angles from 0 to pi (Conty Estevez and Kulla 2018).
struct Angle {
  double cosine, sine;
};
Angle less(const Angle& a, const Angle& b) {
  if (a.cosine >= b.cosine) return {1.0, 0.0};
  return {a.cosine * b.cosine + a.sine * b.sine, a.sine * b.cosine - a.cosine * b.sine};
}
Angle of_cosine(double cosine) {
  const double c = std::clamp(cosine, -1.0, 1.0);
  return {c, std::sqrt(1.0 - c * c)};
}

// The smallest cone that contains two cones (Conty Estevez and Kulla 2018).
void join_axes(LightBounds& a, const LightBounds& b) {
  const double between = std::acos(std::clamp(glm::dot(a.axis, b.axis), -1.0, 1.0));
  if (std::min(between + b.axes_rad, pi) <= a.axes_rad) return;
  if (std::min(between + a.axes_rad, pi) <= b.axes_rad) {
    a.axis = b.axis;
    a.axes_rad = b.axes_rad;
    return;
  }
  const double half = 0.5 * (a.axes_rad + between + b.axes_rad);
  const Vec3 across = b.axis - glm::dot(a.axis, b.axis) * a.axis;
  if (half >= pi || glm::length(across) < 1e-9) {
    a.axes_rad = pi;
    return;
  }
  const double angle = half - a.axes_rad;
  a.axis = glm::normalize(std::cos(angle) * a.axis + std::sin(angle) * glm::normalize(across));
  a.axes_rad = half;
}

LightBounds joined(LightBounds a, const LightBounds& b) {
  join_axes(a, b);
  a.low = glm::min(a.low, b.low);
  a.high = glm::max(a.high, b.high);
  a.reach_rad = std::max(a.reach_rad, b.reach_rad);
  a.falls_by_cosine = a.falls_by_cosine && b.falls_by_cosine;
  a.intensity_cd += b.intensity_cd;
  return a;
}

// Whether a ray hits a box before reach_m.
bool meets(const Vec3& from_centre, const Vec3& direction, const Vec3& half, double reach_m) {
  const double margin = 1e-9 * (1.0 + base::max_component(glm::abs(from_centre)));  // flat boxes
  double near = 0.0, far = reach_m;
  for (int c = 0; c < 3; ++c) {
    const double reach = half[c] + margin;
    if (std::abs(direction[c]) < 1e-12) {
      if (std::abs(from_centre[c]) > reach) return false;
      continue;
    }
    const double middle = -from_centre[c] / direction[c], width = std::abs(reach / direction[c]);
    near = std::max(near, middle - width);
    far = std::min(far, middle + width);
  }
  return near <= far;
}

}  // namespace

LightBounds bounds_of(const Lamp& lamp) {
  LightBounds bounds;
  Vec3 half(0.0);
  bounds.axis = lamp.axis;
  bounds.intensity_cd = base::max_component(lamp.intensity_cd);
  switch (lamp.kind) {
    case LampKind::Point:
    case LampKind::Distant:  // not in the tree
      break;
    case LampKind::Spot:
      bounds.reach_rad = base::radians(lamp.field_deg / 2);
      break;
    case LampKind::Measured: {
      const auto& vertical = lamp.photometry->vertical_rad();
      const bool upward = vertical.front() > 0.0;
      if (upward) bounds.axis = -lamp.axis;
      bounds.reach_rad = upward ? pi - vertical.front() : vertical.back();
      break;
    }
    case LampKind::Rectangle:
    case LampKind::Disk: {
      const bool round = lamp.kind == LampKind::Disk;
      half = round ? lamp.radius_m * glm::sqrt(glm::max(Vec3(0.0), 1.0 - lamp.axis * lamp.axis))
                   : 0.5 * (glm::abs(lamp.edge_u) + glm::abs(lamp.edge_v));
      bounds.intensity_cd = base::max_component(lamp.exitance) * row_of(lamp.kind).area(lamp) / pi;
      bounds.reach_rad = pi / 2;
      bounds.falls_by_cosine = true;
      break;
    }
  }
  bounds.low = lamp.position - half;
  bounds.high = lamp.position + half;
  return bounds;
}

LightTree::LightTree(const std::vector<LightBounds>& lights) {
  if (lights.empty()) return;
  nodes_.reserve(2 * lights.size() - 1);
  std::vector<std::uint32_t> order(lights.size());
  std::iota(order.begin(), order.end(), 0U);
  build(lights, order.data(), order.data() + order.size());
}

std::uint32_t LightTree::build(const std::vector<LightBounds>& lights, std::uint32_t* first,
                               std::uint32_t* last) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  LightBounds bounds = lights[*first];
  Vec3 least(bounds.low + bounds.high), most = least;  // twice the centres
  for (const std::uint32_t* k = first + 1; k < last; ++k) {
    bounds = joined(bounds, lights[*k]);
    least = glm::min(least, lights[*k].low + lights[*k].high);
    most = glm::max(most, lights[*k].low + lights[*k].high);
  }
  const double edge = bounds.axes_rad + bounds.reach_rad;
  const Vec3 half = 0.5 * (bounds.high - bounds.low);
  nodes_.push_back({0.5 * (bounds.low + bounds.high), half, glm::dot(half, half), bounds.axis,
                    std::cos(bounds.axes_rad), std::sin(bounds.axes_rad),
                    edge >= pi ? -1.0 : std::cos(edge), bounds.falls_by_cosine, bounds.intensity_cd,
                    *first, 0});
  if (last - first == 1) return index;
  const Vec3 spread = most - least;
  int axis = spread.x >= spread.y ? 0 : 1;
  if (spread.z > spread[axis]) axis = 2;
  std::uint32_t* middle = first + (last - first) / 2;
  std::nth_element(first, middle, last, [&](std::uint32_t a, std::uint32_t b) {
    const double at_a = lights[a].low[axis] + lights[a].high[axis];
    const double at_b = lights[b].low[axis] + lights[b].high[axis];
    return at_a != at_b ? at_a < at_b : a < b;
  });
  build(lights, first, middle);
  nodes_[index].right = build(lights, middle, last);
  return index;
}

LightTree::Value LightTree::value_of(const Node& node, const Receiver& receiver) {
  const Vec3 offset = node.centre - receiver.point;
  const double distance2 = glm::dot(offset, offset);
  double factor = node.intensity_cd;
  double reflected = receiver.diffuse + receiver.specular;
  if (distance2 > node.radius2 && distance2 > nearest2) {
    const Vec3 direction = offset / std::sqrt(distance2);
    const double sine2 = node.radius2 / distance2;
    const Angle seen{std::sqrt(1.0 - sine2), std::sqrt(sine2)};  // half angle of the sphere
    const bool any_side = receiver.normal == Vec3(0.0);
    const Angle incidence =
        any_side ? Angle{1.0, 0.0} : less(of_cosine(glm::dot(direction, receiver.normal)), seen);
    if (incidence.cosine <= 0.0) return {0.0, 0.0};
    constexpr double rounding = 1e-9;
    const Angle off_axis = less(of_cosine(-glm::dot(direction, node.axis)), seen);
    if (off_axis.cosine < node.cos_edge - rounding) return {0.0, 0.0};
    if (node.falls_by_cosine) {
      const double cosine = less(off_axis, {node.cos_axes, node.sin_axes}).cosine;
      if (cosine <= 0.0) return {0.0, 0.0};
      factor *= cosine;
    }
    factor *= incidence.cosine;
    if (receiver.specular > 0.0) {
      const double cosine = less(of_cosine(glm::dot(direction, receiver.mirrored)), seen).cosine;
      reflected = receiver.diffuse;
      if (cosine > 0.0) reflected += receiver.specular * std::pow(cosine, receiver.shininess);
    }
  }
  const Vec3 beside = glm::max(Vec3(0.0), glm::abs(offset) - node.half);
  const double value = factor * reflected;
  return {value / std::max(glm::dot(beside, beside), nearest2),
          value / std::max({distance2, node.radius2, nearest2})};
}

void LightTree::choose(const Receiver& receiver, double u, double share,
                       std::vector<LightChoice>& chosen) const {
  if (nodes_.empty()) return;
  constexpr std::size_t most_pieces = 64;
  std::array<Piece, most_pieces> pieces;  // a heap, the largest bound first
  std::size_t count = 0;
  const auto lower = [](const Piece& a, const Piece& b) { return a.value.bound < b.value.bound; };
  double total = 0.0;
  const auto push = [&](std::uint32_t node) {
    const Value value = value_of(nodes_[node], receiver);
    if (value.bound <= 0.0) return;
    total += value.estimate;
    pieces[count++] = {node, value};
    std::push_heap(pieces.begin(), pieces.begin() + count, lower);
  };
  push(0);
  // Splits the inner node with the largest bound until no bound exceeds the share.
  while (count > 0 && pieces[0].value.bound > share * total && count < most_pieces) {
    const Piece piece = pieces[0];
    std::pop_heap(pieces.begin(), pieces.begin() + count--, lower);
    const Node& node = nodes_[piece.node];
    if (node.right == 0) {
      chosen.push_back({node.light, 1.0});
      continue;
    }
    total -= piece.value.estimate;
    push(piece.node + 1);
    push(node.right);
  }
  double rest = 0.0;
  for (std::size_t k = 0; k < count; ++k) rest += pieces[k].value.estimate;
  if (!(rest > 0.0)) return;
  std::sort(pieces.begin(), pieces.begin() + count,
            [](const Piece& a, const Piece& b) { return a.node < b.node; });
  const double draws =
      std::ceil(std::min(rest / std::max(share * total, rest * 1e-9), 1.0 / share));
  double before = 0.0;  // cumulative weight, in units of draws
  double next = u;      // the next draw
  for (std::size_t k = 0; k < count; ++k) {
    const double length = draws * pieces[k].value.estimate / rest;
    const bool last = k + 1 == count;  // rounding must not lose the last draw
    for (; next < before + length || (last && next < draws); next += 1.0) {
      const double t = std::clamp((next - before) / length, 0.0, 1.0);
      const auto pick = descend(receiver, pieces[k].node, t);
      if (pick) chosen.push_back({pick->light, 1.0 / (length * pick->probability)});
    }
    before += length;
  }
}

void LightTree::along(const Vec3& origin, const Vec3& direction, double reach_m,
                      std::vector<std::size_t>& lights) const {
  if (!nodes_.empty()) along(0, origin, direction, reach_m, lights);
}

void LightTree::along(std::uint32_t index, const Vec3& origin, const Vec3& direction,
                      double reach_m, std::vector<std::size_t>& lights) const {
  const Node& node = nodes_[index];
  if (!meets(origin - node.centre, direction, node.half, reach_m)) return;
  if (node.right == 0) return lights.push_back(node.light);
  along(index + 1, origin, direction, reach_m, lights);
  along(node.right, origin, direction, reach_m, lights);
}

std::optional<LightTree::Pick> LightTree::descend(const Receiver& receiver, std::uint32_t node,
                                                  double t) const {
  double probability = 1.0;
  while (nodes_[node].right != 0) {
    const double a = value_of(nodes_[node + 1], receiver).estimate;
    const double b = value_of(nodes_[nodes_[node].right], receiver).estimate;
    if (!(a + b > 0.0)) return std::nullopt;  // by its tighter bound, no light reaches the receiver
    const double share = a / (a + b);
    const bool left = t < share || !(b > 0.0);
    t = std::min(left ? t / share : (t - share) / (1.0 - share), 1.0);
    probability *= left ? share : 1.0 - share;
    node = left ? node + 1 : nodes_[node].right;
  }
  return Pick{nodes_[node].light, probability, t};
}

std::optional<LightTree::Pick> LightTree::pick(const Vec3& point, double u) const {
  Receiver receiver;
  receiver.point = point;
  receiver.normal = Vec3(0.0);
  if (nodes_.empty() || !(value_of(nodes_[0], receiver).bound > 0.0)) return std::nullopt;
  return descend(receiver, 0, u);
}

}  // namespace earthshine::scenes
