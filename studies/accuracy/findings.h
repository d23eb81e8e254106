// SPDX-License-Identifier: Apache-2.0
// Results from the measured points of `study accuracy`: laws, the Pareto front, and the best
// settings.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "studies/accuracy/accuracy.h"
#include "studies/accuracy/power_law.h"

namespace earthshine::studies {

// Data for the Pareto front of (seconds, error), the errors down to which each method is the
// cheapest, and the cheapest setting for a wanted error.

struct Trade {
  std::string method;
  double seconds = 0.0;
  double error = 0.0;
};

// The functions below throw base::Error (Work) for a number that is negative or not finite.

// Indices of the Pareto-optimal points, by rising seconds: no other point is at least as fast and
// as accurate, and better in one of the two. Of equal points the first one counts.
[[nodiscard]] std::vector<std::size_t> pareto_front(const std::vector<Trade>& points);

// The fastest point whose error is at most `wanted`; of equally fast ones the most accurate.
[[nodiscard]] std::optional<std::size_t> cheapest_within(const std::vector<Trade>& points,
                                                         double wanted);

// The range in which a method is the cheapest: at an error e, the fastest of all points with an
// error <= e belongs to the method.
struct Worth {
  std::string method;
  bool ever = false;     // it is the cheapest for some error
  double down_to = 0.0;  // the least error for which it is the cheapest
  std::string then;      // the method that is the cheapest just below; "": no point has a smaller
                         // error
};
// One for each method, in the order of their first points.
[[nodiscard]] std::vector<Worth> worth_of_methods(const std::vector<Trade>& points);

struct MeasuredStep {
  AccuracyStep step;
  StepCost cost;
  PictureError error;          // relative to the full reference
  PictureError setting_error;  // relative to the method's own limit
};

// A series and its law for the setting's error. Points below the reference's resolution are
// excluded.
struct SeriesLaw {
  std::string method, series;
  std::string spent;  // unit of x: "patches", "camera samples a pixel"
  std::vector<ErrorAt> points;
  std::optional<PowerLaw> law;  // where it holds
};

// The cheapest measured settings for a wanted error, by CPU seconds.
struct Answer {
  double wanted = 0.0;
  bool is_resolved = true;          // whether the reference resolves this error
  std::optional<std::size_t> best;  // index of the measured point; empty: not reached
  struct OfMethod {
    std::string method;
    std::optional<std::size_t> point;  // whose picture has that error
    // Whose setting has that error: the rest is the method's own limit, which no setting removes.
    std::optional<std::size_t> setting;
    // If paths do not reach it: the CPU seconds that they would take, with an error that falls with
    // their root.
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

// resolution: of the reference. A smaller error counts as the resolution, because it is unknown.
[[nodiscard]] Findings find_accuracy(const std::vector<MeasuredStep>& points,
                                     const std::vector<double>& wanted, double resolution);

// The amount of the varied quantity at a point, and its name.
struct Spent {
  double amount = 0.0;
  std::string what;
};
[[nodiscard]] Spent spent_on(const MeasuredStep& point);

}  // namespace earthshine::studies
