// SPDX-License-Identifier: Apache-2.0
#include "degrade/stage/point_map.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "base/error.h"

namespace earthshine::degrade {
namespace {

double checked_positive(double value, const char* what) {
  if (value > 0.0 && std::isfinite(value)) return value;
  throw base::Error(base::Blame::Input, "point map",
                    std::string(what) + " " + std::to_string(value),
                    std::string(what) + " is a number above 0",
                    "A map that falls or stands still has no moments here");
}

}  // namespace

PointMap& PointMap::limit_below(double least) { return append({Kind::LimitBelow, least}, {least}); }
PointMap& PointMap::limit_above(double most) { return append({Kind::LimitAbove, most}, {most}); }
PointMap& PointMap::amplify(double gain) {
  return append({Kind::Amplify, checked_positive(gain, "gain")}, {});
}
PointMap& PointMap::shift(double by) { return append({Kind::Shift, by}, {}); }
PointMap& PointMap::power(double exponent) {
  return append({Kind::Power, checked_positive(exponent, "exponent")}, {0.0});
}

PointMap& PointMap::quantise(int bits) {
  const double steps = std::ldexp(1.0, bits) - 1.0;
  std::vector<double> at;
  for (double k = 0.5; k < steps; k += 1.0) at.push_back(k / steps);
  return append({Kind::Quantise, steps}, at);
}

PointMap& PointMap::screen(double black, double white, double gamma) {
  limit_below(0.0).limit_above(1.0).power(gamma);
  if (white == black) return limit_above(0.0).shift(black);
  return amplify(white - black).shift(black);
}

double PointMap::forward(const Step& step, double v) {
  switch (step.kind) {
    case Kind::LimitBelow:
      return std::max(v, step.parameter);
    case Kind::LimitAbove:
      return std::min(v, step.parameter);
    case Kind::Amplify:
      return v * step.parameter;
    case Kind::Shift:
      return v + step.parameter;
    case Kind::Power:
      return v > 0.0 ? std::pow(v, step.parameter) : 0.0;
    case Kind::Quantise:
      return std::round(std::clamp(v, 0.0, 1.0) * step.parameter) / step.parameter;
  }
  return v;
}

double PointMap::operator()(double signal) const {
  for (const Step& step : steps_) signal = forward(step, signal);
  return signal;
}

PointMap& PointMap::append(Step step, const std::vector<double>& at) {
  // All steps are monotone, so that a value has one preimage, none, or an interval whose ends are
  // already kinks.
  const auto signal_behind = [&](double v) -> std::optional<double> {
    for (auto before = steps_.rbegin(); before != steps_.rend(); ++before) {
      switch (before->kind) {
        case Kind::LimitBelow:
          if (v <= before->parameter) return {};
          break;
        case Kind::LimitAbove:
          if (v >= before->parameter) return {};
          break;
        case Kind::Amplify:
          v /= before->parameter;
          break;
        case Kind::Shift:
          v -= before->parameter;
          break;
        case Kind::Power:
          if (v <= 0.0) return {};
          v = std::pow(v, 1.0 / before->parameter);
          break;
        case Kind::Quantise:
          return {};
      }
    }
    return v;
  };
  for (const double v : at) {
    if (const std::optional<double> signal = signal_behind(v)) kinks_.push_back(*signal);
  }
  steps_.push_back(step);
  std::sort(kinks_.begin(), kinks_.end());
  kinks_.erase(std::unique(kinks_.begin(), kinks_.end()), kinks_.end());

  stretches_.assign(kinks_.size() + 1, {});
  for (std::size_t k = 0; k < stretches_.size() && !kinks_.empty(); ++k) {
    const double left = k > 0 ? kinks_[k - 1] : kinks_.front() - 1.0;
    const double right = k < kinks_.size() ? kinks_[k] : kinks_.back() + 1.0;
    const double value = (*this)(0.75 * left + 0.25 * right);
    stretches_[k] = {value == (*this)(0.25 * left + 0.75 * right), value};
  }
  return *this;
}

}  // namespace earthshine::degrade
