// SPDX-License-Identifier: Apache-2.0
// Computes all conditions of one camera of a visibility study in parallel, and stores finished
// ones.
#pragma once

#include <optional>
#include <vector>

#include "app/views/frames.h"
#include "studies/orbit/condition.h"

namespace earthshine::app {

// Conditions are numbered by setting, then by position.
[[nodiscard]] studies::ConditionAt condition_at(const StudyPart& part, std::size_t condition);

// Units of Work::Conditions (app/progress.h).
[[nodiscard]] double units_of_conditions(const StudyPart& part, const StudyCamera& camera);

// In the order of StudyPart: all places of the first lamp setting, then those of the second.
[[nodiscard]] std::vector<ConditionEntry> conditions_of(const StudyPart& part);

// Results for the scene's targets in each condition, in order; no value for a condition that was
// not reached.
using Judged = std::vector<std::optional<std::vector<TargetFindings>>>;

class StudyConditions {
 public:
  StudyConditions(const StudyPart& part, const studies::StudyFile& study, const ResultCache& store,
                  const Common& common);

  // Number of batches in which conditions are computed and stored.
  [[nodiscard]] std::size_t batches() const;

  // No value for conditions that were not reached before an interruption or are not in `batches`.
  // frame: source of the view, with its cache key; its image is not used.
  [[nodiscard]] Judged judge(const StudyCamera& camera, const studies::BasisView& view,
                             const StudyFrames::Frame& frame, const Json& frame_cache_key,
                             Share batches, std::vector<StudyCost>& costs);
  // Whether a batch is stored.
  [[nodiscard]] bool has(const StudyCamera& camera, const Json& frame_cache_key,
                         std::size_t batch) const;

  // The results if all of them are stored; needs no picture.
  [[nodiscard]] std::optional<Judged> find(const StudyCamera& camera,
                                           const Json& frame_cache_key) const;
  // All input of the camera's conditions [first, last).
  [[nodiscard]] Json cache_key(const StudyCamera& camera, const Json& frame_cache_key,
                               std::size_t first, std::size_t last) const;

 private:
  [[nodiscard]] studies::ConditionOptions options() const;
  [[nodiscard]] Share conditions_of(std::size_t batch) const;

  const StudyPart& part_;
  const studies::StudyFile& study_;
  const Common& common_;
  const ResultCache& store_;
};

}  // namespace earthshine::app
