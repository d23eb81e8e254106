// SPDX-License-Identifier: Apache-2.0
// What `study accuracy` works out, stage by stage, whether by one process or in parts.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/accuracy/parts.h"
#include "app/accuracy/run.h"

namespace earthshine::app {

inline constexpr int first_paths =
    16;  // per pixel and side, before it is known how many are needed

// Both sides of a reference, batch by batch.
struct PathReference {
  raytrace::PathSet paths = raytrace::PathSet::All;
  std::vector<studies::Batch> batches[2];
  std::vector<base::Image> pictures[2];

  [[nodiscard]] studies::ReferencePair pair() const;
};

class AccuracyStages {
 protected:
  explicit AccuracyStages(const AccuracyTask& task);

  [[nodiscard]] double finest() const;  // of the wanted errors
  // Why there is nothing to measure, as far as it is known without a path; "": there may be.
  [[nodiscard]] std::string nothing_to_measure();
  [[nodiscard]] std::vector<PathReference> new_references() const;
  // One batch on both sides of every reference, so that a time limit leaves them alike.
  void trace_round(std::vector<PathReference>& references, int index, int paths);
  // False if all is black.
  bool trace_first(std::vector<PathReference>& references);
  // Paths of the rounds after the first.
  [[nodiscard]] std::vector<int> further_rounds();
  // Direct light alone, on both sides.
  [[nodiscard]] studies::AccuracyStep straight_step() const;
  [[nodiscard]] std::uint64_t straight_seed(int side) const;
  [[nodiscard]] std::vector<studies::AccuracyStep> make_ladder() const;

  const AccuracyTask& task_;
  studies::StudyScene scene_;
  AccuracyParts parts_;
  AccuracyResult result_;
  std::vector<bool> counted_;
  studies::ReferencePair full_;
};

}  // namespace earthshine::app
