// SPDX-License-Identifier: Apache-2.0
#include "radiosity/hidden_factor.h"

#include <algorithm>
#include <cmath>

#include "radiosity/quadrature.h"

namespace earthshine::radiosity {
namespace {

constexpr int most_points = 20000;
constexpr int deepest = 20;  // halvings of one cell
// Error of the 3-point rule over the bend of what it samples: across a kink, and where the
// integrand is smooth (measured; the second grows as the two come close).
constexpr double corner_share = 0.25;  // of a corner's change that counts as bend
constexpr double kink_error = 0.015, smooth_error = 1e-3, near_smooth_error = 1e-2;

// Shadows move across the target by (distance to it) / (distance from the receiver) times the
// point's own way: the receiver is the one whose points see them move less, for its size.
bool second_receives(const Ball& first, const Ball& second,
                     std::span<const ConvexPolygon* const> blockers) {
  Vec3 middle(0.0);
  for (const ConvexPolygon* blocker : blockers) middle += ball_around(*blocker).centre;
  middle /= static_cast<double>(blockers.size());
  const double from_first = glm::length(middle - first.centre);
  const double from_second = glm::length(middle - second.centre);
  return first.radius * from_second > second.radius * from_first;
}

}  // namespace

// The integrand at (x, y) of a quad; its cut's pattern is left in clip_.
double HiddenFactor::at(const Quad& quad, double x, double y) {
  clip_.cut(quad.corner + x * quad.ab + y * quad.ad + (x * y) * quad.twist);
  result_.any_hidden = result_.any_hidden || !clip_.wholly_visible();
  result_.any_visible = result_.any_visible || !clip_.wholly_hidden();
  ++result_.points;
  const double share = add_hidden_ ? clip_.hidden_share(normal_) : clip_.visible_share(normal_);
  return share * glm::length(glm::cross(quad.ab + y * quad.twist, quad.ad + x * quad.twist));
}

void HiddenFactor::sample(Cell& cell) {
  const GaussRule& rule = gauss_rule(3);
  const Quad& quad = quads_[cell.quad];
  const double width = cell.x1 - cell.x0, height = cell.y1 - cell.y0;
  double g[3][3];
  std::uint64_t pattern = 0;
  bool one_pattern = true;
  double sum = 0.0, bend_x = 0.0, bend_y = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      g[i][j] = at(quad, cell.x0 + rule.node[i] * width, cell.y0 + rule.node[j] * height);
      if (i == 0 && j == 0) pattern = clip_.pattern();
      one_pattern = one_pattern && clip_.pattern() == pattern;
      sum += rule.weight[i] * rule.weight[j] * g[i][j];
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    bend_x += rule.weight[k] * std::abs(g[0][k] - 2.0 * g[1][k] + g[2][k]);
    bend_y += rule.weight[k] * std::abs(g[k][0] - 2.0 * g[k][1] + g[k][2]);
  }
  if (one_pattern || bend_x + bend_y == 0.0) {
    // A kink may still pass between the points and a corner, and what all points lose to different
    // blockers may be seen from there.
    one_pattern = true;
    for (int corner = 0; corner < 4; ++corner) {
      const double value =
          at(quad, corner % 2 == 0 ? cell.x0 : cell.x1, corner / 2 == 0 ? cell.y0 : cell.y1);
      if (clip_.pattern() == pattern) continue;
      one_pattern = false;
      const double bend = corner_share * std::abs(value - g[corner % 2 * 2][corner / 2 * 2]);
      bend_x += bend;
      bend_y += bend;
    }
  }
  const double size = width * height, bend = bend_x + bend_y;
  double per_bend = kink_error;
  if (one_pattern) {
    // A smooth integrand's error falls with the third power of its bend.
    const double relative = sum > 0.0 ? bend / sum : 1.0;
    per_bend = std::min(near_ ? near_smooth_error : smooth_error, relative * relative);
  }
  cell.value_m2 = size * sum;
  cell.error_m2 = cell.depth == deepest ? 0.0 : size * per_bend * bend;
  cell.halve_x = bend_x > bend_y || (bend_x == bend_y && width > height);
}

void HiddenFactor::refine() {
  const auto less_error = [](const Cell& a, const Cell& b) { return a.error_m2 < b.error_m2; };
  double error = 0.0;
  for (const Cell& cell : cells_) error += cell.error_m2;
  std::make_heap(cells_.begin(), cells_.end(), less_error);
  while (error > tolerance_m2_ && result_.points < most_points) {
    std::pop_heap(cells_.begin(), cells_.end(), less_error);
    Cell low = cells_.back();
    cells_.pop_back();
    error -= low.error_m2;
    ++low.depth;
    Cell high = low;
    if (low.halve_x) {
      low.x1 = high.x0 = 0.5 * (low.x0 + low.x1);
    } else {
      low.y1 = high.y0 = 0.5 * (low.y0 + low.y1);
    }
    for (Cell* half : {&low, &high}) {
      sample(*half);
      error += half->error_m2;
      cells_.push_back(*half);
      std::push_heap(cells_.begin(), cells_.end(), less_error);
    }
  }
}

void HiddenFactor::set_up(const ConvexPolygon& receiver, const ConvexPolygon& target,
                          std::span<const ConvexPolygon* const> blockers, double margin_m) {
  const Ball ball = ball_around(receiver);
  const TargetFrame frame(target);
  blockers_.clear();
  for (const ConvexPolygon* blocker : blockers) blockers_.push_back(frame.polygon(*blocker));
  clip_.set(frame.polygon(target), blockers_, margin_m);
  normal_ = frame.direction(receiver.normal);
  near_ = distance_m(target, ball.centre) < 3.0 * ball.radius;
  // Near the target only what is hidden is integrated: the rest, with its steep rise towards a
  // shared edge, is known exactly.
  clip_.cut(frame.point(ball.centre));
  add_hidden_ = near_ || clip_.visible_area_share() > 0.5;

  quads_.clear();
  cells_.clear();
  const ConvexPolygon seen = frame.polygon(receiver);
  for (int k = 1; k + 1 < seen.count; k += 2) {
    const Vec3 &a = seen[0], &b = seen[k], &c = seen[k + 1];
    const Vec3& d = k + 2 < seen.count ? seen[k + 2] : c;
    quads_.push_back({a, b - a, d - a, (c - d) - (b - a)});
    cells_.push_back({quads_.size() - 1, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, false, 0});
    sample(cells_.back());
  }
}

HiddenExchange HiddenFactor::exchange(const ConvexPolygon& first, const ConvexPolygon& second,
                                      std::span<const ConvexPolygon* const> blockers,
                                      double unoccluded_m2, double tolerance_m2, double margin_m) {
  const bool swap = second_receives(ball_around(first), ball_around(second), blockers);
  const ConvexPolygon& receiver = swap ? second : first;
  const ConvexPolygon& target = swap ? first : second;
  tolerance_m2_ = tolerance_m2;
  result_ = {};
  set_up(receiver, target, blockers, margin_m);
  // What no point of one saw, in a narrow gap along its border, may be wide in the other's eyes.
  if (!result_.any_visible || !result_.any_hidden) set_up(target, receiver, blockers, margin_m);
  if (!result_.any_visible) return result_;
  if (!result_.any_hidden) {
    result_.exchange_m2 = unoccluded_m2;
    return result_;
  }
  refine();
  double sum = 0.0;
  for (const Cell& cell : cells_) {
    sum += cell.value_m2;
    result_.error_m2 += cell.error_m2;
  }
  result_.exchange_m2 = std::clamp(add_hidden_ ? unoccluded_m2 - sum : sum, 0.0, unoccluded_m2);
  return result_;
}

}  // namespace earthshine::radiosity
