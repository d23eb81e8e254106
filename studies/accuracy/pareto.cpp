// SPDX-License-Identifier: Apache-2.0
#include "studies/accuracy/pareto.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"

namespace earthshine::studies {
namespace {

void check(const std::vector<Trade>& points) {
  for (const Trade& point : points) {
    if (std::isfinite(point.seconds) && std::isfinite(point.error) && point.seconds >= 0.0 &&
        point.error >= 0.0) {
      continue;
    }
    throw base::Error(
        base::Blame::Work, point.method,
        fmt::format("{} seconds for an error of {} cannot be compared", point.seconds, point.error),
        "finite numbers from 0");
  }
}

}  // namespace

std::vector<std::size_t> pareto_front(const std::vector<Trade>& points) {
  check(points);
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    if (points[a].seconds != points[b].seconds) return points[a].seconds < points[b].seconds;
    return points[a].error < points[b].error;
  });
  std::vector<std::size_t> front;
  for (const std::size_t k : order) {
    if (front.empty() || points[k].error < points[front.back()].error) front.push_back(k);
  }
  return front;
}

std::optional<std::size_t> cheapest_within(const std::vector<Trade>& points, double wanted) {
  for (const std::size_t k : pareto_front(points)) {
    if (points[k].error <= wanted) return k;
  }
  return std::nullopt;
}

std::vector<Worth> worth_of_methods(const std::vector<Trade>& points) {
  const std::vector<std::size_t> front = pareto_front(points);
  std::vector<Worth> worth;
  for (const Trade& point : points) {
    const bool known = std::any_of(worth.begin(), worth.end(),
                                   [&](const Worth& w) { return w.method == point.method; });
    if (!known) worth.push_back({point.method, false, 0.0, ""});
  }
  // The fastest point within an error is always on the front: each of its points is the answer from
  // its own error up to that of the one before.
  for (Worth& w : worth) {
    for (std::size_t k = 0; k < front.size(); ++k) {
      if (points[front[k]].method != w.method) continue;
      w.ever = true;
      w.down_to = points[front[k]].error;
      w.then = k + 1 < front.size() ? points[front[k + 1]].method : "";
    }
  }
  return worth;
}

}  // namespace earthshine::studies
