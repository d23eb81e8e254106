// SPDX-License-Identifier: Apache-2.0
// How far a call has come and how long it still takes, from its stages.
//
//   remaining = rest of the stage under way + expected seconds of the stages to come
//   rest of a stage: by its reports, mixed with the expected seconds up to a fifth of it
//   share     = elapsed / (elapsed + remaining), never less than it was before
//
// Expected seconds of a kind of stage are corrected by the finished stages of that kind. The caller
// brings the clock, in seconds from the start of the call.
#pragma once

#include <cstddef>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace earthshine::base {

class Forecast {
 public:
  struct Stage {
    // Stages of one kind take seconds in proportion to those expected; "": as many as expected.
    std::string kind;
    double seconds = 0.0;  // expected
  };
  struct State {
    double share = 0.0, seconds_to_go = 0.0;
  };

  // A stage to come.
  void expect(const Stage& stage);
  // One of those is not needed: its result was there.
  void drop(const std::string& kind);
  void drop_all();
  // Ends the stage under way. Takes the place of a stage to come of the same kind, if there is one.
  void begin(const Stage& stage, double now);
  void advance(std::size_t done, std::size_t total);
  void end(double now);

  // slowdown: of the machine by others, for stages whose kind was not measured yet. most: the
  // longest that the rest may take.
  [[nodiscard]] State at(double now, double slowdown = 1.0,
                         double most = std::numeric_limits<double>::infinity());

 private:
  struct Measured {
    double seconds = 0.0, expected = 0.0;
  };
  [[nodiscard]] double expected(const Stage& stage, double slowdown) const;
  [[nodiscard]] double seconds_of_current(double now, double slowdown) const;

  std::vector<Stage> to_come_;
  std::map<std::string, Measured> measured_;
  Stage current_;
  bool under_way_ = false;
  double began_ = 0.0;
  std::size_t done_ = 0, total_ = 0;
  double shown_ = 0.0;
};

}  // namespace earthshine::base
