// SPDX-License-Identifier: Apache-2.0
#include "radiosity/exact/hidden_factor.h"

#include <algorithm>
#include <cmath>

#include "radiosity/exact/polygon/convex_polygon.h"

namespace earthshine::radiosity {
namespace {

constexpr int most_points = 20000;
constexpr int deepest = 20;  // bisections of one cell
constexpr double corner_inset = 1e-6;
// Error of the 3-point rule across a kink, relative to the deviation of the four corners from the
// parabola through its points: an approximate upper bound (derived for kinks parallel to a side).
constexpr double error_per_corner = 0.05;
// Weights of the three Gauss points that extrapolate a parabola to the border next to the first.
constexpr double to_border[3] = {1.4788305577012361, -2.0 / 3.0, 0.18783610896543051};

// A shadow moves over the target by (distance to target) / (distance to receiver) times the point's
// displacement: the receiver is the polygon for which this is smaller relative to its size.
bool second_receives(const Ball& first, const Ball& second,
                     std::span<const Blocker* const> blockers) {
  Vec3 middle(0.0);
  for (const Blocker* blocker : blockers) middle += ball_around(blocker->shape).centre;
  middle /= static_cast<double>(blockers.size());
  const double from_first = glm::length(middle - first.centre);
  const double from_second = glm::length(middle - second.centre);
  return first.radius * from_second > second.radius * from_first;
}

}  // namespace

// The integrand at (x, y) of a quadrilateral.
double HiddenFactor::at(const Quad& quad, double x, double y) {
  clip_.cut(quad.corner + x * quad.ab + y * quad.ad + (x * y) * quad.twist);
  result_.any_hidden = result_.any_hidden || !clip_.wholly_visible();
  result_.any_visible = result_.any_visible || !clip_.wholly_hidden();
  ++result_.points;
  const double share = add_hidden_ ? clip_.hidden_share(normal_) : clip_.visible_share(normal_);
  return share * glm::length(glm::cross(quad.ab + y * quad.twist, quad.ad + x * quad.twist));
}

void HiddenFactor::sample(Cell& cell) {
  const base::GaussRule& rule = base::gauss_rule(3);
  const Quad& quad = quads_[cell.quad];
  const double width = cell.x1 - cell.x0, height = cell.y1 - cell.y0;
  double g[3][3];
  double sum = 0.0, bend_x = 0.0, bend_y = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      g[i][j] = at(quad, cell.x0 + rule.node[i] * width, cell.y0 + rule.node[j] * height);
      sum += rule.weight[i] * rule.weight[j] * g[i][j];
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    bend_x += rule.weight[k] * std::abs(g[0][k] - 2.0 * g[1][k] + g[2][k]);
    bend_y += rule.weight[k] * std::abs(g[k][0] - 2.0 * g[k][1] + g[k][2]);
  }
  // Deviation from the biquadratic through the nine points, at the corners, slightly inset: on a
  // patch's border, in the planes of adjacent faces, shadows change discontinuously.
  const double inset_x = corner_inset * width, inset_y = corner_inset * height;
  double off[2][2];
  double off_sum = 0.0;
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t j = 0; j < 2; ++j) {
      double expected = 0.0;
      for (std::size_t k = 0; k < 9; ++k) {
        expected += to_border[i == 0 ? k / 3 : 2 - k / 3] * to_border[j == 0 ? k % 3 : 2 - k % 3] *
                    g[k / 3][k % 3];
      }
      off[i][j] = at(quad, i == 0 ? cell.x0 + inset_x : cell.x1 - inset_x,
                     j == 0 ? cell.y0 + inset_y : cell.y1 - inset_y) -
                  expected;
      off_sum += std::abs(off[i][j]);
    }
  }
  bend_x += std::abs(off[0][0] - off[1][0]) + std::abs(off[0][1] - off[1][1]);
  bend_y += std::abs(off[0][0] - off[0][1]) + std::abs(off[1][0] - off[1][1]);
  cell.value_m2 = width * height * sum;
  cell.error_m2 = cell.depth == deepest ? 0.0 : width * height * error_per_corner * off_sum;
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
      low.x1 = high.x0 = kinks_.split_x(low.x0, low.x1);
    } else {
      low.y1 = high.y0 = kinks_.split_y(low.y0, low.y1);
    }
    for (Cell* half : {&low, &high}) {
      sample(*half);
      error += half->error_m2;
      cells_.push_back(*half);
      std::push_heap(cells_.begin(), cells_.end(), less_error);
    }
  }
}

// Early complete occlusion saves work, and few large cuts leave fewer parts than many small ones.
void HiddenFactor::put_largest_shadow_first(const Vec3& from, double margin_m) {
  shadows_.clear();
  for (std::size_t k = 0; k < blockers_.size(); ++k) {
    clip_.set(*frame_, target_, {&blockers_[k], 1}, margin_m);
    clip_.cut(from);
    shadows_.emplace_back(clip_.visible_area_share(), k);
  }
  std::sort(shadows_.begin(), shadows_.end());
  ordered_.clear();
  for (const auto& [visible, k] : shadows_) ordered_.push_back(blockers_[k]);
  blockers_.swap(ordered_);
}

void HiddenFactor::set_up(const ConvexPolygon& receiver, const ConvexPolygon& target,
                          std::span<const Blocker* const> blockers, double margin_m) {
  const Ball ball = ball_around(receiver);
  const TargetFrame& frame = frame_.emplace(target);
  blockers_.clear();
  for (const Blocker* blocker : blockers) {
    const bool known = blocker->whole_body &&
                       std::any_of(blockers_.begin(), blockers_.end(), [&](const Blocker& b) {
                         return b.whole_body && b.body == blocker->body;
                       });
    if (known) continue;
    blockers_.push_back({frame.polygon(blocker->shape), blocker->body, blocker->whole_body});
  }
  target_ = frame.polygon(target);
  put_largest_shadow_first(frame.point(ball.centre), margin_m);
  clip_.set(frame, target_, blockers_, margin_m);
  normal_ = frame.direction(receiver.normal);
  // Near the target only the hidden part is integrated: the rest, with its steep rise toward a
  // shared edge, is known exactly.
  clip_.cut(frame.point(ball.centre));
  const bool near = distance_m(target, ball.centre) < 3.0 * ball.radius;
  add_hidden_ = near || clip_.visible_area_share() > 0.5;

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
                                      std::span<const Blocker* const> blockers,
                                      double unoccluded_m2, double tolerance_m2, double margin_m) {
  const bool swap = second_receives(ball_around(first), ball_around(second), blockers);
  const ConvexPolygon& receiver = swap ? second : first;
  const ConvexPolygon& target = swap ? first : second;
  tolerance_m2_ = tolerance_m2;
  result_ = {};
  set_up(receiver, target, blockers, margin_m);
  // A narrow gap at the border of one polygon may be wide as seen from the other one.
  if (!result_.any_visible || !result_.any_hidden) set_up(target, receiver, blockers, margin_m);
  if (!result_.any_visible) return result_;
  if (!result_.any_hidden) {
    result_.exchange_m2 = unoccluded_m2;
    return result_;
  }
  if (cells_.size() == 1) {
    kinks_.find(quads_[0].corner, quads_[0].ab, quads_[0].ad, *frame_, target_, blockers_);
  } else {
    kinks_.clear();
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
