// SPDX-License-Identifier: Apache-2.0
// Ctrl-C while a picture is worked out: the first asks for an end with what is finished, the second
// ends the program at once.
#pragma once

namespace earthshine::app {

// Takes SIGINT and SIGTERM over for as long as it lives. One at a time.
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
  Handler int_before_, term_before_;
};

}  // namespace earthshine::app
