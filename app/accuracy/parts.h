// SPDX-License-Identifier: Apache-2.0
// The parts of `study accuracy`: taken from the store, or worked out and kept there.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "app/accuracy/run.h"

namespace earthshine::app {

class AccuracyParts {
 public:
  AccuracyParts(const AccuracyTask& task, const studies::StudyScene& scene);

  // Of a reference: channels Y and variance; fact: cpu_seconds.
  [[nodiscard]] StoredPart batch(const studies::Batch& batch);
  // A step's picture, channel Y, and its cost.
  [[nodiscard]] StoredPart point(const studies::AccuracyStep& step, std::uint64_t seed);
  [[nodiscard]] bool has(const studies::Batch& batch) const;
  [[nodiscard]] bool has(const studies::AccuracyStep& step, std::uint64_t seed) const;
  [[nodiscard]] static studies::StepCost cost_of(const Json& facts);

  // Steps to come: a solution that several of them read is solved for once.
  void expect(const std::vector<studies::AccuracyStep>& steps);
  // Why the step's memory cannot be had; "" if it can.
  [[nodiscard]] std::string does_not_fit(const studies::AccuracyStep& step) const;

  [[nodiscard]] double seconds() const;  // wall, since the beginning
  // How the machine turns CPU seconds into wall seconds just now, for what is still to come.
  [[nodiscard]] double wall_per_cpu() const;
  void tell(const std::string& what, double seconds_left, const std::string& found) const;

 private:
  [[nodiscard]] Json marks_of(const studies::Batch& batch) const;
  [[nodiscard]] Json marks_of(const studies::AccuracyStep& step, std::uint64_t seed) const;
  [[nodiscard]] std::optional<StoredPart> stored(const Json& marks);
  [[noreturn]] void end_early() const;

  const AccuracyTask& task_;
  const studies::StudyScene& scene_;
  Json common_marks_;
  std::vector<radiosity::SolveOptions> expected_;
  studies::SolutionShelf shared_, single_;
  std::size_t finished_ = 0;
  double cpu_start_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace earthshine::app
