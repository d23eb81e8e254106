// SPDX-License-Identifier: Apache-2.0
// What a method reaches in a given time, and in which time it reaches a given error, from as few
// pictures as tell it.
//
// Settings form a ladder: each rung takes about twice the work of the one below. Rungs are whole
// numbers, so that runs with slightly other timings draw the same pictures wherever they draw any.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace earthshine::studies {

struct LadderPoint {
  int rung = 0;
  double seconds = 0.0;
  double error = 0.0;
};

struct LadderLimits {
  double seconds = 1.0;                // the equal time
  std::optional<double> wanted_error;  // the equal error; none: nothing is drawn for it
  int least_rung = -8;
  int most_rung = 10;
  double spend = 4.0;  // times `seconds`: the most that one picture for the equal error may take
};

enum class LadderEnd {
  Reached,
  // The error no longer falls as noise does: without what is left of noise it would still be nine
  // tenths of what it is, and more than wanted.
  LevelsOut,
  NotWithin  // still falling at `spend` times the seconds, or there is no higher rung
};

// A point takes "no more than" the equal time within this factor: the same picture takes a few per
// cent more or less from one run to the next.
inline constexpr double time_slack = 1.1;

struct Ladder {
  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  std::vector<LadderPoint> points;  // by rung
  std::size_t at_time = none;       // the highest within the time; none: even the lowest takes more
  LadderEnd end = LadderEnd::NotWithin;
  // Reached: the lowest rung drawn that does and below which none does. Else the least error.
  std::size_t at_error = 0;
};

// draw: the picture at a rung, its seconds and its error; called at most once per rung.
//
// Up from rung 0, or down where that takes too long, to the highest rung within the time; then, if
// the error is not reached and has not levelled out, on to `spend` times the time. Where it is
// reached the rungs between are halved until the cheapest is known. For that the error is taken to
// fall with the rung.
[[nodiscard]] Ladder climb(const std::function<LadderPoint(int)>& draw, const LadderLimits& limits);

// From two points of rising seconds: with error^2 = floor^2 + c / seconds, the floor; 0 if there is
// none.
[[nodiscard]] double error_floor(const LadderPoint& cheaper, const LadderPoint& dearer);

}  // namespace earthshine::studies
