// SPDX-License-Identifier: Apache-2.0
#include "app/console.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <system_error>

#include "base/error.h"
#include "base/ranks/ranks.h"

namespace earthshine::app {
namespace {

std::atomic<bool> some_note_was_lost{false}, silent_now{false}, host_has_signals{false};

constexpr std::string_view wipe = "\r\033[2K";  // the line that the cursor is in
std::mutex status_mutex;
std::string status_line;  // in the last line of the terminal

std::size_t character_count(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }));
}

// The byte behind the first `count` characters.
std::size_t end_of_characters(std::string_view text, std::size_t count) {
  std::size_t at = 0;
  for (; at < text.size() && count > 0; --count) {
    at += std::max<std::size_t>(1, base::utf8_length(text.substr(at)));
  }
  return at;
}

void wipe_status() {
  if (!status_line.empty()) std::fwrite(wipe.data(), 1, wipe.size(), stderr);
  status_line.clear();
}

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

bool notes_are_on_a_terminal() { return !silent_now && ::isatty(STDERR_FILENO) == 1; }

void show_status(std::string_view line) {
  const std::lock_guard lock(status_mutex);
  if (line == status_line) return;
  wipe_status();
  status_line = line;
  std::fwrite(status_line.data(), 1, status_line.size(), stderr);
}

std::size_t terminal_columns(int stream) {
  if (::isatty(stream) != 1) return 0;
  winsize size{};
  const bool known = ::ioctl(stream, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 80;
}

std::string wrapped_at_words(std::string_view text, std::size_t columns) {
  std::string out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    const std::size_t blanks = std::min(line.find_first_not_of(' '), line.size());
    const std::string indent(std::min(blanks + 2, columns / 2), ' ');
    std::size_t room = columns, from = blanks;
    while (character_count(line) > room) {
      const std::size_t last = end_of_characters(line, room);
      const std::size_t blank = line.rfind(' ', last);
      const bool breaks = blank != std::string_view::npos && blank > from;
      const std::size_t next = breaks ? blank : line.find(' ', last);  // a long word stays whole
      if (next == std::string_view::npos) break;
      out += line.substr(0, line.find_last_not_of(' ', next) + 1);
      out += "\n" + indent;
      line.remove_prefix(std::min(line.find_first_not_of(' ', next), line.size()));
      room = columns - indent.size();
      from = 0;
    }
    out += line;
    if (end < text.size()) out += '\n';
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

void print(std::string_view text) {
  if (silent_now) return;
  const std::lock_guard lock(status_mutex);
  wipe_status();
  const std::size_t columns = terminal_columns(STDOUT_FILENO);
  const bool prose = columns > 0 && !text.starts_with('{') && !text.starts_with('[');
  const std::string clean = base::escaped(text, "\n\t");
  if (write_whole(prose ? wrapped_at_words(clean, columns) : clean, stdout)) return;
  throw base::Error(base::Blame::Work, "standard output",
                    "cannot be written: " + std::generic_category().message(errno));
}

void note(std::string_view line) {
  if (silent_now) return;
  if (some_note_was_lost) return;  // no reader; a full pipe would block again
  const std::lock_guard lock(status_mutex);
  wipe_status();
  const std::size_t columns = terminal_columns(STDERR_FILENO);
  const std::string clean = base::escaped(line) + "\n";
  if (!write_whole(columns > 0 ? wrapped_at_words(clean, columns) : clean, stderr)) {
    some_note_was_lost = true;
  }
}

void note_in_handler(std::string_view line) noexcept {
  pollfd stream{STDERR_FILENO, POLLOUT, 0};
  if (silent_now || ::poll(&stream, 1, 0) != 1 || stream.revents != POLLOUT) return;
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
