// SPDX-License-Identifier: Apache-2.0
#include "studies/compare/ladder.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace earthshine::studies {
namespace {

constexpr double level_share = 0.9;  // of an error that is hardly noise any more
constexpr double no_cheaper = 0.9;   // of the seconds: lower rungs that save less save nothing

class Climb {
 public:
  Climb(const std::function<LadderPoint(int)>& draw, const LadderLimits& limits)
      : draw_(draw), limits_(limits) {}

  Ladder run() {
    down_to_the_time();
    up_to_the_time();
    if (limits_.wanted_error) {
      up_to_the_error();
      down_to_the_error();
    }
    return result();
  }

 private:
  const LadderPoint& at(int rung) {
    const auto found = points_.find(rung);
    return found != points_.end() ? found->second
                                  : points_.emplace(rung, draw_(rung)).first->second;
  }
  [[nodiscard]] const LadderPoint& top() const { return points_.rbegin()->second; }
  [[nodiscard]] const LadderPoint& bottom() const { return points_.begin()->second; }
  [[nodiscard]] bool reaches(const LadderPoint& point) const {
    return point.error <= *limits_.wanted_error;
  }
  [[nodiscard]] bool any_reaches() const {
    return std::any_of(points_.begin(), points_.end(),
                       [&](const auto& entry) { return reaches(entry.second); });
  }
  // By the seconds really spent: a rung up need not have cast more rays.
  [[nodiscard]] bool levelled() const {
    if (points_.size() < 2) return false;
    const LadderPoint& dearer = top();
    const LadderPoint& cheaper = std::next(points_.rbegin())->second;
    if (dearer.seconds < 1.5 * cheaper.seconds) return false;
    const double floor = error_floor(cheaper, dearer);
    return floor > *limits_.wanted_error && floor >= level_share * dearer.error;
  }

  static int rungs_between(double seconds, double wanted) {
    return std::max(1, static_cast<int>(std::floor(std::log2(wanted / std::max(1e-9, seconds)))));
  }

  void down_to_the_time() {
    const LadderPoint* lowest = &at(std::clamp(0, limits_.least_rung, limits_.most_rung));
    while (lowest->seconds > time_slack * limits_.seconds && lowest->rung > limits_.least_rung) {
      const int step = rungs_between(limits_.seconds, lowest->seconds);
      const double before = lowest->seconds;
      lowest = &at(std::max(limits_.least_rung, lowest->rung - step));
      if (lowest->seconds > no_cheaper * before) break;
    }
    // It may have gone further down than it had to.
    for (int rung = lowest->rung + 1; lowest->seconds <= time_slack * limits_.seconds; ++rung) {
      const auto next = points_.upper_bound(lowest->rung);
      if (next == points_.end() || rung >= next->first) break;
      if (at(rung).seconds > time_slack * limits_.seconds) break;
    }
  }

  void up_to(double seconds) {
    const int step = rungs_between(top().seconds, seconds);
    (void)at(std::min(limits_.most_rung, top().rung + step));
  }
  void up_to_the_time() {
    while (2.0 * top().seconds <= time_slack * limits_.seconds && top().rung < limits_.most_rung) {
      up_to(limits_.seconds);
    }
  }
  void up_to_the_error() {
    const double most = limits_.spend * limits_.seconds;
    while (!any_reaches() && !levelled() && top().rung < limits_.most_rung &&
           2.0 * top().seconds <= time_slack * most) {
      up_to(most);
    }
  }

  void down_to_the_error() {
    if (!any_reaches()) return;
    for (int step = 1; reaches(bottom()) && bottom().rung > limits_.least_rung; step *= 2) {
      const double before = bottom().seconds;
      if (at(std::max(limits_.least_rung, bottom().rung - step)).seconds > no_cheaper * before) {
        break;
      }
    }
    const auto first = std::find_if(points_.begin(), points_.end(),
                                    [&](const auto& entry) { return reaches(entry.second); });
    if (first == points_.begin()) return;
    int fails = std::prev(first)->first, does = first->first;
    while (does - fails > 1) {
      const int middle = fails + (does - fails) / 2;
      (reaches(at(middle)) ? does : fails) = middle;
    }
  }

  [[nodiscard]] Ladder result() const {
    Ladder ladder;
    for (const auto& [rung, point] : points_) ladder.points.push_back(point);
    bool reached = false;
    for (std::size_t k = 0; k < ladder.points.size(); ++k) {
      const LadderPoint& point = ladder.points[k];
      if (point.seconds <= time_slack * limits_.seconds) ladder.at_time = k;
      if (reached) continue;
      reached = limits_.wanted_error && reaches(point);
      if (reached || point.error < ladder.points[ladder.at_error].error) ladder.at_error = k;
    }
    ladder.end = reached                              ? LadderEnd::Reached
                 : limits_.wanted_error && levelled() ? LadderEnd::LevelsOut
                                                      : LadderEnd::NotWithin;
    return ladder;
  }

  const std::function<LadderPoint(int)>& draw_;
  const LadderLimits& limits_;
  std::map<int, LadderPoint> points_;
};

}  // namespace

double error_floor(const LadderPoint& cheaper, const LadderPoint& dearer) {
  const double ratio = dearer.seconds / cheaper.seconds;
  if (!(ratio > 1.0)) return 0.0;
  const double square =
      (ratio * dearer.error * dearer.error - cheaper.error * cheaper.error) / (ratio - 1.0);
  return std::sqrt(std::max(0.0, square));
}

Ladder climb(const std::function<LadderPoint(int)>& draw, const LadderLimits& limits) {
  return Climb(draw, limits).run();
}

}  // namespace earthshine::studies
