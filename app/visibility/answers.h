// SPDX-License-Identifier: Apache-2.0
// What a study says to the probabilities that were wanted: which camera and iris, which lamps,
// which parts of the orbit.
#pragma once

#include <vector>

#include "app/study/results_fields.h"
#include "app/views/scene.h"
#include "studies/orbit/condition.h"
#include "studies/orbit/study_file.h"

namespace earthshine::app {

// One way of looking: a camera with an iris mode, by one lamp setting.
struct ViewingConfiguration {
  std::string scene;  // its path in a study of several, else empty
  std::string camera, iris, lamps;
  std::vector<double> detect;         // by place
  std::vector<double> positions_deg;  // of them; empty: a single place
  std::vector<double> tai_s;          // of them (scenes::Instant), along time; else empty
  // At the place with least light of Sun and Earth: the least factor on the setting's lamps.
  std::optional<double> least_factor, darkest_deg;
  bool tried_factors = false;  // false: the setting has no lamps on
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

// Adds the viewing configurations of one camera to those of each wanted target.
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
