// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "base/ranks/ranks.h"

namespace earthshine::test {

// One of several ranks without communication.
class Silent : public base::Ranks {
 public:
  Silent(int number, int count) : number_(number), count_(count) {}
  [[nodiscard]] int number() const override { return number_; }
  [[nodiscard]] int count() const override { return count_; }
  [[nodiscard]] int count_here() const override { return count_; }
  [[nodiscard]] bool first_is_here() const override { return true; }
  void broadcast(void*, std::size_t, int) override { FAIL(); }
  void send(std::string, int) override { FAIL(); }
  [[nodiscard]] std::string receive(int) override { throw std::logic_error("asked"); }
  void all_gather(void*, std::size_t, const std::vector<std::size_t>&) override { FAIL(); }
  void gather(void*, std::size_t, const std::vector<std::size_t>&) override { FAIL(); }
  void scatter(void*, std::size_t, const std::vector<std::size_t>&) override { FAIL(); }
  [[nodiscard]] std::size_t take() override { throw std::logic_error("asked"); }
  void end_of_taking() override { FAIL(); }
  [[noreturn]] void end_all(int) override { throw std::logic_error("ended"); }

 private:
  int number_, count_;
};

}  // namespace earthshine::test
