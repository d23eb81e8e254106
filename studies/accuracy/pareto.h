// SPDX-License-Identifier: Apache-2.0
// Which settings are worth their time: the Pareto front of (seconds, error), down to which error
// each method is the cheapest, and the cheapest setting for a wanted error.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace earthshine::studies {

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

}  // namespace earthshine::studies
