// SPDX-License-Identifier: Apache-2.0
// Console output: results on standard output, everything else on standard error. Control characters
// in names are removed here (base/error.h). On a terminal long lines are broken between words.
#pragma once

#include <array>
#include <csignal>
#include <cstddef>
#include <string>
#include <string_view>

namespace earthshine::app {

// Writes to standard output and flushes it. Throws base::Error (Work) on a full disk or a closed
// pipe: a lost result is a failure.
void print(std::string_view text);

// Lines of more than `columns` characters, broken at blanks; what follows is indented two more.
[[nodiscard]] std::string wrapped_at_words(std::string_view text, std::size_t columns);

// Columns of the terminal of a stream; 0: the stream is no terminal.
[[nodiscard]] std::size_t terminal_columns(int stream);

// One line on standard error. Ignores write errors.
void note(std::string_view line);

// note() for signal handlers, with fixed texts only. Writes nothing if it would block.
void note_in_handler(std::string_view line) noexcept;

// For a process that is not the first of several: suppresses all output.
void be_silent(bool silent);

// Whether standard error is a terminal.
[[nodiscard]] bool notes_are_on_a_terminal();

// The status line at the bottom of the terminal. Notes and results replace it; "" removes it.
void show_status(std::string_view line);

// Whether a note was lost, for the exit code.
[[nodiscard]] bool lost_a_note();

// "1 h 02 min", "1 min 05 s", "12.3 s" or "0.004 s".
[[nodiscard]] std::string duration(double seconds);

// "812", "25.3 k", "1.2 M", "3.4 G".
[[nodiscard]] std::string short_count(double count);

// Signals of Ctrl-C, of batch queues, and of a closed terminal.
inline constexpr std::array ending_signals{SIGINT, SIGTERM, SIGHUP};

// Handles Ctrl-C during a picture: the first signal requests a stop with partial results, the
// second ends the program at once. RAII: handles ending_signals during its lifetime; one at a time.
// Has no effect with several ranks: they would not stop at the same place, so a signal ends them
// all.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  // Thread-safe.
  [[nodiscard]] static bool asked();

  // For a host that handles signals itself, such as Python: Interrupt no longer installs handlers,
  // and the host requests or cancels the stop.
  static void leave_signals_to_host();
  static void ask(bool asked);

  // For work that cannot be partial: throws Left if a stop is requested.
  struct Left {};
  static void leave_if_asked() {
    if (asked()) throw Left();
  }
  // As a callback during such work: throws Left, or returns that work continues.
  static bool leave_or_go_on() {
    leave_if_asked();
    return false;
  }

 private:
  using Handler = void (*)(int);
  bool active_;
  std::array<Handler, ending_signals.size()> before_{};
};

// Within an Interrupt, for work without partial results, such as a solve: the first signal ends the
// program at once.
class EndAtOnce {
 public:
  EndAtOnce();
  ~EndAtOnce();
  EndAtOnce(const EndAtOnce&) = delete;
  EndAtOnce& operator=(const EndAtOnce&) = delete;

 private:
  bool changed_;
};

}  // namespace earthshine::app
