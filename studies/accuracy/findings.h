// SPDX-License-Identifier: Apache-2.0
// What follows from the measured points of `study accuracy`: laws, the front, what is worth it, the
// setting to use.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "studies/accuracy/accuracy.h"
#include "studies/accuracy/power_law.h"

namespace earthshine::studies {

// Which settings are worth their time: the Pareto front of (seconds, error), down to which error
// each method is the cheapest, and the cheapest setting for a wanted error.

struct Trade {
  std::string method;
  double seconds = 0.0;
  double error = 0.0;
};

// Functions below throw base::Error (Work) for a number that is negative or not finite.

// Indices of the points that no other one beats, by rising seconds: none is at least as fast and as
// exact, and better in one of the two. Of points alike in both the first one stands.
[[nodiscard]] std::vector<std::size_t> pareto_front(const std::vector<Trade>& points);

// The fastest point whose error is at most `wanted`; of equally fast ones the most exact.
[[nodiscard]] std::optional<std::size_t> cheapest_within(const std::vector<Trade>& points,
                                                         double wanted);

// Where a method is the cheapest way. It is so at an error e if the fastest of all points with
// error <= e is one of its own.
struct Worth {
  std::string method;
  bool ever = false;     // for some error it is the cheapest
  double down_to = 0.0;  // the least error that it is the cheapest way to
  std::string then;      // the method that is cheaper just below; "": none measured gets there
};
// One for each method, in the order in which they first appear.
[[nodiscard]] std::vector<Worth> worth_of_methods(const std::vector<Trade>& points);

struct MeasuredStep {
  AccuracyStep step;
  StepCost cost;
  PictureError error;          // against the full truth
  PictureError setting_error;  // against the method's own limit
};

// A series and its law, of the setting's error. Points below the reference's resolution stay out.
struct SeriesLaw {
  std::string method, series;
  std::string spent;  // what x counts: "patches", "camera samples a pixel"
  std::vector<ErrorAt> points;
  std::optional<PowerLaw> law;  // where it holds
};

// The cheapest settings measured for a wanted error, by CPU seconds.
struct Answer {
  double wanted = 0.0;
  bool told = true;                 // the reference is fine enough to tell
  std::optional<std::size_t> best;  // of the measured points; none: not reached
  struct OfMethod {
    std::string method;
    std::optional<std::size_t> point;  // its picture is that exact
    // Its setting is: what is left is the method's own limit, which no setting takes away.
    std::optional<std::size_t> setting;
    // Not reached by paths: CPU seconds that they would take, error falling with their root.
    std::optional<double> expected_seconds;
  };
  std::vector<OfMethod> methods;
};

struct Findings {
  std::vector<std::size_t> front;  // of the measured points, by rising CPU seconds
  std::vector<Worth> worth;
  std::vector<SeriesLaw> laws;
  std::vector<Answer> answers;  // one for each wanted error
};

// resolution: of the reference. An error below it counts as it: no more is known.
[[nodiscard]] Findings find_accuracy(const std::vector<MeasuredStep>& points,
                                     const std::vector<double>& wanted, double resolution);

// How much of what its series varies was spent on a point, and what it is called.
struct Spent {
  double amount = 0.0;
  std::string what;
};
[[nodiscard]] Spent spent_on(const MeasuredStep& point);

}  // namespace earthshine::studies
