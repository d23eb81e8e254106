// SPDX-License-Identifier: Apache-2.0
#include "app/console.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <system_error>

#include "base/error.h"
#include "base/ranks/ranks.h"

namespace earthshine::app {
namespace {

std::atomic<bool> some_note_was_lost{false}, silent_now{false}, host_has_signals{false};

bool write_whole(std::string_view text, std::FILE* stream) {
  errno = 0;
  return std::fwrite(text.data(), 1, text.size(), stream) == text.size() &&
         std::fflush(stream) == 0;
}

std::atomic<bool> interrupted{false};
std::atomic<void (*)(int)> at_once{SIG_DFL};

static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may not wait");

void remember(int signal) {
  interrupted = true;
  std::signal(signal, at_once);
}

// Without SA_RESTART, so that blocking writes are interrupted too. Signals that the parent ignores
// stay ignored, as with nohup.
void (*take_over(int signal))(int) {
  struct sigaction ours {};
  struct sigaction before {};
  ours.sa_handler = remember;
  ::sigaction(signal, &ours, &before);
  if (before.sa_handler == SIG_IGN) std::signal(signal, SIG_IGN);
  return before.sa_handler;
}

}  // namespace

void be_silent(bool silent) { silent_now = silent; }

void print(std::string_view text) {
  if (silent_now) return;
  if (write_whole(base::escaped(text, "\n\t"), stdout)) return;
  throw base::Error(base::Blame::Work, "standard output",
                    "cannot be written: " + std::generic_category().message(errno));
}

void note(std::string_view line) {
  if (silent_now) return;
  if (some_note_was_lost) return;  // no reader; a full pipe would block again
  if (!write_whole(base::escaped(line) + "\n", stderr)) some_note_was_lost = true;
}

void note_in_handler(std::string_view line) noexcept {
  pollfd stream{STDERR_FILENO, POLLOUT, 0};
  if (silent_now || ::poll(&stream, 1, 0) != 1 || stream.revents != POLLOUT) return;
  const std::string_view wipe = "\r\033[2K";  // of a progress line
  const bool terminal = ::isatty(STDERR_FILENO) == 1;
  if (terminal && ::write(STDERR_FILENO, wipe.data(), wipe.size()) < 0) return;
  if (::write(STDERR_FILENO, line.data(), line.size()) < 0) return;
}

bool lost_a_note() { return some_note_was_lost; }

std::string duration(double seconds) {
  const long whole = std::lround(seconds);
  if (whole >= 3600) return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
  if (whole >= 60) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{:.{}f} s", seconds, seconds < 0.1 ? 3 : 1);
}

std::string short_count(double count) {
  if (count < 1e4) return fmt::format("{:.0f}", count);
  if (count < 1e6) return fmt::format("{:.1f} k", count / 1e3);
  if (count < 1e9) return fmt::format("{:.1f} M", count / 1e6);
  return fmt::format("{:.1f} G", count / 1e9);
}

Progress::Progress(const std::string& label, bool quiet)
    : label_(base::escaped(label)), shown_(!quiet && !silent_now && ::isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (shown_) std::fputs("\r\033[2K", stderr);
}

void Progress::operator()(std::size_t done, std::size_t total) {
  const Clock::time_point now = Clock::now();
  if (!shown_ || total == 0 || now - last_ < std::chrono::milliseconds(100)) return;
  last_ = now;
  const double gone = std::chrono::duration<double>(now - start_).count();
  const double share = static_cast<double>(done) / static_cast<double>(total);
  std::string line =
      fmt::format("\r\033[2K{} {:3.0f} %  {}", label_, 100.0 * share, duration(gone));
  if (done > 0) line += ", " + duration(gone * (1.0 - share) / share) + " to go";
  std::fputs(line.c_str(), stderr);
}

Interrupt::Interrupt() : active_(base::ranks() == nullptr && !host_has_signals) {
  if (host_has_signals) return;
  interrupted = false;
  if (!active_) return;
  for (std::size_t k = 0; k < before_.size(); ++k) {
    before_[k] = take_over(ending_signals[k]);
    if (before_[k] != SIG_IGN) at_once = before_[k];
  }
}

Interrupt::~Interrupt() {
  if (!active_) return;
  for (std::size_t k = 0; k < before_.size(); ++k) std::signal(ending_signals[k], before_[k]);
}

bool Interrupt::asked() { return interrupted; }

void Interrupt::leave_signals_to_host() { host_has_signals = true; }

void Interrupt::ask(bool asked) { interrupted = asked; }

namespace {

// Changes the handlers of signals that have the handler `from`; ignored signals stay ignored.
// Returns whether any changed.
bool handle_otherwise(void (*from)(int), void (*to)(int)) {
  bool changed = false;
  for (const int signal : ending_signals) {
    struct sigaction action {};
    ::sigaction(signal, nullptr, &action);
    if (action.sa_handler != from) continue;
    action.sa_handler = to;
    ::sigaction(signal, &action, nullptr);
    changed = true;
  }
  return changed;
}

}  // namespace

EndAtOnce::EndAtOnce() : changed_(handle_otherwise(remember, at_once)) {}

EndAtOnce::~EndAtOnce() {
  if (changed_) (void)handle_otherwise(at_once, remember);
}

}  // namespace earthshine::app
