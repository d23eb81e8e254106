// SPDX-License-Identifier: Apache-2.0
// A monotone point map of the signal, composed of stages: clamp, gain, clip, gamma, quantisation,
// screen. It knows its kinks and its constant intervals, so that the moments of noise can be
// integrated piecewise (degrade/moments/point_moments.h).
#pragma once

#include <vector>

namespace earthshine::degrade {

class PointMap {
 public:
  // Each call appends a step and returns the map, so that calls can be chained.
  PointMap& limit_below(double least);  // max(v, least)
  PointMap& limit_above(double most);   // min(v, most)
  PointMap& amplify(double gain);       // gain > 0
  PointMap& shift(double by);
  PointMap& power(double exponent);  // exponent > 0; 0 where v <= 0
  PointMap& quantise(int bits);      // nearest of 2^bits levels from 0 to 1
  // black + (white - black) clamp(v, 0, 1)^gamma.
  PointMap& screen(double black, double white, double gamma);

  [[nodiscard]] double operator()(double signal) const;

  // Signals, in ascending order, between which the map is smooth.
  [[nodiscard]] const std::vector<double>& kinks() const { return kinks_; }

  // The interval before kinks()[index], or after the last kink.
  struct Stretch {
    bool level = false;
    double value = 0.0;  // if level
  };
  [[nodiscard]] const std::vector<Stretch>& stretches() const { return stretches_; }

 private:
  enum class Kind { LimitBelow, LimitAbove, Amplify, Shift, Power, Quantise };
  struct Step {
    Kind kind;
    double parameter;
  };
  [[nodiscard]] static double forward(const Step& step, double v);
  // Maps the kinks of `step`, at the inputs `at`, back to the signal.
  PointMap& append(Step step, const std::vector<double>& at);

  std::vector<Step> steps_;
  std::vector<double> kinks_;
  std::vector<Stretch> stretches_{1};
};

}  // namespace earthshine::degrade
