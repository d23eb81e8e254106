// SPDX-License-Identifier: Apache-2.0
// Answers a study's wanted probabilities: which camera and iris, which lamps, which parts of the
// orbit.
#pragma once

#include <vector>

#include "app/study/results_fields.h"
#include "app/views/scene.h"
#include "studies/orbit/condition.h"
#include "studies/orbit/study_file.h"

namespace earthshine::app {

// A camera with an iris mode, for one lamp setting.
struct ViewingConfiguration {
  std::string scene;  // its path in a study of several scenes, else empty
  std::string camera, iris, lamps;
  std::vector<double> detect;         // by position
  std::vector<double> positions_deg;  // of these; empty: a single position
  std::vector<double> tai_s;          // of these (scenes::Instant), along time; else empty
  // Where Sun and Earth give least light: the smallest sufficient factor on the setting's lamps.
  std::optional<double> least_factor, darkest_deg;
  bool tried_factors = false;  // false: no lamp is on, or no target in view
};

template <class Fields>
void describe(Fields& fields, Either<ViewingConfiguration> auto& way) {
  fields("scene", way.scene);
  fields("camera", way.camera);
  fields("iris", way.iris);
  fields("lamps", way.lamps);
  fields("detect", way.detect);
  fields("positions_deg", way.positions_deg);
  fields("tai_s", way.tai_s);
  fields("least_factor", way.least_factor);
  fields("darkest_deg", way.darkest_deg);
  fields("tried_factors", way.tried_factors);
}

// Adds one camera's viewing configurations to the list of each wanted target.
void add_configurations(const StudyPart& part, const studies::StudyFile& study,
                        const StudyCamera& camera, const studies::BasisView& view,
                        std::vector<std::vector<ViewingConfiguration>>& ways);

// Adds one pose's configuration to that of the poses before it, or as a new one.
void add_configuration(std::vector<ViewingConfiguration>& ways, const ViewingConfiguration& way);

// What a wanted target is answered.
[[nodiscard]] AnswerEntry answer_of(const studies::WantedTarget& wanted,
                                    const studies::StudyFile& study,
                                    const std::vector<ViewingConfiguration>& ways);

}  // namespace earthshine::app
