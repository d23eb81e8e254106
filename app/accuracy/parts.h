// SPDX-License-Identifier: Apache-2.0
// The parts of `study accuracy`: read from the cache, or computed and stored.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/accuracy/run.h"

namespace earthshine::app {

class AccuracyParts {
 public:
  AccuracyParts(const AccuracyTask& task, const scenes::World& scene);

  // Part of a reference: channels as from trace_batch; fact: cpu_seconds.
  [[nodiscard]] CachedResult batch(const studies::Batch& batch);
  // A step's picture, channel Y, and its cost.
  [[nodiscard]] CachedResult point(const studies::AccuracyStep& step, std::uint64_t seed);
  // Whether it is stored with its picture.
  [[nodiscard]] bool has(const studies::Batch& batch) const;
  [[nodiscard]] bool has(const studies::AccuracyStep& step, std::uint64_t seed) const;
  // Digests of everything that the study's parts depend on.
  [[nodiscard]] Json digests(const std::vector<studies::AccuracyStep>& ladder) const;
  [[nodiscard]] static studies::StepCost cost_of(const Json& facts);

  // Announces later steps, so that a common solution is computed once.
  void expect(const std::vector<studies::AccuracyStep>& steps);
  // Reason why the step does not fit into memory; "" if it fits.
  [[nodiscard]] std::string does_not_fit(const studies::AccuracyStep& step) const;

  // Stores that reason instead of the step, for the merge; "" if there is none.
  void leave_out(const studies::AccuracyStep& step, const std::string& why) const;
  [[nodiscard]] std::string left_out(const studies::AccuracyStep& step) const;

  [[nodiscard]] double seconds() const;  // wall time since the start
  // Present ratio of wall to CPU seconds, to predict the remaining time.
  [[nodiscard]] double wall_per_cpu() const;
  void note_progress(const std::string& what, double seconds_left, const std::string& found) const;

 private:
  [[nodiscard]] Json cache_key_of(const studies::Batch& batch) const;
  [[nodiscard]] Json cache_key_of(const studies::AccuracyStep& step, std::uint64_t seed) const;
  [[nodiscard]] Json key_of_left_out(const studies::AccuracyStep& step) const;
  [[nodiscard]] bool is_stored(const Json& cache_key) const;
  [[nodiscard]] std::optional<CachedResult> stored(const Json& cache_key);
  [[noreturn]] void end_early() const;
  // Call before work without a stored result: throws base::Error (Work) if no work may be done.
  void see_that_work_is_wanted() const;

  const AccuracyTask& task_;
  const scenes::World& scene_;
  Json common_cache_key_;
  std::vector<radiosity::SolveOptions> expected_;
  studies::SolutionShelf shared_, single_;
  std::size_t finished_ = 0;
  double cpu_start_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// The stages of `study accuracy`, for one process or in parts.

inline constexpr int first_paths = 16;  // per pixel and side, before the required number is known

// The two halves of a reference, batch by batch.
struct PathReference {
  raytrace::PathSet paths = raytrace::PathSet::All;
  std::vector<studies::Batch> batches[2];
  std::vector<base::Image> pictures[2];

  [[nodiscard]] studies::ReferencePair pair() const;
};

class AccuracyStages {
 protected:
  explicit AccuracyStages(const AccuracyTask& task);

  [[nodiscard]] double finest() const;  // smallest wanted error
  // Reason why there is nothing to measure, if known without paths; "": unknown.
  [[nodiscard]] std::string nothing_to_measure() const;
  [[nodiscard]] std::vector<PathReference> new_references() const;
  // One batch for both sides of every reference, so that a time limit leaves them equal.
  void trace_round(std::vector<PathReference>& references, int index, int paths);
  void take_truth(const PathReference& reference);
  // Reason why there is nothing to measure; "": there is something.
  [[nodiscard]] std::string trace_first(std::vector<PathReference>& references);
  // Paths of the rounds after the first.
  [[nodiscard]] std::vector<int> further_rounds();
  // Direct light only, on both sides.
  [[nodiscard]] studies::AccuracyStep straight_step() const;
  [[nodiscard]] std::uint64_t straight_seed(int side) const;
  [[nodiscard]] std::vector<studies::AccuracyStep> make_ladder() const;

  const AccuracyTask& task_;
  scenes::World scene_;
  AccuracyParts parts_;
  AccuracyResult result_;
  studies::ReferencePair full_;  // without direct light
  std::vector<bool> counted_;    // pixels that count
};

}  // namespace earthshine::app
