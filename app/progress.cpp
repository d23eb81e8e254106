// SPDX-License-Identifier: Apache-2.0
#include "app/progress.h"

#include <fmt/format.h>
#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <system_error>
#include <vector>

#include "app/console.h"
#include "base/error.h"
#include "base/parallel.h"

namespace earthshine::app {
namespace {

constexpr auto redraw_every = std::chrono::milliseconds(250);

// Others on the machine may slow it down by more, but stretches on one thread look like it too.
constexpr double most_slowdown = 3.0;
// Seconds of parallel work from which on the slowdown is measured.
constexpr double least_parallel_s = 1.0;

// CPU seconds of a stage: `fixed` and `each` for a unit. Medians over scenes/library with the
// settings that go with 5 % error; a finished stage of the same kind corrects them.
struct Law {
  Work work;
  const char* kind;
  double fixed, each;
};
constexpr std::array<Law, 10> laws = {{{Work::Read, "read", 0.2, 0.0},
                                       {Work::Pilot, "pilot", 1.0, 2.0},
                                       {Work::Solve, "solve", 0.2, 2e-5},
                                       {Work::StudySolve, "study solve", 0.5, 2e-5},
                                       {Work::Picture, "picture", 0.3, 6e-5},
                                       {Work::StudyPicture, "study picture", 1.0, 3.5e-5},
                                       {Work::Paths, "paths", 0.1, 1e-6},
                                       {Work::Conditions, "conditions", 0.5, 1e-6},
                                       {Work::Surfaces, "surfaces", 1.0, 1e-4},
                                       {Work::Other, "other", 0.5, 0.0}}};

const Law& law_of(Work work) {
  return *std::find_if(laws.begin(), laws.end(),
                       [work](const Law& law) { return law.work == work; });
}

base::Forecast::Stage stage_of(Work work, double units) {
  const Law& law = law_of(work);
  return {law.kind, (law.fixed + law.each * units) / base::available_threads()};
}

// Whole seconds: it is an estimate.
std::string about(double seconds) {
  return seconds < 60.0 ? fmt::format("{:.0f} s", std::max(1.0, seconds)) : duration(seconds);
}

}  // namespace

std::string cut_in_middle(const std::string& line, std::size_t columns) {
  std::vector<std::size_t> starts;  // of characters
  for (std::size_t at = 0; at < line.size();
       at += std::max<std::size_t>(1, base::utf8_length(std::string_view(line).substr(at)))) {
    starts.push_back(at);
  }
  if (starts.size() <= columns) return line;
  const std::string dots = columns > 6 ? "..." : "";
  const std::size_t kept = columns - dots.size(), head = (kept + 1) / 2;
  const std::size_t tail = starts.size() - (kept - head);
  return line.substr(0, starts[head]) + dots +
         (tail < starts.size() ? line.substr(starts[tail]) : "");
}

Progress::Progress(bool quiet) : shown_(!quiet && notes_are_on_a_terminal()) {
  if (!shown_) return;
  // Signals are for the thread that works: they wake what it waits for.
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  try {
    drawer_ = std::thread([this] { keep_drawing(); });
  } catch (const std::system_error&) {
    shown_ = false;  // no thread can be had: the work goes on without
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

Progress::~Progress() {
  if (!shown_) return;
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
    stage_ = 0;
  }
  wake_.notify_all();
  drawer_.join();
  show_status("");
}

void Progress::expect(Work work, double units) {
  if (!shown_) return;
  const std::lock_guard lock(mutex_);
  forecast_.expect(stage_of(work, units));
  is_planned_ = true;
}

void Progress::expect_rest(double seconds) {
  const std::lock_guard lock(mutex_);
  forecast_.drop_all();
  if (seconds > 0.0) forecast_.expect({"", seconds});
  is_planned_ = true;
}

void Progress::drop(Work work) {
  const std::lock_guard lock(mutex_);
  forecast_.drop(law_of(work).kind);
}

void Progress::end_within(double seconds) {
  const std::lock_guard lock(mutex_);
  limit_s_ = seconds;
  is_planned_ = true;
}

Progress::Listener Progress::begin(const std::string& label, Work work, double units) {
  if (!shown_) return [](std::size_t, std::size_t) {};
  const std::lock_guard lock(mutex_);
  forecast_.begin(stage_of(work, units), now());
  if (work != Work::Read && std::isinf(parallel_since_)) {
    parallel_since_ = now();
    parallel_cpu_ = base::cpu_seconds();
  }
  label_ = base::escaped(label);
  stage_ = ++stages_;
  draw();
  return [this, stage = stage_](std::size_t done, std::size_t total) {
    const std::lock_guard guard(mutex_);
    if (stage == stage_) forecast_.advance(done, total);
  };
}

void Progress::relabel(const std::string& label) {
  const std::lock_guard lock(mutex_);
  label_ = base::escaped(label);
}

void Progress::end() {
  if (!shown_) return;
  const std::lock_guard lock(mutex_);
  forecast_.end(now());
  stage_ = 0;
  show_status("");
}

double Progress::now() const {
  return std::chrono::duration<double>(Clock::now() - start_).count();
}

double Progress::slowdown() const {
  const double gone = now() - parallel_since_;
  if (gone < least_parallel_s) return 1.0;
  const double cpu = (base::cpu_seconds() - parallel_cpu_) / base::available_threads();
  return std::clamp(gone / std::max(cpu, 1e-3), 1.0, most_slowdown);
}

void Progress::draw() {
  const double gone = now();
  std::string figures = "  " + duration(gone);
  if (is_planned_) {
    const base::Forecast::State state =
        forecast_.at(gone, slowdown(), std::max(0.0, limit_s_ - gone));
    figures = fmt::format(" {:3.0f} %{}, about {} to go", 100.0 * state.share, figures,
                          about(state.seconds_to_go));
  }
  const std::size_t columns = std::max<std::size_t>(2, terminal_columns(STDERR_FILENO)) - 1;
  const std::size_t label = columns > figures.size() ? columns - figures.size() : 0;
  show_status(cut_in_middle(cut_in_middle(label_, label) + figures, columns));
}

void Progress::keep_drawing() {
  std::unique_lock lock(mutex_);
  while (!ends_) {
    if (stage_ > 0) draw();
    wake_.wait_for(lock, redraw_every);
  }
}

}  // namespace earthshine::app
