// SPDX-License-Identifier: Apache-2.0
#include "app/interrupt.h"

#include <atomic>
#include <csignal>

#include "base/ranks/ranks.h"

namespace earthshine::app {
namespace {

std::atomic<bool> interrupted{false};
std::atomic<void (*)(int)> at_once{SIG_DFL};

static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may not wait");

void remember(int signal) {
  interrupted = true;
  std::signal(signal, at_once);
}

// Without SA_RESTART, so that what waits for a reader that does not come is woken, too. Whoever
// started the program may have it ignore a signal, as nohup does.
void (*take_over(int signal))(int) {
  struct sigaction ours {};
  struct sigaction before {};
  ours.sa_handler = remember;
  ::sigaction(signal, &ours, &before);
  if (before.sa_handler == SIG_IGN) std::signal(signal, SIG_IGN);
  return before.sa_handler;
}

}  // namespace

Interrupt::Interrupt() : active_(base::ranks() == nullptr) {
  interrupted = false;
  if (!active_) return;
  int_before_ = take_over(SIGINT);
  term_before_ = take_over(SIGTERM);
  if (int_before_ != SIG_IGN) at_once = int_before_;
}

Interrupt::~Interrupt() {
  if (!active_) return;
  std::signal(SIGINT, int_before_);
  std::signal(SIGTERM, term_before_);
}

bool Interrupt::asked() { return interrupted; }

}  // namespace earthshine::app
