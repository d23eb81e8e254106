// SPDX-License-Identifier: Apache-2.0
// Ctrl-C while a picture is worked out: the first asks for an end with what is finished, the second
// ends the program at once.
#pragma once

namespace earthshine::app {

// Takes SIGINT and SIGTERM over for as long as it lives. One at a time. Of several ranks it does
// nothing: they would not stop at the same place, so a signal ends them all.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  // Safe on many threads.
  [[nodiscard]] static bool asked();

 private:
  using Handler = void (*)(int);
  bool active_;
  Handler int_before_, term_before_;
};

}  // namespace earthshine::app
