// SPDX-License-Identifier: Apache-2.0
#include "studies/accuracy/findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"

namespace earthshine::studies {
namespace {

using WhichError = PictureError MeasuredStep::*;

std::vector<Trade> trades_of(const std::vector<MeasuredStep>& points, double resolution,
                             WhichError error) {
  std::vector<Trade> trades;
  trades.reserve(points.size());
  for (const MeasuredStep& point : points) {
    trades.push_back(
        {point.step.method, point.cost.cpu_seconds, std::max((point.*error).error, resolution)});
  }
  return trades;
}

std::vector<SeriesLaw> laws_of(const std::vector<MeasuredStep>& points, double resolution) {
  std::vector<SeriesLaw> laws;
  for (const MeasuredStep& point : points) {
    const auto same = [&](const SeriesLaw& law) {
      return law.method == point.step.method && law.series == point.step.series;
    };
    auto found = std::find_if(laws.begin(), laws.end(), same);
    const Spent spent = spent_on(point);
    if (found == laws.end()) {
      laws.push_back({point.step.method, point.step.series, spent.what, {}, std::nullopt});
      found = laws.end() - 1;
    }
    const double error = point.setting_error.error;
    if (spent.amount > 0.0 && error > resolution) found->points.push_back({spent.amount, error});
  }
  for (SeriesLaw& law : laws) {
    law.law = fit_power_law(law.points);
    if (law.law && !law.law->holds()) law.law.reset();
  }
  return laws;
}

// Error times root of the seconds is constant in the number of paths.
std::optional<double> seconds_of_paths(const std::vector<Trade>& trades, double wanted) {
  const Trade* finest = nullptr;
  for (const Trade& trade : trades) {
    if (trade.method == "paths" && (finest == nullptr || trade.seconds > finest->seconds)) {
      finest = &trade;
    }
  }
  if (finest == nullptr || !(wanted > 0.0)) return std::nullopt;
  return finest->seconds * std::pow(finest->error / wanted, 2);
}

// Among one method's points.
std::optional<std::size_t> cheapest_of(const std::vector<Trade>& trades, const std::string& method,
                                       double wanted) {
  std::vector<Trade> own;
  std::vector<std::size_t> place;
  for (std::size_t k = 0; k < trades.size(); ++k) {
    if (trades[k].method != method) continue;
    own.push_back(trades[k]);
    place.push_back(k);
  }
  const auto found = cheapest_within(own, wanted);
  return found ? std::optional(place[*found]) : std::nullopt;
}

Answer answer(const std::vector<Trade>& trades, const std::vector<Trade>& settings,
              const std::vector<Worth>& worth, double wanted, double resolution) {
  Answer result;
  result.wanted = wanted;
  result.is_resolved = resolution <= wanted;
  result.best = cheapest_within(trades, wanted);
  for (const Worth& method : worth) {
    Answer::OfMethod of{method.method, cheapest_of(trades, method.method, wanted),
                        cheapest_of(settings, method.method, wanted), std::nullopt};
    if (!of.point && method.method == "paths") {
      of.expected_seconds = seconds_of_paths(trades, wanted);
    }
    result.methods.push_back(std::move(of));
  }
  return result;
}

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

Spent spent_on(const MeasuredStep& point) {
  const AccuracyStep& step = point.step;
  if (step.series == series::patches) return {double(point.cost.patches), "patches"};
  if (step.series == series::form_factor_rays) return {step.setting, "form-factor rays a patch"};
  if (step.series == series::gather_rays) return {step.setting, "gather rays a pixel"};
  if (step.series == series::camera_samples) {
    return {point.cost.camera_samples, "camera samples a pixel"};
  }
  if (step.series == series::lights) return {step.setting, "lights"};
  if (step.series == series::samples) return {step.setting, "paths a pixel"};
  return {1.0 / step.setting, "1 / --error"};
}

Findings find_accuracy(const std::vector<MeasuredStep>& points, const std::vector<double>& wanted,
                       double resolution) {
  const std::vector<Trade> trades = trades_of(points, resolution, &MeasuredStep::error);
  const std::vector<Trade> settings = trades_of(points, resolution, &MeasuredStep::setting_error);
  Findings findings;
  findings.front = pareto_front(trades);
  findings.worth = worth_of_methods(trades);
  findings.laws = laws_of(points, resolution);
  for (const double error : wanted) {
    findings.answers.push_back(answer(trades, settings, findings.worth, error, resolution));
  }
  return findings;
}

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
  // The fastest point within an error is always on the front: each point of the front is the
  // fastest from its own error up to that of the previous point.
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
