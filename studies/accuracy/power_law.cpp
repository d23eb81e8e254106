// SPDX-License-Identifier: Apache-2.0
#include "studies/accuracy/power_law.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"

namespace earthshine::studies {
namespace {

// All in logarithms: t = ln x, y = ln error. Parameters: ln a, p, ln floor.
struct LogPoint {
  double t = 0.0, y = 0.0;
};
using Parameters = Eigen::Vector3d;

// y and its derivatives by the parameters. `used` = 2: no floor.
double model(const Parameters& at, Eigen::Index used, double t, Parameters& slope) {
  const double fall = at[0] - at[1] * t;
  if (used == 2) {
    slope << 1.0, -t, 0.0;
    return fall;
  }
  // ln sqrt(e^2u + e^2v) without overflow; s is the falling part's share of the square.
  const double high = std::max(fall, at[2]), low = std::min(fall, at[2]);
  const double y = high + 0.5 * std::log1p(std::exp(2.0 * (low - high)));
  const double s = 1.0 / (1.0 + std::exp(2.0 * (at[2] - fall)));
  slope << s, -s * t, 1.0 - s;
  return y;
}

double squares(const std::vector<LogPoint>& points, const Parameters& at, Eigen::Index used) {
  double sum = 0.0;
  Parameters slope;
  for (const LogPoint& point : points) {
    sum += std::pow(point.y - model(at, used, point.t, slope), 2);
  }
  return sum;
}

// m^-1 r for the parameters in use; empty if m is singular.
std::optional<Parameters> solve(const Eigen::Matrix3d& m, const Parameters& r, Eigen::Index used) {
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(m.topLeftCorner(used, used));
  if (!lu.isInvertible()) return std::nullopt;
  Parameters step = Parameters::Zero();
  step.head(used) = lu.solve(r.head(used));
  return step;
}

struct Fit {
  Parameters at = Parameters::Zero();
  double squares = 0.0;
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
};

Fit descend(const std::vector<LogPoint>& points, const Parameters& start, Eigen::Index used) {
  constexpr int rounds = 500;
  Fit fit{start, squares(points, start, used)};
  double damping = 1e-3;
  for (int round = 0; round < rounds && damping < 1e12; ++round) {
    fit.normal.setZero();
    Parameters right = Parameters::Zero(), slope;
    for (const LogPoint& point : points) {
      const double off = point.y - model(fit.at, used, point.t, slope);
      right += slope * off;
      fit.normal += slope * slope.transpose();
    }
    Eigen::Matrix3d damped = fit.normal;
    damped.diagonal() *= 1.0 + damping;
    const auto step = solve(damped, right, used);
    if (!step) break;
    const Parameters next = fit.at + *step;
    const double sum = squares(points, next, used);
    if (!(sum <= fit.squares)) {
      damping *= 4.0;
      continue;
    }
    const bool still = fit.squares - sum <= 1e-15 * fit.squares;
    fit.at = next;
    fit.squares = sum;
    if (still) break;
    damping = std::max(1e-12, damping / 8.0);
  }
  return fit;
}

// Without a floor the model is a straight line, which Gauss-Newton reaches in one step.
Fit fit_line(const std::vector<LogPoint>& points) {
  return descend(points, Parameters(0.0, 0.5, 0.0), 2);
}

// The problem is not convex in the floor: tries several starts below the least error.
Fit fit_floor(const std::vector<LogPoint>& points, const Fit& line) {
  double least = points.front().y;
  for (const LogPoint& point : points) least = std::min(least, point.y);
  Fit best;
  best.squares = std::numeric_limits<double>::infinity();
  for (const double share : {0.999, 0.95, 0.8, 0.5, 0.2}) {
    for (const double steeper : {1.0, 1.5, 2.5}) {
      Parameters start = line.at;
      start[1] *= steeper;
      start[0] = points.front().y + start[1] * points.front().t;
      start[2] = least + std::log(share);
      const Fit fit = descend(points, start, 3);
      if (fit.squares < best.squares) best = fit;
    }
  }
  return best;
}

void check(const ErrorAt& point) {
  const bool good =
      std::isfinite(point.x) && std::isfinite(point.error) && point.x > 0.0 && point.error >= 0.0;
  if (good) return;
  throw base::Error(base::Blame::Work, "power law",
                    fmt::format("an error of {} at {} cannot be fitted", point.error, point.x),
                    "positive finite numbers");
}

}  // namespace

double PowerLaw::error_at(double x) const {
  return std::hypot(factor * std::pow(x, -exponent), floor);
}

bool PowerLaw::holds() const {
  constexpr double known_to = 0.25, steepest = 2.5;
  return exponent_error && *exponent_error <= known_to && exponent > 2.0 * *exponent_error &&
         exponent <= steepest;
}

std::optional<PowerLaw> fit_power_law(const std::vector<ErrorAt>& points) {
  std::vector<LogPoint> log;
  for (const ErrorAt& point : points) {
    check(point);
    if (point.error > 0.0) log.push_back({std::log(point.x), std::log(point.error)});
  }
  std::sort(log.begin(), log.end(), [](const auto& a, const auto& b) { return a.t < b.t; });
  std::size_t places = log.empty() ? 0 : 1;
  for (std::size_t k = 1; k < log.size(); ++k) places += log[k].t > log[k - 1].t ? 1 : 0;
  if (places < 2) return std::nullopt;

  Eigen::Index used = 2;
  Fit fit = fit_line(log);
  const auto n = static_cast<double>(log.size());
  // Points that fit a line to 1e-6 have no significant floor.
  if (places >= 4 && fit.squares > 1e-12 * n && fit.at[1] > 0.0) {
    const Fit floored = fit_floor(log, fit);
    if (fit.squares - floored.squares > 4.0 * floored.squares / (n - 3.0) && floored.at[1] > 0.0) {
      fit = floored;
      used = 3;
    }
  }
  PowerLaw law;
  law.points = log.size();
  law.factor = std::exp(fit.at[0]);
  law.exponent = fit.at[1];
  law.floor = used == 3 ? std::exp(fit.at[2]) : 0.0;
  const double left = n - static_cast<double>(used);
  const auto variance = solve(fit.normal, Parameters::UnitY(), used);
  if (left > 0.0 && variance) {
    law.exponent_error = std::sqrt(std::max(0.0, (*variance)[1] * fit.squares / left));
  }
  return law;
}

}  // namespace earthshine::studies
