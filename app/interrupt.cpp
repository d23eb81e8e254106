// SPDX-License-Identifier: Apache-2.0
#include "app/interrupt.h"

#include <atomic>
#include <csignal>

namespace earthshine::app {
namespace {

std::atomic<bool> interrupted{false};
std::atomic<void (*)(int)> at_once{SIG_DFL};

static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may not wait");

void remember(int signal) {
  interrupted = true;
  std::signal(signal, at_once);
}

// Whoever started the program may have it ignore a signal, as nohup does.
void (*take_over(int signal))(int) {
  const auto before = std::signal(signal, remember);
  if (before == SIG_IGN) std::signal(signal, SIG_IGN);
  return before;
}

}  // namespace

Interrupt::Interrupt() {
  interrupted = false;
  int_before_ = take_over(SIGINT);
  term_before_ = take_over(SIGTERM);
  if (int_before_ != SIG_IGN) at_once = int_before_;
}

Interrupt::~Interrupt() {
  std::signal(SIGINT, int_before_);
  std::signal(SIGTERM, term_before_);
}

bool Interrupt::asked() { return interrupted; }

}  // namespace earthshine::app
