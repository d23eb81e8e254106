// SPDX-License-Identifier: Apache-2.0
// All conditions of one camera of a visibility study, in parallel, kept as they are finished.
#pragma once

#include <optional>
#include <vector>

#include "app/views/frames.h"
#include "studies/orbit/condition.h"

namespace earthshine::app {

// Conditions are numbered setting by setting, place by place.
[[nodiscard]] studies::ConditionAt condition_at(const StudyPart& part, std::size_t condition);

// In the order of StudyPart: all places of the first lamp setting, then those of the second.
[[nodiscard]] std::vector<ConditionEntry> conditions_of(const StudyPart& part);

// What was found of the scene's targets in each condition, in their order; none where a condition
// was not reached.
using Judged = std::vector<std::optional<std::vector<TargetFindings>>>;

class StudyConditions {
 public:
  StudyConditions(const StudyPart& part, const studies::StudyFile& study, const ResultCache& store,
                  const Common& common);

  // Conditions are worked out and kept in batches.
  [[nodiscard]] std::size_t batches() const;

  // None for conditions that were not reached before an interruption or are not in `batches`.
  // frame: that the view was made of, with its cache key; its image is not looked at.
  [[nodiscard]] Judged judge(const StudyCamera& camera, const studies::BasisView& view,
                             const StudyFrames::Frame& frame, const Json& frame_cache_key,
                             Share batches, std::vector<StudyCost>& costs);
  // Whether a batch was done before.
  [[nodiscard]] bool has(const StudyCamera& camera, const Json& frame_cache_key,
                         std::size_t batch) const;

  // The same if all of it was done before, without the picture.
  [[nodiscard]] std::optional<Judged> find(const StudyCamera& camera,
                                           const Json& frame_cache_key) const;
  // Everything that the camera's conditions from `first` to before `last` depend on.
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
