// SPDX-License-Identifier: Apache-2.0
// One progress line on standard error for the whole call: the stage, the share of the call that is
// done, which never falls, the time gone and the time to go. It is drawn anew at least once a
// second, also while a stage reports nothing.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <limits>
#include <mutex>
#include <string>
#include <thread>

#include "base/forecast.h"

namespace earthshine::app {

// Kinds of stages. Their expected seconds stand in progress.cpp.
enum class Work {
  Read,
  Pilot,
  Solve,
  Surfaces,
  StudySolve,
  Picture,
  StudyPicture,
  Paths,
  Conditions,
  Other
};

class Progress {
 public:
  // Draws nothing if `quiet` or unless standard error is a terminal.
  explicit Progress(bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // units: triangles of a solve; pixels of a picture, at 5 % error; StudyPart::picture_units of a
  // study's; pictures of a pilot; conditions times pixels.
  void expect(Work work, double units);
  // One of these is not needed: its result was there.
  void drop(Work work);
  // In place of all that was expected: the rest takes about so many seconds.
  void expect_rest(double seconds);

  // The call takes no longer than this, seconds from its start.
  void end_within(double seconds);

  // A stage begins, and the one before it ends. Its reports go to the listener.
  using Listener = std::function<void(std::size_t done, std::size_t total)>;
  Listener begin(const std::string& label, Work work, double units);
  // The stage under way goes on with another part of it.
  void relabel(const std::string& label);
  // The stages are over; the line is wiped.
  void end();

 private:
  using Clock = std::chrono::steady_clock;
  [[nodiscard]] double now() const;
  [[nodiscard]] double slowdown() const;  // of the machine by others
  void draw();                            // with mutex_ held
  void keep_drawing();

  bool shown_;
  Clock::time_point start_ = Clock::now();
  // Seconds of the call and of its CPUs when the first stage on all threads began.
  double parallel_since_ = std::numeric_limits<double>::infinity(), parallel_cpu_ = 0.0;
  std::mutex mutex_;
  std::condition_variable wake_;
  base::Forecast forecast_;
  double limit_s_ = std::numeric_limits<double>::infinity();
  // Without a plan the line shows no share and no time to go.
  bool is_planned_ = false;
  std::string label_;
  std::size_t stage_ = 0;  // number of the stage under way; 0: none
  std::size_t stages_ = 0;
  bool ends_ = false;
  std::thread drawer_;
};

// `line` in at most `columns` characters, with "..." in place of its middle.
[[nodiscard]] std::string cut_in_middle(const std::string& line, std::size_t columns);

}  // namespace earthshine::app
