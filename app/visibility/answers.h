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
void describe(Fields& fields, Either<ViewingConfiguration> auto& configuration) {
  fields("scene", configuration.scene);
  fields("camera", configuration.camera);
  fields("iris", configuration.iris);
  fields("lamps", configuration.lamps);
  fields("detect", configuration.detect);
  fields("positions_deg", configuration.positions_deg);
  fields("tai_s", configuration.tai_s);
  fields("least_factor", configuration.least_factor);
  fields("darkest_deg", configuration.darkest_deg);
  fields("tried_factors", configuration.tried_factors);
}

// Adds one camera's viewing configurations to the list of each wanted target.
void add_configurations(const StudyPart& part, const studies::StudyFile& study,
                        const StudyCamera& camera, const studies::BasisView& view,
                        std::vector<std::vector<ViewingConfiguration>>& configurations);

// Adds one pose's configuration to that of the poses before it, or as a new one.
void add_configuration(std::vector<ViewingConfiguration>& configurations,
                       const ViewingConfiguration& configuration);

// What a wanted target is answered.
[[nodiscard]] AnswerEntry answer_of(const studies::WantedTarget& wanted,
                                    const studies::StudyFile& study,
                                    const std::vector<ViewingConfiguration>& configurations);

}  // namespace earthshine::app
